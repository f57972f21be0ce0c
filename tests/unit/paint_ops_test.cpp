// Operations on whole maps by hand-computed numbers; and the shares over the picture, which say what deforms.
#include "model/paint_ops.h"

#include "model/refine.h"

#include <numeric>

#include "generators.h"
#include "model/refine.h"
#include "pictures.h"

namespace probewarp {
namespace {

using testing::add_probe;
using testing::blank_document;
using testing::expect_always;
using testing::real;
using testing::whole;

/// Over a picture of that size, a texel a pixel.
PaintMap map_of(int width, int height) {
    return empty_paint_map(width, height, glm::dvec2(width, height) / double(std::max(width, height)));
}

PictureFrame frame_over(const PaintMap& map) {
    return {{map.width / 2.0, map.height / 2.0}, double(std::max(map.width, map.height))};
}

template <class Edit>
PaintMap painted(PaintMap map, Edit edit) {
    edit_texels(map, 0, 0, map.width, map.height, [&](int x, int y, Paint) { return edit(x, y); });
    return map;
}

PaintPtr shared(PaintMap map) { return std::make_shared<const PaintMap>(std::move(map)); }

Deformation deformation_of(const Document& document) {
    Deformation deformation;
    update(deformation, document);
    return deformation;
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

// ---- shares over the picture ----

Document three_probes(int cells = 4) {
    Document document = blank_document(40, 30, cells);
    for (const glm::dvec2 rest : {glm::dvec2(8, 9), {30, 12}, {18, 25}}) add_probe(document, rest, rest);
    return document;
}

/// Random values, and coverages that are often whole or none.
PaintMap random_paint() {
    return painted(map_of(40, 30), [](int, int) {
        const int kind = *whole(0, 2);
        return Paint{float(*real(0, 1)), kind == 2 ? float(*real(0, 1)) : float(kind)};
    });
}

std::vector<float> looked_up(const Deformation& deformation, glm::dvec2 point) {
    std::vector<float> shares(deformation.source.probes.size());
    ShareLookup(deformation).at(point, shares);
    return shares;
}

TEST(ShareLookup, WithoutPaintInterpolatesTheVertices) {
    const Deformation deformation = deformation_of(three_probes());
    expect_always("shares_at", [&] {
        const glm::dvec2 point{*real(0, 40), *real(0, 30)};
        const auto wanted = shares_at(deformation, *locate_at_rest(mesh_of(deformation), point));
        const auto found = looked_up(deformation, point);
        for (std::size_t i = 0; i < 3; ++i) RC_ASSERT(std::abs(found[i] - wanted[i]) < 1e-6);  // float's sums
    });
}

TEST(ShareLookup, SettlesThePaintOfThePlaceItself) {
    expect_always("settle over the interpolated weights", [] {
        Document document = three_probes();
        const Deformation bare = deformation_of(document);
        document.probes[0].paint = shared(random_paint());
        document.probes[2].paint = shared(random_paint());
        document.probes[std::size_t(*whole(0, 2))].locked = *whole(0, 1) == 1;
        const Deformation deformation = deformation_of(document);
        const glm::dvec2 point{*real(0, 40), *real(0, 30)};
        // At a probe's own vertex paint opens the automatic weights: the next test.
        const auto anchored = anchored_vertices(mesh_of(bare));
        const auto at = locate_at_rest(mesh_of(bare), point);
        RC_PRE(std::ranges::none_of(at->corners, [&](std::uint32_t v) { return anchored[v]; }));
        auto wanted = looked_up(bare, point);
        std::vector<Paint> paint(3);
        std::vector<std::uint8_t> locked;
        for (std::size_t i = 0; i < 3; ++i) {
            const Probe& probe = document.probes[i];
            const PictureFrame frame = frame_of(document.picture->image);
            if (probe.paint) paint[i] = sample(*probe.paint, to_texels(*probe.paint, frame, point));
            locked.push_back(probe.locked);
        }
        settle(wanted, paint, locked, wanted);
        const auto found = looked_up(deformation, point);
        for (std::size_t i = 0; i < 3; ++i) RC_ASSERT(std::abs(found[i] - wanted[i]) < 1e-6);  // float's sums
    });
}

TEST(ShareLookup, AProbesOwnPlaceCanBePaintedAwayFromIt) {
    Document document = three_probes();
    document.probes[0].paint = shared(filled(map_of(40, 30), 0.25f));
    const auto shares = looked_up(deformation_of(document), document.probes[0].rest);
    EXPECT_EQ(shares[0], from_stored(to_stored(0.25f)));
    EXPECT_NEAR(shares[0] + shares[1] + shares[2], 1, 1e-6);  // three floats
    EXPECT_GT(shares[1], 0);
    EXPECT_GT(shares[2], 0);
}

TEST(ShareLookup, EachMapLiesWhereItsExtentSays) {
    Document document = three_probes();
    document.probes[0].paint = shared(filled(map_of(40, 30), 0.25f));
    PaintMap fine = map_of(400, 300);
    edit_texels(fine, 0, 0, 200, 300, [](int, int, Paint) { return Paint{0.5f, 1}; });
    document.probes[1].paint = shared(fine);
    const Deformation deformation = deformation_of(document);
    const auto left = looked_up(deformation, {19.5, 10}), right = looked_up(deformation, {20.5, 10});
    for (const auto& shares : {left, right}) EXPECT_EQ(shares[0], from_stored(to_stored(0.25f)));
    EXPECT_EQ(left[1], from_stored(to_stored(0.5f)));
    EXPECT_GT(std::abs(right[1] - 0.5f), 0.01f);
}

TEST(ShareLookup, AFullyCoveredTexelHasExactlyItsValue) {
    Document document = three_probes();
    expect_always("the painted share", [&] {
        document.probes[1].paint = shared(painted(map_of(40, 30), [](int, int) {
            return Paint{from_stored(std::uint16_t(*whole(0, 65535))), 1};
        }));
        const Deformation deformation = deformation_of(document);
        const int x = *whole(0, 39), y = *whole(0, 29);
        const auto shares = looked_up(deformation, {x + 0.5, y + 0.5});
        RC_ASSERT(shares[1] == texel(*document.probes[1].paint, x, y).value);
        // Three roundings of floats up to 1.
        RC_ASSERT(std::abs(shares[0] + shares[1] + shares[2] - 1) < 3e-7f);
    });
}

TEST(ShareLookup, BesideTheMeshTheNearestCellSays) {
    Document document = three_probes();
    Picture picture = *document.picture;
    std::vector<std::uint8_t> rgba(std::size_t{40} * 30 * 4, 0);
    for (std::size_t i = 0; i < 40 * 30; ++i)
        rgba[4 * i + 3] = i % 40 < 20 ? 255 : 0;  // the left half is there
    picture.image.rgba = rgba;
    document.picture = std::make_shared<const Picture>(picture);
    document.mesh.margin = 0;
    Deformation deformation = deformation_of(document);
    ASSERT_EQ(mesh_of(deformation).grid[4], no_vertex);  // columns of cells: two there, two left out
    const auto near = [&](glm::dvec2 a, glm::dvec2 b) {
        const auto one = looked_up(deformation, a), other = looked_up(deformation, b);
        // A hair of 1e-9 of a cell lies between the places.
        for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(one[i], other[i], 1e-6);
    };
    near({37, 14}, {20, 14});
    near({20.001, 3}, {20, 3});
    near({90, -50}, {20, 0});  // beside the picture too
    near({-5, 14}, {0, 14});
    EXPECT_GT(std::abs(looked_up(deformation, {20, 14})[1] - looked_up(deformation, {20, 3})[1]), 0.01);
    // Paint counts where it is.
    document.probes[0].paint = shared(painted(map_of(40, 30), [](int x, int) {
        return Paint{1, x > 30 ? 1.0f : 0.0f};
    }));
    deformation = deformation_of(document);
    EXPECT_EQ(looked_up(deformation, {37, 14}), (std::vector<float>{1, 0, 0}));
}

TEST(ShareLookup, StiffOrLimitedWeightsAreTheVertices) {
    for (const bool stiff : {false, true}) {
        Document document = three_probes();
        document.probes[0].paint = shared(painted(map_of(40, 30), [](int x, int) {
            return Paint{1, x < 15 ? 1.0f : 0.0f};
        }));
        if (stiff)
            document.stiffness = shared(filled(map_of(40, 30), 1));
        else
            document.weights.most = 2;
        const Deformation deformation = deformation_of(document);
        for (const glm::dvec2 point : {glm::dvec2(1, 2), {14.5, 20}, {33, 9}}) {
            const auto wanted = shares_at(deformation, *locate_at_rest(mesh_of(deformation), point));
            const auto found = looked_up(deformation, point);
            for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(found[i], wanted[i], 1e-6);  // float's sums
        }
    }
}

TEST(ShareLookup, ARasterHasTheSharesAtItsTexels) {
    const Deformation deformation = deformation_of(three_probes());
    PaintMap map = map_of(20, 15);  // texels of two pixels
    const auto raster = share_raster(deformation, 2, map);
    ASSERT_EQ(raster.share.size(), 300u);
    for (const auto& [x, y] : {std::pair{0, 0}, {19, 14}, {7, 3}})
        EXPECT_EQ(raster.share[std::size_t(20 * y + x)], looked_up(deformation, {2 * x + 1, 2 * y + 1})[2]);
}

// ---- images of the weights ----

constexpr std::array<std::size_t, 3> all_three{0, 1, 2};

TEST(WeightImages, SumToOneAndAreWithinAStepOfTheShares) {
    Document document = three_probes(40);
    document.probes[2].paint = shared(painted(map_of(40, 30), [](int x, int y) {
        return Paint{float(x) / 64, float(y) / 32};
    }));
    const Deformation deformation = deformation_of(document);
    const auto images = weight_images(deformation, all_three, 57, 31);
    const ShareLookup lookup(deformation);
    std::vector<float> shares(3);
    for (std::size_t at = 0; at < 57 * 31; ++at) {
        lookup.at({(double(at % 57) + 0.5) * 40 / 57, (double(at / 57) + 0.5) * 30 / 31}, shares);
        int sum = 0;
        for (std::size_t i = 0; i < 3; ++i) {
            // Rounded up or down, a 64th of a step aside where it is as good as whole.
            ASSERT_NEAR(images[i][at], shares[i] * 65535, 1 + 1.0 / 64);
            sum += images[i][at];
        }
        ASSERT_EQ(sum, 65535);
    }
}

TEST(WeightImages, OfSomeAreThoseOfAll) {
    const Deformation deformation = deformation_of(three_probes());
    const auto all = weight_images(deformation, all_three, 40, 30);
    const auto some = weight_images(deformation, std::array<std::size_t, 2>{2, 0}, 40, 30);
    ASSERT_EQ(some.size(), 2u);
    EXPECT_EQ(some[0], all[2]);
    EXPECT_EQ(some[1], all[0]);
}

TEST(WeightImages, APaintedShareComesOutAsItIs) {
    // So many texels that some lie where a float's rounding before it would tip it over.
    Document document = blank_document(400, 300, 10);
    for (const glm::dvec2 rest : {glm::dvec2(80, 90), {300, 120}, {180, 250}})
        add_probe(document, rest, rest);
    const auto value = [](int x, int y) { return std::uint16_t(unsigned(y * 400 + x) * 40503u); };
    document.probes[1].paint = shared(painted(map_of(400, 300), [&](int x, int y) {
        return Paint{from_stored(value(x, y)), 1};
    }));
    const auto image = weight_images(deformation_of(document), std::array<std::size_t, 1>{1}, 400, 300)[0];
    for (int y = 0; y < 300; ++y)
        for (int x = 0; x < 400; ++x)
            ASSERT_EQ(image[std::size_t(y * 400 + x)], value(x, y)) << x << ' ' << y;
}

TEST(WeightImages, PaintedAsTheyAreComeOutTheSame) {
    expect_always("exactly, for one probe and for all", [] {
        Document document = blank_document(40, 30, *whole(1, 40));
        const int probes = *whole(1, 7);
        std::vector<std::size_t> every;
        for (int i = 0; i < probes; ++i) {
            const glm::dvec2 rest{*real(0, 40), *real(0, 30)};
            add_probe(document, rest, rest);
            every.push_back(std::size_t(i));
        }
        const auto before = weight_images(deformation_of(document), every, 40, 30);
        const auto paint = [&](std::size_t i) {
            ShareRaster raster{40, 30, {}};
            for (const std::uint16_t n : before[i]) raster.share.push_back(from_stored(n));
            document.probes[i].paint = shared(paint_of(map_of(40, 30), raster));
        };
        const auto one = std::size_t(*whole(0, probes - 1));
        paint(one);
        const auto with_one = weight_images(deformation_of(document), every, 40, 30);
        RC_ASSERT(with_one[one] == before[one]);
        for (const std::size_t i : every) paint(i);
        RC_ASSERT(weight_images(deformation_of(document), every, 40, 30) == before);
    });
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
