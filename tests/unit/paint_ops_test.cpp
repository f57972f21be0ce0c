// Operations on whole maps and on all of a document's paint, by hand-computed numbers.
#include "model/paint_ops.h"

#include <gtest/gtest.h>

#include <numeric>

#include "painted_documents.h"

namespace probewarp {
namespace {

using testing::add_probe;
using testing::blank_document;
using testing::deformation_of;
using testing::looked_up;
using testing::map_of;
using testing::painted;
using testing::shared;
using testing::three_probes;

PictureFrame frame_over(const PaintMap& map) {
    return {{map.width / 2.0, map.height / 2.0}, double(std::max(map.width, map.height))};
}

/// A line of texels, as the values of its shares.
ShareRaster line(std::vector<float> share) { return {int(share.size()), 1, std::move(share)}; }

// ---- operations on a raster ----

TEST(PaintOps, FillCoversTheMapAndNothingBeyondIt) {
    const PaintMap old = painted(map_of(150, 70), [](int x, int) { return Paint{1, x < 9 ? 1.0f : 0.0f}; });
    const PaintMap map = filled(old, 0.25f);
    EXPECT_EQ(map.extent, old.extent);
    for (int y = 0; y < 70; ++y)
        for (int x = 0; x < 150; ++x)
            ASSERT_EQ(texel(map, x, y), (Paint{from_stored(16384), 1}))
                << x << ' ' << y;                  // 65535 / 4, rounded
    EXPECT_EQ(map.tiles[0], map.tiles[1]);         // full tiles are one
    EXPECT_EQ(map.tiles[2]->coverage[22], 0);      // column 150, of a map of 150
    EXPECT_EQ(map.tiles[3]->coverage[6 * 64], 0);  // row 70, of 70
    EXPECT_FALSE(is_blank(filled(old, 0)));
}

TEST(PaintOps, Invert) { EXPECT_EQ(inverted(line({0, 0.25f, 1})).share, (std::vector<float>{1, 0.75f, 0})); }

TEST(PaintOps, LevelsCutAndBend) {
    const auto cut = levelled(line({0.125f, 0.25f, 0.5f, 0.75f, 1}), 0.25f, 0.75f, 1).share;
    EXPECT_EQ(cut, (std::vector<float>{0, 0, 0.5f, 1, 1}));
    // 0.25^(1/2) and 0.25^2; one rounding of pow.
    EXPECT_NEAR(levelled(line({0.25f}), 0, 1, 2).share[0], 0.5, 1e-7);
    EXPECT_NEAR(levelled(line({0.25f}), 0, 1, 0.5f).share[0], 0.0625, 1e-8);
}

TEST(PaintOps, BlurLeavesAConstant) {
    for (const double radius : {0.0, 0.3, 7.0, 32.0, 33.0, 300.0}) {
        const ShareRaster raster{97, 63, std::vector<float>(97 * 63, 0.3f)};
        const auto result = blurred(raster, radius);
        ASSERT_EQ(result.share.size(), raster.share.size());
        // Sums of some hundred floats.
        for (const float share : result.share) ASSERT_NEAR(share, 0.3, 1e-5) << radius;
    }
}

TEST(PaintOps, BlurMakesAnImpulseTheGaussian) {
    ShareRaster raster{41, 31, std::vector<float>(41 * 31, 0.0f)};
    raster.share[15 * 41 + 20] = 1;
    const auto share = blurred(raster, 2).share;
    // 1 / (2 pi 2^2), and e^(-(3^2 + 4^2) / 8) of it; the tails that are cut hold a ten-thousandth.
    EXPECT_NEAR(share[15 * 41 + 20], 0.0397887, 1e-5);
    EXPECT_NEAR(share[18 * 41 + 24], 0.00174819, 1e-6);
    EXPECT_EQ(share[15 * 41 + 20 - 3], share[15 * 41 + 20 + 3]);
    EXPECT_EQ(share[15 * 41 + 20 + 9], 0);  // beyond four radii
    // A wide one is blurred at half the size, which may shift an impulse by half a texel: by 1/80 of its
    // value at one radius.
    std::vector<float> impulse(641, 0.0f);
    impulse[320] = 1;
    const auto wide = blurred(line(impulse), 40).share;
    EXPECT_NEAR(wide[320], 0.00997356, 1e-5);             // 1 / (sqrt(2 pi) 40)
    EXPECT_NEAR(wide[360], 0.00604927, 0.013 * 0.00605);  // e^(-1/2) of it
    EXPECT_NEAR(std::accumulate(wide.begin(), wide.end(), 0.0), 1, 1e-4);
}

TEST(PaintOps, BeyondTheEdgeABlurFindsNothing) {
    std::vector<float> corner(20, 0.0f);
    corner[0] = 1;
    const auto share = blurred(line(corner), 1).share;
    // With g_d = e^(-d^2 / 2): g_0 / (g_0 + g_1 + .. + g_4), and g_1 / (g_1 + g_0 + g_1 + .. + g_4).
    EXPECT_NEAR(share[0], 1 / 1.7533105, 1e-6);
    EXPECT_NEAR(share[1], 0.6065307 / 2.3598412, 1e-6);
}

TEST(PaintOps, ARasterBecomesPaintThatCoversEverything) {
    const PaintMap map = map_of(70, 3);
    ShareRaster raster{70, 3, {}};
    for (int i = 0; i < 210; ++i) raster.share.push_back(float(i) / 256);
    const PaintMap result = paint_of(painted(map, [](int, int) { return Paint{0.5f, 0.5f}; }), raster);
    for (int i = 0; i < 210; ++i)
        ASSERT_EQ(texel(result, i % 70, i / 70), (Paint{from_stored(to_stored(float(i) / 256)), 1}));
    EXPECT_EQ(result.extent, map.extent);
}

// ---- mirroring ----

/// Of column x and row y: no two alike.
Paint mark(int x, int y) { return {from_stored(std::uint16_t(1000 * x + 10 * y + 7)), 1}; }

TEST(PaintOps, MirrorsTheLeftToTheRight) {
    const PaintMap map = painted(map_of(8, 4), [](int x, int y) { return y == 3 ? Paint{} : mark(x, y); });
    const MirrorAxis axis{{4, 2}, 0};
    const PaintMap left = mirrored_paint(map, frame_over(map), axis, Side::left);
    const PaintMap right = mirrored_paint(map, frame_over(map), axis, Side::right);
    for (int y = 0; y < 4; ++y)
        for (int x = 0; x < 8; ++x) {
            EXPECT_EQ(texel(left, x, y), texel(map, std::min(x, 7 - x), y)) << x << ' ' << y;
            EXPECT_EQ(texel(right, x, y), texel(map, std::max(x, 7 - x), y)) << x << ' ' << y;
        }
}

TEST(PaintOps, MirrorsAcrossALyingAxis) {
    const PaintMap map = painted(map_of(4, 8), mark);
    // Along a quarter turn clockwise from upwards, which is to the right: the left is above.
    const MirrorAxis axis{{2, 4}, 90 * testing::degrees};
    const PaintMap result = mirrored_paint(map, frame_over(map), axis, Side::left);
    for (int y = 0; y < 8; ++y)
        for (int x = 0; x < 4; ++x) EXPECT_EQ(texel(result, x, y), texel(map, x, std::min(y, 7 - y)));
}

TEST(PaintOps, TheAxisItselfStaysAndWhatHasNoImageIsCleared) {
    const PaintMap map = painted(map_of(8, 1), mark);
    const PaintMap result = mirrored_paint(map, frame_over(map), {{3.5, 0}, 0}, Side::left);
    const std::vector expected{mark(0, 0), mark(1, 0), mark(2, 0), mark(3, 0),
                               mark(2, 0), mark(1, 0), mark(0, 0), Paint{}};
    for (int x = 0; x < 8; ++x) EXPECT_EQ(texel(result, x, 0), expected[std::size_t(x)]) << x;
}

TEST(PaintOps, WhatIsReplacedDoesNotShineThrough) {
    const PaintMap map = painted(map_of(40, 30), [](int x, int) {
        return x < 20 ? Paint{0.75f, 1} : Paint{0.125f, 1};
    });
    // Between texels, and slanted: a texel beyond it looks at some that are beyond it too.
    for (const MirrorAxis& axis : {MirrorAxis{{20.25, 15}, 0}, MirrorAxis{{20.0, 0}, 0.0}}) {
        const PaintMap result = mirrored_paint(map, frame_over(map), axis, Side::left);
        for (int x = 0; x < 40; ++x)
            EXPECT_EQ(texel(result, x, 9), (Paint{from_stored(to_stored(0.75f)), 1})) << x;
    }
}

TEST(PaintOps, MirrorsOneMapOntoAnother) {
    const PaintMap from = painted(map_of(8, 2), mark);
    const PaintMap onto = painted(map_of(8, 2), [](int, int) { return Paint{1, 1}; });
    const PaintMap result = mirrored_paint(onto, from, frame_over(onto), {{4, 1}, 0}, Side::left);
    for (int x = 0; x < 8; ++x)
        EXPECT_EQ(texel(result, x, 1), x < 4 ? (Paint{1, 1}) : texel(from, 7 - x, 1)) << x;
    // What lies on the axis is on neither side.
    EXPECT_EQ(texel(mirrored_paint(onto, from, frame_over(onto), {{4.5, 1}, 0}, Side::left), 4, 1),
              (Paint{1, 1}));
}

TEST(PaintOps, ACounterpartIsTheNearestToTheMirrorImage) {
    Document document = blank_document(400, 300);
    for (const glm::dvec2 rest : {glm::dvec2(100, 100), {310, 100}, {305, 100}, {200, 50}, {330, 250}})
        add_probe(document, rest, rest);
    const MirrorAxis axis{{200, 0}, 0};
    EXPECT_EQ(counterpart(document, 0, axis), 2u);  // of 310 and 305 the one nearer to 300
    EXPECT_EQ(counterpart(document, 1, axis), 0u);  // 90 is 10 from 100
    EXPECT_EQ(counterpart(document, 2, axis), 0u);
    EXPECT_EQ(counterpart(document, 3, axis), 3u);  // on the axis
    EXPECT_EQ(counterpart(document, 4, axis), 4u);  // nobody near 70, 250
    std::swap(document.probes[1].rest, document.probes[2].rest);
    EXPECT_EQ(counterpart(document, 0, axis), 1u);  // whichever comes first
    // A twentieth of 400 is too far, a little less is not.
    document.probes[4].rest = {320, 100};
    EXPECT_EQ(counterpart(document, 4, axis), 4u);
    document.probes[4].rest = {319.75, 100};
    EXPECT_EQ(counterpart(document, 4, axis), 0u);
}

// ---- operations on the document ----

/// Every probe painted with one value, coverage 1 on the left half.
Document half_painted(std::array<float, 3> values) {
    Document document = three_probes();
    for (std::size_t i = 0; i < 3; ++i)
        document.probes[i].paint = shared(painted(map_of(40, 30), [&](int x, int) {
            return x < 20 ? Paint{values[i], 1} : Paint{};
        }));
    return document;
}

TEST(PaintOps, NormalisingWritesDownWhatDeforms) {
    const Document document = half_painted({1, 1, 0});
    const Document result = normalised_paint(deformation_of(document));
    const std::array<float, 3> wanted{0.5f, 0.5f, 0};
    for (std::size_t i = 0; i < 3; ++i) {
        EXPECT_EQ(texel(*result.probes[i].paint, 3, 4), (Paint{from_stored(to_stored(wanted[i])), 1}));
        EXPECT_EQ(texel(*result.probes[i].paint, 30, 4), Paint{});
    }
    // Where it says what deforms already, the paint stays the same tiles.
    const Document settled = half_painted({0, 1, 0});
    EXPECT_EQ(normalised_paint(deformation_of(settled)), settled);
    const Document bare = three_probes();
    EXPECT_EQ(normalised_paint(deformation_of(bare)), bare);
}

TEST(PaintOps, NormalisingKeepsHowMuchIsCovered) {
    Document document = three_probes();
    document.probes[1].paint = shared(painted(map_of(40, 30), [](int, int) { return Paint{1, 0.5f}; }));
    const Deformation deformation = deformation_of(document);
    const Document result = normalised_paint(deformation);
    const Paint paint = texel(*result.probes[1].paint, 12, 13);
    EXPECT_EQ(paint.coverage, from_stored(to_stored(0.5f)));
    EXPECT_EQ(paint.value, from_stored(to_stored(looked_up(deformation, {12.5, 13.5})[1])));
    EXPECT_GT(paint.value, 0.5f);
    EXPECT_LT(paint.value, 1);
    EXPECT_EQ(result.probes[0].paint, nullptr);
}

TEST(PaintOps, MapsOfDifferentSizesAreEachNormalised) {
    Document document = half_painted({1, 1, 1});
    document.probes[1].paint = shared(filled(map_of(80, 60), 1));
    document.probes[1].paint = [&] {
        PaintMap map = *document.probes[1].paint;
        map.extent = {1, 0.75};
        return shared(map);
    }();
    const Document result = normalised_paint(deformation_of(document));
    const float third = from_stored(to_stored(1.0f / 3));
    EXPECT_EQ(texel(*result.probes[0].paint, 3, 4).value, third);
    EXPECT_EQ(texel(*result.probes[1].paint, 6, 8).value, third);
    EXPECT_EQ(texel(*result.probes[1].paint, 30, 50).value, third);
    EXPECT_EQ(texel(*result.probes[1].paint, 70, 8).value, 1);  // alone on the right
}

TEST(PaintOps, LimitingDropsTheLighterOnes) {
    const auto values = [](const Document& document) {
        std::array<float, 3> at{};
        for (std::size_t i = 0; i < 3; ++i) at[i] = texel(*document.probes[i].paint, 3, 4).value;
        return at;
    };
    const auto stored = [](std::array<float, 3> x) {
        for (float& value : x) value = from_stored(to_stored(value));
        return x;
    };
    const auto limited = [&](std::array<float, 3> painted, std::size_t most) {
        return values(limited_paint(deformation_of(half_painted(painted)), most));
    };
    EXPECT_EQ(limited({0.5f, 0.25f, 0.125f}, 2), stored({0.5f, 0.25f, 0}));
    EXPECT_EQ(limited({0.125f, 0.25f, 0.5f}, 1), stored({0, 0, 0.5f}));
    EXPECT_EQ(limited({0.25f, 0.5f, 0.5f}, 1), stored({0, 0.5f, 0}));  // the first of equals
    EXPECT_EQ(limited({0.25f, 0.5f, 0.5f}, 3), stored({0.25f, 0.5f, 0.5f}));
    const Document document = half_painted({0.25f, 0.5f, 0.5f});
    EXPECT_EQ(limited_paint(deformation_of(document), 3), document);
    EXPECT_EQ(texel(*limited_paint(deformation_of(document), 1).probes[0].paint, 30, 4), Paint{});
}

}  // namespace
}  // namespace probewarp
