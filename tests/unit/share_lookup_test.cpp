// The shares over the picture, which say what deforms, and images of them.
#include "model/share_lookup.h"

#include "generators.h"
#include "model/paint_ops.h"
#include "model/refine.h"
#include "painted_documents.h"

namespace probewarp {
namespace {

using testing::add_probe;
using testing::blank_document;
using testing::deformation_of;
using testing::expect_always;
using testing::looked_up;
using testing::map_of;
using testing::painted;
using testing::real;
using testing::shared;
using testing::three_probes;
using testing::whole;

// ---- shares over the picture ----

/// Random values, and coverages that are often whole or none.
PaintMap random_paint() {
    return painted(map_of(40, 30), [](int, int) {
        const int kind = *whole(0, 2);
        return Paint{float(*real(0, 1)), kind == 2 ? float(*real(0, 1)) : float(kind)};
    });
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
        RC_PRE(std::ranges::none_of(
            at->corners, [&](std::uint32_t v) { return std::ranges::binary_search(anchored, v); }));
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

}  // namespace
}  // namespace probewarp
