// Where a dab on the deformed picture falls on the paint, and where its mirror image does.
#include <glm/geometric.hpp>
#include <limits>

#include "brush_scene.h"
#include "generators.h"
#include "pictures.h"

namespace probewarp {
namespace {

using testing::BrushScene;
using testing::degrees;
using testing::expect_always;
using testing::real;
using testing::round_brush;
using testing::strength_at;
using testing::whole;

/// Every texel of the map has the falloff of its distance, where `place` says it lies on the deformed
/// picture.
template <class PlaceOf>
void expect_falloff(const Mask& mask, const PaintMap& map, const Brush& brush, glm::dvec2 centre,
                    const PlaceOf& place) {
    int painted = 0;
    for (int y = 0; y < map.height; ++y)
        for (int x = 0; x < map.width; ++x) {
            const glm::dvec2 from = place(glm::dvec2(x + 0.5, y + 0.5)) - centre;
            const double expected = falloff(std::hypot(from.x, from.y), brush.radius, brush.hardness);
            // Vertices are floats, 3e-5 pixels off at 512, and the falloff's slope is at most 1.5 / radius.
            ASSERT_NEAR(strength_at(mask, x, y), expected, 1e-4 / brush.radius + 1e-6) << x << ", " << y;
            painted += expected > 0;
        }
    EXPECT_GT(painted, 0);
}

TEST(Falloff, IsASmoothStepFromTheHardPartToTheRadius) {
    EXPECT_EQ(falloff(0, 10, 0), 1);
    EXPECT_EQ(falloff(5, 10, 0), 0.5);
    EXPECT_EQ(falloff(7.5, 10, 0), 0.15625);  // 3/16 - 2/64
    EXPECT_EQ(falloff(5, 10, 0.5), 1);
    EXPECT_EQ(falloff(7.5, 10, 0.5), 0.5);
    for (const double hardness : {0.0, 0.5, 1.0}) {
        EXPECT_EQ(falloff(10, 10, hardness), 0);
        EXPECT_EQ(falloff(1e300, 10, hardness), 0);
        EXPECT_EQ(falloff(std::numeric_limits<double>::quiet_NaN(), 10, hardness), 0);
    }
    EXPECT_EQ(falloff(9.999999, 10, 1), 1);
}

TEST(DabMask, IsADiscOnThePictureAtRest) {
    const BrushScene scene;
    for (const Brush& brush : {round_brush(40), round_brush(17.3, 0.6)})
        for (const glm::dvec2 centre : {glm::dvec2(200, 300), glm::dvec2(77.7, 99.1)})
            expect_falloff(scene.dab_at(centre, brush), scene.map, brush, centre,
                           [](glm::dvec2 p) { return p; });
}

TEST(DabMask, FollowsTheDeformedPicture) {
    BrushScene scene;
    const auto moved = [](glm::dvec2 p) { return p + glm::dvec2(1000, -300); };
    scene.move(moved);
    const Brush brush = round_brush(30);
    expect_falloff(scene.dab_at({1200, -100}, brush), scene.map, brush, {1200, -100}, moved);

    const auto turned = [](glm::dvec2 p) {
        const double c = std::cos(130 * degrees), s = std::sin(130 * degrees);
        return 1.5 * glm::dvec2(c * p.x - s * p.y, s * p.x + c * p.y);
    };
    scene.move(turned);
    const glm::dvec2 centre = turned({100, 400});
    expect_falloff(scene.dab_at(centre, brush), scene.map, brush, centre, turned);
}

TEST(DabMask, HasTheMapsTexelsNotThePictures) {
    const Mesh mesh = grid_mesh(4000, 1000, 50);
    const PaintMap map = new_paint_map(4000, 1000);
    const PictureFrame frame{{2000, 500}, 4000};
    Image image;
    image.width = 4000, image.height = 1000;
    const Brush brush = round_brush(100);
    const Mask mask = dab_mask(map, frame, mesh, mesh.rest, image, brush, {3000, 500});
    expect_falloff(mask, map, brush, {3000, 500}, [&](glm::dvec2 p) { return to_picture(map, frame, p); });
    EXPECT_NEAR(mask.radius, 51.2, 1e-9);
}

TEST(DabMask, ReachesTheBorderFromOutside) {
    const BrushScene scene;
    const Brush brush = round_brush(30);
    const Mask mask = scene.dab_at({-20, 300}, brush);
    expect_falloff(mask, scene.map, brush, {-20, 300}, [](glm::dvec2 p) { return p; });
    EXPECT_GT(strength_at(mask, 0, 300), 0.2f);
    const Mask corner = scene.dab_at({520, 520}, brush);
    EXPECT_GT(strength_at(corner, 511, 511), 0.2f);
    for (const glm::dvec2 nowhere : {glm::dvec2(-31, 300), glm::dvec2(1e9, 1e9), glm::dvec2(NAN, 0)})
        for (const float strength : scene.dab_at(nowhere, brush).strength) EXPECT_EQ(strength, 0);
}

TEST(DabMask, OfATinyBrushIsTheTexelUnderTheCentre) {
    const BrushScene scene;
    expect_always("one whole texel", [&] {
        const glm::dvec2 centre{*real(0, 511.99), *real(0, 511.99)};
        const Mask mask = scene.dab_at(centre, round_brush(*real(1e-6, 0.3)));
        int painted = 0;
        for (const float strength : mask.strength) painted += strength > 0;
        RC_ASSERT(painted == 1);
        RC_ASSERT(strength_at(mask, int(centre.x), int(centre.y)) >= 0.5f);
    });
    // On the picture's very edge, and on a picture stretched so far that the disc falls between the texels.
    EXPECT_EQ(strength_at(scene.dab_at({512, 512}, round_brush(0.01)), 511, 511), 1);
    EXPECT_EQ(strength_at(scene.dab_at({0, 0}, round_brush(0.01)), 0, 0), 1);
    BrushScene stretched;
    stretched.move([](glm::dvec2 p) { return 50.0 * p; });
    EXPECT_EQ(strength_at(stretched.dab_at({5001, 5001}, round_brush(5)), 100, 100), 1);
}

/// The right half laid over the left: it comes later in each row of cells.
BrushScene folded() {
    BrushScene scene;
    scene.move([](glm::dvec2 p) { return glm::dvec2(p.x > 256 ? 512 - p.x : p.x, p.y); });
    return scene;
}

TEST(DabMask, PaintsOnlyTheLayerOnTop) {
    const BrushScene scene = folded();
    const Brush brush = round_brush(60, 0.5);
    const Mask mask = scene.dab_at({128, 256}, brush);
    expect_falloff(mask, scene.map, brush, {128, 256},
                   [](glm::dvec2 p) { return p.x > 256 ? glm::dvec2(512 - p.x, p.y) : glm::dvec2(-999); });
    // At the fold the layers are one, and it is seamless.
    const Mask seam = scene.dab_at({256, 256}, brush);
    for (int x = 200; x < 312; ++x)
        for (int y = 200; y < 312; ++y) {
            const double there = falloff(std::hypot(255.5 - std::min(x, 511 - x), y + 0.5 - 256), 60, 0.5);
            // Two cells' diagonals of 11.3 along the picture at rest, and what a cell of the buffer shows.
            if (x > 256 - 11) {
                ASSERT_NEAR(strength_at(seam, x, y), there, 1e-5) << x << ", " << y;
            } else if (x < 256 - 16) {
                ASSERT_EQ(strength_at(seam, x, y), 0) << x << ", " << y;
            }
        }
}

TEST(DabMask, PixelsWithoutAlphaHideNothing) {
    BrushScene scene = folded();
    for (int y = 230; y < 270; ++y)
        for (int x = 370; x < 400; ++x) scene.set_alpha(x, y, 0);
    const Brush brush = round_brush(60, 0.9);
    const Mask mask = scene.dab_at({128, 256}, brush);
    // Below the hole, and two texels (a cell of the buffer) within it, the lower layer is painted, not the
    // hole; around it, as far beyond, the upper one.
    for (int y = 232; y < 268; ++y)
        for (int x = 372; x < 398; ++x) {
            ASSERT_EQ(strength_at(mask, 511 - x, y), 1) << x << ", " << y;
            ASSERT_EQ(strength_at(mask, x, y), 0) << x << ", " << y;
        }
    for (int x = 340; x < 420; ++x)
        for (const int y : {227, 272}) {
            ASSERT_EQ(strength_at(mask, 511 - x, y), 0);
            ASSERT_GT(strength_at(mask, x, y), 0.5f);
        }
    // Where both are clear, both are painted.
    for (int y = 0; y < 512; ++y)
        for (int x = 0; x < 512; ++x) scene.set_alpha(x, y, 0);
    const Mask both = scene.dab_at({128, 256}, brush);
    EXPECT_EQ(strength_at(both, 128, 256), 1);
    EXPECT_EQ(strength_at(both, 511 - 128, 256), 1);
}

TEST(DabMask, CoversWhatTheOutermostVerticesLookAt) {
    BrushScene scene;
    for (int y = 0; y < 512; ++y)
        for (int x = 256; x < 512; ++x) scene.set_alpha(x, y, 0);
    MeshSettings settings;
    settings.cells = 50;  // 10.24 pixels: the mesh ends amidst a texel, at 266.24
    scene.mesh = probe_mesh(scene.image, 50, visible_cells(scene.image, settings), {});
    scene.now = scene.mesh.rest;
    Brush brush = round_brush(50, 1);
    PaintMap painted = scene.map;
    Stroke stroke{scene.map, {}, {}};
    const Mask mask = scene.dab_at({250, 250}, brush);
    dab(painted, stroke, mask, brush, false, {});
    int outermost = 0;
    for (const glm::vec2 v : scene.mesh.rest) {
        if (std::hypot(v.x - 250, v.y - 250) > 47) continue;  // a texel's support lies within the disc
        EXPECT_EQ(sample(painted, to_texels(scene.map, scene.frame, v)), (Paint{1, 1})) << v.x << ", " << v.y;
        outermost += v.x > 260;
    }
    EXPECT_GT(outermost, 5);
    for (int y = 0; y < 512; ++y) ASSERT_EQ(strength_at(mask, 268, y), 0);
}

TEST(DabMask, SurvivesTrianglesWithoutArea) {
    expect_always("strengths in [0, 1]", [] {
        BrushScene scene;
        const int kind = *whole(0, 3);
        scene.move([=](glm::dvec2 p) {
            if (kind == 0) return glm::dvec2(256);       // to a point
            if (kind == 1) return glm::dvec2(p.x, 256);  // to a line
            if (kind == 2) return glm::dvec2(p.x * 1e-30, p.y * 1e30);
            return p;
        });
        for (int i = 0; i < 100; ++i) {
            const auto v = std::size_t(*whole(0, int(scene.now.size()) - 2));
            scene.mesh.rest[v] = scene.mesh.rest[v + 1];
            const float odd[] = {NAN, INFINITY, -INFINITY, 3e38f, 256};
            scene.now[v + 1].x = odd[*whole(0, 4)];
        }
        const Mask mask = scene.dab_at({256, 256}, round_brush(*real(0.1, 200), *real(0, 1)));
        for (const float s : mask.strength) RC_ASSERT(s >= 0 && s <= 1);  // false for NaN
    });
}

TEST(Mirror, ReflectsInALineClockwiseFromTheVertical) {
    const auto expect_point = [](glm::dvec2 found, glm::dvec2 expected) {
        EXPECT_NEAR(found.x, expected.x, 1e-12);  // a few roundings of 1e-16 at 100
        EXPECT_NEAR(found.y, expected.y, 1e-12);
    };
    EXPECT_EQ(reflect({{100, 0}, 0}, {130, 7}), glm::dvec2(70, 7));
    expect_point(reflect({{0, 50}, 90 * degrees}, {3, 60}), {3, 40});
    // Up and to the right, as seen: what is to the right goes up.
    expect_point(reflect({{0, 0}, 45 * degrees}, {1, 0}), {0, -1});
    expect_always("twice is nothing, and points of the line stay", [] {
        const MirrorAxis axis{{*real(0, 100), *real(0, 100)}, *real(-7, 7)};
        const glm::dvec2 p{*real(-100, 100), *real(-100, 100)};
        RC_ASSERT(glm::distance(reflect(axis, reflect(axis, p)), p) < 1e-12);
        const glm::dvec2 on = axis.point + 30.0 * glm::dvec2(std::sin(axis.angle), -std::cos(axis.angle));
        RC_ASSERT(glm::distance(reflect(axis, on), on) < 1e-12);
    });
}

TEST(Mirror, ReflectsAMask) {
    const BrushScene scene;
    const Mask mask = scene.dab_at({180, 300}, round_brush(40));
    const Mask across = mirrored(mask, scene.map, scene.map, scene.frame, {{256, 0}, 0});
    for (int y = 0; y < 512; ++y)
        for (int x = 0; x < 512; ++x)  // texel on texel; floats of 1e-7
            ASSERT_NEAR(strength_at(across, x, y), strength_at(mask, 511 - x, y), 1e-6) << x << ", " << y;
    EXPECT_EQ(across.radius, mask.radius);

    const MirrorAxis oblique{{200, 256}, 30 * degrees};
    const glm::dvec2 centre = reflect(oblique, {180, 300});
    const Mask turned = mirrored(mask, scene.map, scene.map, scene.frame, oblique);
    for (int y = 0; y < 512; ++y)
        for (int x = 0; x < 512; ++x)  // bilinear: a curvature of 6 / 40^2 over at most 1/8 + 1/8
            ASSERT_NEAR(strength_at(turned, x, y),
                        falloff(std::hypot(x + 0.5 - centre.x, y + 0.5 - centre.y), 40, 0), 1e-3);

    // Onto a map of half as many texels; beyond the map there is nothing.
    PaintMap coarse = new_paint_map(256, 256);
    const Mask half = mirrored(mask, scene.map, coarse, scene.frame, {{256, 0}, 0});
    EXPECT_NEAR(strength_at(half, 165, 149), falloff(std::hypot(1, 1), 40, 0), 1e-3);  // pixel (331, 299)
    EXPECT_NEAR(half.radius, 20, 1e-9);
    const Mask beyond = mirrored(mask, scene.map, scene.map, scene.frame, {{512, 0}, 0});
    for (const float strength : beyond.strength) EXPECT_EQ(strength, 0);
    EXPECT_TRUE(mirrored(Mask{}, scene.map, scene.map, scene.frame, {}).strength.empty());
}

TEST(Mirror, DoesNotFadeADabOfOneTexel) {
    const BrushScene scene;
    const Mask click = scene.dab_at({180.5, 300.5}, round_brush(0.1));
    expect_always("the strongest texel stays as strong", [&] {
        const MirrorAxis axis{{*real(200, 300), 256}, *real(-0.1, 0.1)};
        const Mask across = mirrored(click, scene.map, scene.map, scene.frame, axis);
        const glm::dvec2 at = reflect(axis, {180.5, 300.5});
        RC_ASSERT(strength_at(across, int(at.x), int(at.y)) == 1);
    });
}

}  // namespace
}  // namespace probewarp
