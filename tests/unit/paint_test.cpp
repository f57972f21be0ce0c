// The paint layer: what texels hold and share, sampling, and settling paint with the automatic weights.
#include "model/paint.h"

#include <limits>
#include <numeric>
#include <set>

#include "generators.h"

namespace probewarp {
namespace {

using testing::expect_always;
using testing::magnitude;
using testing::real;
using testing::whole;

constexpr float nan = std::numeric_limits<float>::quiet_NaN();
/// A texel holds the nearest of 65536 steps.
constexpr float half_step = 0.5f / 65535 + 1e-7f;

void put(PaintMap& map, int x, int y, Paint paint) {
    edit_texels(map, x, y, x + 1, y + 1, [=](int, int, Paint) { return paint; });
}

TEST(PaintMap, HasATexelAPixelWithinLimits) {
    const PaintMap map = new_paint_map(400, 300);
    EXPECT_EQ(map.width, 400);
    EXPECT_EQ(map.height, 300);
    EXPECT_EQ(map.extent, glm::dvec2(1, 0.75));
    EXPECT_EQ(map.tiles.size(), 7u * 5u);
    EXPECT_EQ(empty_paint_map(1, 64, {1, 1}).tiles.size(), 1u);
    EXPECT_EQ(empty_paint_map(128, 65, {1, 1}).tiles.size(), 2u * 2u);
    EXPECT_TRUE(is_blank(map));
    const auto size = [](int width, int height) {
        const PaintMap made = new_paint_map(width, height);
        return std::array{made.width, made.height};
    };
    EXPECT_EQ(size(100, 50), (std::array{256, 128}));
    EXPECT_EQ(size(3000, 4000), (std::array{1536, 2048}));
    EXPECT_EQ(size(32768, 1), (std::array{2048, 1}));
    EXPECT_EQ(size(1, 1), (std::array{256, 256}));
    EXPECT_EQ(new_paint_map(50, 100).extent, glm::dvec2(0.5, 1));
}

TEST(PaintMap, LiesAboutThePicturesCentre) {
    const PaintMap map = new_paint_map(4000, 3000);
    const PictureFrame frame{{2000, 1500}, 4000};
    EXPECT_EQ(to_texels(map, frame, {0, 0}), glm::dvec2(0, 0));
    EXPECT_EQ(to_texels(map, frame, {4000, 3000}), glm::dvec2(2048, 1536));
    EXPECT_EQ(to_picture(map, frame, {1024, 768}), glm::dvec2(2000, 1500));
    // Under a picture half as large it keeps its place about the centre.
    EXPECT_EQ(to_texels(map, {{1000, 750}, 2000}, {1500, 750}), glm::dvec2(1536, 768));
    expect_always("to_picture undoes to_texels", [&] {
        const glm::dvec2 p{*real(-9000, 9000), *real(-9000, 9000)};
        const glm::dvec2 back = to_picture(map, frame, to_texels(map, frame, p));
        // Ten roundings of 1e-16 at 1e4.
        RC_ASSERT(std::hypot(back.x - p.x, back.y - p.y) < 1e-10);
    });
}

TEST(PaintMap, StoresSteps) {
    for (int n = 0; n <= paint_one; ++n) {
        const float x = from_stored(std::uint16_t(n));
        ASSERT_EQ(x, float(n) / 65535.0f);
        ASSERT_EQ(to_stored(x), n);
    }
    EXPECT_EQ(to_stored(0.49f / 65535), 0);
    EXPECT_EQ(to_stored(0.51f / 65535), 1);
    EXPECT_EQ(to_stored(-1), 0);
    EXPECT_EQ(to_stored(7), paint_one);
    EXPECT_EQ(to_stored(nan), 0);
}

TEST(PaintMap, EditsEachTexelOfTheRectangleOnceAndNoOther) {
    PaintMap map = new_paint_map(300, 200);
    std::set<std::pair<int, int>> asked;
    edit_texels(map, -100, 60, 130, 500, [&](int x, int y, Paint old) {
        EXPECT_EQ(old, Paint{});
        EXPECT_TRUE(asked.emplace(x, y).second);
        return Paint{0.25f, 1};
    });
    EXPECT_EQ(asked.size(), 130u * 140u);
    for (int y = 0; y < 200; ++y)
        for (int x = 0; x < 300; ++x) ASSERT_EQ(texel(map, x, y).coverage, asked.contains({x, y}) ? 1 : 0);
    edit_texels(map, 300, 0, 400, 200, [](int, int, Paint) -> Paint { throw "beside the map"; });
    edit_texels(map, 20, 20, 20, 90, [](int, int, Paint) -> Paint { throw "nothing"; });
}

TEST(PaintMap, SharesTheTilesThatDoNotChange) {
    PaintMap map = new_paint_map(256, 256);
    put(map, 10, 10, {0.5f, 1});
    put(map, 100, 10, {0.5f, 1});
    const PaintMap before = map;
    put(map, 11, 10, {1, 0.5f});
    EXPECT_NE(map, before);
    EXPECT_NE(map.tiles[0], before.tiles[0]);
    EXPECT_EQ(map.tiles[1], before.tiles[1]);
    EXPECT_EQ(texel(before, 11, 10), Paint{});
    EXPECT_EQ(own_bytes(map, &before), sizeof(PaintTile));
    EXPECT_EQ(own_bytes(map, nullptr), 2 * sizeof(PaintTile));

    // An edit that says what is there already, to half a step, changes nothing.
    const PaintMap same = map;
    edit_texels(map, 0, 0, 256, 256, [](int, int, Paint old) {
        return old.coverage > 0 ? Paint{old.value - 0.4f / 65535, old.coverage} : Paint{1, 0.4f / 65535};
    });
    EXPECT_EQ(map, same);
}

TEST(PaintMap, IsNullWhereNothingIsPainted) {
    PaintMap map = new_paint_map(256, 256);
    put(map, 70, 70, {0.5f, 1});
    put(map, 71, 70, {0.5f, 1});
    EXPECT_FALSE(is_blank(map));
    put(map, 70, 70, {0.5f, 0});
    EXPECT_EQ(texel(map, 70, 70), Paint{}) << "a value without coverage means nothing";
    EXPECT_FALSE(is_blank(map));
    put(map, 71, 70, {0.5f, 0});
    EXPECT_TRUE(is_blank(map));
    EXPECT_EQ(map, new_paint_map(256, 256));
    map.tiles[3] = std::make_shared<PaintTile>();
    EXPECT_TRUE(is_blank(map));
}

TEST(PaintSample, IsTheMeanWeightedByCoverage) {
    PaintMap map = new_paint_map(256, 256);
    put(map, 63, 10, {1, 1});
    put(map, 64, 10, {0, 1.0f / 3});
    // Halfway between them, in two tiles: c = (1 + 1/3) / 2, v = 1 / (1 + 1/3).
    EXPECT_NEAR(sample(map, {64, 10.5}).coverage, 2.0 / 3, half_step);
    EXPECT_NEAR(sample(map, {64, 10.5}).value, 0.75, half_step);
    // A quarter of the first, three quarters of nothing: less of it, not a lesser value.
    EXPECT_EQ(sample(map, {62.75, 10.5}), (Paint{1, 0.25f}));
    EXPECT_EQ(sample(map, {63.5, 11}), (Paint{1, 0.5f}));
    EXPECT_EQ(sample(map, {62.5, 10.5}), Paint{});
}

TEST(PaintSample, ContinuesToTheMapsEdgeAndNotBeyond) {
    PaintMap map = new_paint_map(256, 128);
    put(map, 0, 0, {0.5f, 1});
    put(map, 255, 127, {1, 0.75f});
    EXPECT_EQ(sample(map, {0, 0}), texel(map, 0, 0));
    EXPECT_EQ(sample(map, {256, 128}), texel(map, 255, 127));
    EXPECT_EQ(sample(map, {-1e-9, 0}), Paint{});
    EXPECT_EQ(sample(map, {256, 128.001}), Paint{});
    EXPECT_EQ(sample(map, {double(nan), 0}), Paint{});
    EXPECT_EQ(sample(PaintMap{}, {0, 0}), Paint{});
}

TEST(PaintSample, IsExactAtCentresAndWithinItsTexels) {
    PaintMap map = new_paint_map(256, 256);
    expect_always("sample(centre) = texel; in between neither more nor less than around", [&] {
        const int x = *whole(0, 254), y = *whole(0, 254);
        float least = 1, most = 0, coverage = 0;
        for (const int i : {0, 1})
            for (const int j : {0, 1}) {
                put(map, x + i, y + j, {float(*real(0, 1)), float(*real(0, 1))});
                const Paint paint = texel(map, x + i, y + j);
                RC_ASSERT(sample(map, {x + i + 0.5, y + j + 0.5}) == paint);
                coverage = std::max(coverage, paint.coverage);
                if (paint.coverage > 0)
                    least = std::min(least, paint.value), most = std::max(most, paint.value);
            }
        const Paint between = sample(map, {x + 0.5 + *real(0, 1), y + 0.5 + *real(0, 1)});
        // The last digit of a float may be rounded up.
        RC_ASSERT(between.coverage <= coverage + 6e-8f);
        if (between.coverage > 0) RC_ASSERT(between.value >= least - 6e-8f && between.value <= most + 6e-8f);
    });
}

using Shares = std::vector<float>;

Shares settled(const Shares& automatic, const std::vector<Paint>& paint,
               std::vector<std::uint8_t> locked = {}) {
    locked.resize(automatic.size());
    Shares result(automatic.size(), -1);
    settle(automatic, paint, locked, result);
    return result;
}

/// Each share is one float: 6e-8 of itself, and hand numbers are floats too.
void expect_shares(const Shares& found, const Shares& expected) {
    ASSERT_EQ(found.size(), expected.size());
    for (std::size_t i = 0; i < found.size(); ++i) EXPECT_NEAR(found[i], expected[i], 1.2e-7) << i;
}

constexpr Paint none{0, 0};
constexpr Paint full(float value) { return {value, 1}; }

TEST(Settle, WithoutPaintIsTheAutomaticShare) {
    EXPECT_EQ(settled({1, 3}, {none, none}), (Shares{0.25f, 0.75f}));
    EXPECT_EQ(settled({7}, {none}), Shares{1});
    EXPECT_EQ(settled({0, 1e-40f, 0}, {none, none, none}), (Shares{0, 1, 0}));
    EXPECT_EQ(settled({3e38f, 3e38f}, {none, none}), (Shares{0.5f, 0.5f}));
}

TEST(Settle, GivesACoveredProbeItsShareAndDividesTheRest) {
    expect_shares(settled({1, 1, 2}, {full(0.4f), none, none}), {0.4f, 0.2f, 0.4f});
    expect_shares(settled({1, 1, 2}, {full(0), none, none}), {0, 1.0f / 3, 2.0f / 3});
    expect_shares(settled({1, 1, 2}, {full(1), none, none}), {1, 0, 0});
    expect_shares(settled({1, 1, 2}, {full(0.5f), full(0.25f), none}), {0.5f, 0.25f, 0.25f});
    // Half covered with 1: it paints 1/2, and half of its 1/2 follows x = (1/2) / (1/4 + 1/2).
    expect_shares(settled({1, 1}, {{1, 0.5f}, none}), {2.0f / 3, 1.0f / 3});
    // The value under no coverage means nothing.
    expect_shares(settled({1, 1}, {{1, 0}, none}), {0.5f, 0.5f});
}

TEST(Settle, DividesWhereTooMuchOrTooLittleIsPainted) {
    expect_shares(settled({1, 1, 2}, {full(0.8f), full(0.8f), none}), {0.5f, 0.5f, 0});
    expect_shares(settled({1, 1, 2}, {full(1), {1, 0.5f}, none}), {2.0f / 3, 1.0f / 3, 0});
    // Nobody follows: the others are covered too, or their automatic weights are 0.
    expect_shares(settled({1, 1}, {full(0.2f), full(0.6f)}), {0.25f, 0.75f});
    expect_shares(settled({1, 0}, {full(0.5f), none}), {1, 0});
    expect_shares(settled({5}, {full(0)}), {1});
    expect_shares(settled({1, 3}, {full(0), full(0)}), {0.25f, 0.75f});
}

TEST(Settle, LockedProbesComeFirst) {
    expect_shares(settled({1, 1, 2}, {none, none, full(0.5f)}, {1, 0, 0}), {0.25f, 0.25f, 0.5f});
    expect_shares(settled({1, 1, 2}, {none, full(1), none}, {1, 0, 0}), {0.25f, 0.75f, 0});
    // 1/2 x 1 + 1/2 x 1/4; the others divide 3/8 as 1 to 2.
    expect_shares(settled({1, 1, 2}, {{1, 0.5f}, none, none}, {1, 0, 0}), {0.625f, 0.125f, 0.25f});
    // Its own paint against its lock alone.
    expect_shares(settled({1, 1, 2}, {full(0.4f), none, none}, {1, 0, 0}), {0.4f, 0.2f, 0.4f});
    expect_shares(settled({1, 1, 2}, {none, none, none}, {1, 1, 1}), {0.25f, 0.25f, 0.5f});
    expect_shares(settled({1, 1, 2}, {none, none, none}, {0, 1, 0}), {0.25f, 0.25f, 0.5f});
}

TEST(Settle, LockedProbesDivideWhereTheyMust) {
    // More than there is.
    expect_shares(settled({1, 1, 2}, {full(0.8f), full(0.8f), none}, {1, 1, 0}), {0.5f, 0.5f, 0});
    expect_shares(settled({1, 1, 2}, {full(1), full(0.8f), full(0.7f)}, {1, 0, 0}), {1, 0, 0});
    expect_shares(settled({1, 1, 2}, {full(0.9f), full(0.3f), full(0.7f)}, {1, 0, 0}), {0.9f, 0.03f, 0.07f});
    // Nobody else takes the rest.
    expect_shares(settled({1, 1}, {none, full(0)}, {1, 0}), {1, 0});
    expect_shares(settled({1, 3, 0}, {full(0.1f), full(0.3f), none}, {1, 1, 0}), {0.25f, 0.75f, 0});
    expect_shares(settled({1, 3}, {full(0), full(0)}, {1, 0}), {0.25f, 0.75f});
    expect_shares(settled({1, 3}, {full(0), full(0)}, {1, 1}), {0.25f, 0.75f});
}

TEST(Settle, MayWriteOverTheAutomaticWeights) {
    Shares shares{1, 1, 2};
    settle(shares, std::vector<Paint>{full(0.4f), none, none}, std::vector<std::uint8_t>{0, 0, 0}, shares);
    expect_shares(shares, {0.4f, 0.2f, 0.4f});
}

struct Place {
    Shares automatic;
    std::vector<Paint> paint;
    std::vector<std::uint8_t> locked;
};

/// Nothing, everything, and what lies between, each often.
Place any_place() {
    Place place;
    const auto part = [] { return std::array{0.0f, 1.0f, float(*real(0, 1))}[std::size_t(*whole(0, 2))]; };
    const int count = *whole(1, 7);
    for (int i = 0; i < count; ++i) {
        place.automatic.push_back(*whole(0, 3) ? std::abs(float(*magnitude(-12, 0))) : 0.0f);
        place.paint.push_back({part(), part()});
        place.locked.push_back(*whole(0, 3) == 0);
    }
    place.automatic[std::size_t(*whole(0, count - 1))] = 1;
    return place;
}

TEST(Settle, SharesAreNeverNegativeAndSumToOne) {
    expect_always("0 <= share <= 1, sum 1", [] {
        const Place place = any_place();
        const Shares shares = settled(place.automatic, place.paint, place.locked);
        for (const float share : shares) RC_ASSERT(share >= 0 && share <= 1);  // false for NaN
        // Each share is rounded once: by at most 6e-8 of itself.
        RC_ASSERT(std::abs(std::accumulate(shares.begin(), shares.end(), 0.0) - 1) <= 6.1e-8);
    });
}

TEST(Settle, DoesNotDependOnTheProbesOrder) {
    expect_always("settle(permuted) = permuted(settle)", [] {
        const Place place = any_place();
        std::vector<std::size_t> order(place.automatic.size());
        std::iota(order.begin(), order.end(), std::size_t{0});
        for (std::size_t i = order.size(); i-- > 1;)
            std::swap(order[i], order[std::size_t(*whole(0, int(i)))]);
        Place permuted;
        for (const std::size_t i : order) {
            permuted.automatic.push_back(place.automatic[i]);
            permuted.paint.push_back(place.paint[i]);
            permuted.locked.push_back(place.locked[i]);
        }
        const Shares shares = settled(place.automatic, place.paint, place.locked);
        const Shares others = settled(permuted.automatic, permuted.paint, permuted.locked);
        // The sums are doubles; only the last digit of a float may be rounded otherwise.
        for (std::size_t i = 0; i < order.size(); ++i)
            RC_ASSERT(std::abs(shares[order[i]] - others[i]) <= 1.2e-7f);
    });
}

TEST(Settle, AFullyCoveredProbeHasExactlyItsShare) {
    expect_always("c = 1 alone: share = v, to the last bit", [] {
        Place place = any_place();
        place.automatic.push_back(1);  // somebody who follows
        const auto probe = std::size_t(*whole(0, int(place.automatic.size()) - 2));
        const float value = from_stored(std::uint16_t(*whole(0, paint_one)));
        std::vector<Paint> paint(place.automatic.size());
        paint[probe] = full(value);
        RC_ASSERT(settled(place.automatic, paint)[probe] == value);
    });
}

TEST(Settle, PaintThatSaysTheAutomaticShareChangesNothing) {
    expect_always("v = a: settled = a, whatever the coverage", [] {
        Place place = any_place();
        const Shares before = settled(place.automatic, std::vector<Paint>(place.automatic.size()));
        for (std::size_t i = 0; i < before.size(); ++i) place.paint[i].value = before[i];
        const Shares after = settled(place.automatic, place.paint, place.locked);
        // Values are floats: their sum, and with it what is left, is 6e-8 off; so is what comes out.
        for (std::size_t i = 0; i < before.size(); ++i) RC_ASSERT(std::abs(after[i] - before[i]) <= 3e-7f);
    });
}

}  // namespace
}  // namespace probewarp
