// The brush: where a dab on the deformed picture falls, and what each operation leaves on the paint.
#include "model/brush.h"

#include <glm/geometric.hpp>
#include <limits>
#include <map>

#include "generators.h"

namespace probewarp {
namespace {

using testing::expect_always;
using testing::real;
using testing::whole;

constexpr double degrees = std::numbers::pi / 180;

/// A picture of 512 x 512 over 64 x 64 cells, with a paint map of a texel a pixel.
struct Scene {
    Image image;
    Mesh mesh;
    std::vector<glm::vec2> now;
    PaintMap map = new_paint_map(512, 512);
    PictureFrame frame{{256, 256}, 512};

    Scene() : mesh(grid_mesh(512, 512, 64)), now(mesh.rest) {
        image.width = image.height = 512;
        image.rgba = std::vector<std::uint8_t>(std::size_t{512} * 512 * 4, 255);
    }
    void set_alpha(int x, int y, std::uint8_t alpha) {
        std::get<0>(image.rgba)[(std::size_t(y) * 512 + std::size_t(x)) * 4 + 3] = alpha;
    }
    template <class Where>
    void move(const Where& where) {
        for (std::size_t i = 0; i < now.size(); ++i) now[i] = where(glm::dvec2(mesh.rest[i]));
    }
    Mask dab_at(glm::dvec2 centre, const Brush& brush) const {
        return dab_mask(map, frame, mesh, now, image, brush, centre);
    }
};

Brush round_brush(double radius, double hardness = 0) {
    Brush brush;
    brush.radius = radius;
    brush.hardness = hardness;
    return brush;
}

float strength_at(const Mask& mask, int x, int y) {
    x -= mask.left, y -= mask.top;
    if (x < 0 || y < 0 || x >= mask.width || y >= mask.height) return 0;
    return mask.strength[std::size_t(y) * std::size_t(mask.width) + std::size_t(x)];
}

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
    const Scene scene;
    for (const Brush& brush : {round_brush(40), round_brush(17.3, 0.6)})
        for (const glm::dvec2 centre : {glm::dvec2(200, 300), glm::dvec2(77.7, 99.1)})
            expect_falloff(scene.dab_at(centre, brush), scene.map, brush, centre,
                           [](glm::dvec2 p) { return p; });
}

TEST(DabMask, FollowsTheDeformedPicture) {
    Scene scene;
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
    const Scene scene;
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
    const Scene scene;
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
    Scene stretched;
    stretched.move([](glm::dvec2 p) { return 50.0 * p; });
    EXPECT_EQ(strength_at(stretched.dab_at({5001, 5001}, round_brush(5)), 100, 100), 1);
}

/// The right half laid over the left: it comes later in each row of cells.
Scene folded() {
    Scene scene;
    scene.move([](glm::dvec2 p) { return glm::dvec2(p.x > 256 ? 512 - p.x : p.x, p.y); });
    return scene;
}

TEST(DabMask, PaintsOnlyTheLayerOnTop) {
    const Scene scene = folded();
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
    Scene scene = folded();
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
    Scene scene;
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
        Scene scene;
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
    const Scene scene;
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
    const Scene scene;
    const Mask click = scene.dab_at({180.5, 300.5}, round_brush(0.1));
    expect_always("the strongest texel stays as strong", [&] {
        const MirrorAxis axis{{*real(200, 300), 256}, *real(-0.1, 0.1)};
        const Mask across = mirrored(click, scene.map, scene.map, scene.frame, axis);
        const glm::dvec2 at = reflect(axis, {180.5, 300.5});
        RC_ASSERT(strength_at(across, int(at.x), int(at.y)) == 1);
    });
}

/// Paint on one texel, and a dab there.
struct OneTexel {
    PaintMap map = new_paint_map(256, 256);
    Stroke stroke;

    explicit OneTexel(Paint before) {
        edit_texels(map, 10, 10, 11, 11, [=](int, int, Paint) { return before; });
        stroke.before = map;
    }
    Paint fall(const Brush& brush, float mask, bool inverted = false, float share = 0) {
        dab(map, stroke, {10, 10, 1, 1, {mask}, 1}, brush, inverted, [=](int, int) { return share; });
        return texel(map, 10, 10);
    }
};

Brush brush_of(BrushMode mode, double value, double strength = 1) {
    Brush brush;
    brush.mode = mode;
    brush.value = value;
    brush.strength = strength;
    return brush;
}

/// A texel holds steps of 1/65535, before the dab and after; the value's step before counts less than whole.
void expect_paint(Paint found, double value, double coverage) {
    EXPECT_NEAR(found.value, value, 1.01 / 65535);
    EXPECT_NEAR(found.coverage, coverage, 1.01 / 65535);
}

TEST(Dab, ReplacePaintsItsValue) {
    // c' = 1 - 1/2 1/2; v' = (1/2 1/2 0.2 + 1/2 1) / c'
    expect_paint(OneTexel({0.2f, 0.5f}).fall(brush_of(BrushMode::replace, 1), 0.5f), 0.55 / 0.75, 0.75);
    expect_paint(OneTexel({0.2f, 0.5f}).fall(brush_of(BrushMode::replace, 1, 0.5), 1), 0.55 / 0.75, 0.75);
    EXPECT_EQ(OneTexel({0.2f, 0.5f}).fall(brush_of(BrushMode::replace, 1), 1), (Paint{1, 1}));
    expect_paint(OneTexel({}).fall(brush_of(BrushMode::replace, 0.3), 0.25f), 0.3, 0.25);
    expect_paint(OneTexel({0.2f, 1}).fall(brush_of(BrushMode::replace, 0.6), 0.25f), 0.3, 1);
    expect_paint(OneTexel({}).fall(brush_of(BrushMode::replace, 0.3), 1, true), 0.7, 1);
    EXPECT_EQ(OneTexel({}).fall(brush_of(BrushMode::replace, 0), 1), (Paint{0, 1}));
}

TEST(Dab, AddAndSubtractStartFromTheShare) {
    const Brush add = brush_of(BrushMode::add, 0.4), subtract = brush_of(BrushMode::subtract, 0.4);
    for (const bool inverted : {false, true}) {
        const Brush &up = inverted ? subtract : add, &down = inverted ? add : subtract;
        expect_paint(OneTexel({0.9f, 0.5f}).fall(up, 1, inverted, 0.3f), 0.7, 1);
        expect_paint(OneTexel({}).fall(up, 1, inverted, 0.8f), 1, 1);
        expect_paint(OneTexel({}).fall(down, 1, inverted, 0.9f), 0.5, 1);
        expect_paint(OneTexel({}).fall(down, 1, inverted, 0.3f), 0, 1);
        // (1/2 1/2 0.2 + 1/2 0.7) / 0.75
        expect_paint(OneTexel({0.2f, 0.5f}).fall(up, 0.5f, inverted, 0.3f), 0.4 / 0.75, 0.75);
    }
}

TEST(Dab, EraseTakesCoverageAndLeavesTheValue) {
    const Brush erase = brush_of(BrushMode::erase, 0.9);
    expect_paint(OneTexel({0.2f, 0.5f}).fall(erase, 0.5f), 0.2, 0.25);
    OneTexel gone({0.2f, 0.5f});
    EXPECT_EQ(gone.fall(erase, 1), Paint{});
    EXPECT_TRUE(is_blank(gone.map));
    EXPECT_EQ(gone.map, new_paint_map(256, 256));
    OneTexel nothing({});
    nothing.fall(erase, 1);
    EXPECT_EQ(nothing.map, nothing.stroke.before);
}

TEST(Dab, SmoothPaintsTheMeanShareAround) {
    const auto smoothed = [](int x, int y, double radius, const ShareAt& share) {
        PaintMap map = new_paint_map(256, 256);
        Stroke stroke{map, {}, {}};
        dab(map, stroke, {x, y, 1, 1, {1}, radius}, brush_of(BrushMode::smooth, 0), false, share);
        return texel(map, x, y);
    };
    // A texel more on each side: 3 x 3, or 2 x 2 in the corner.
    expect_paint(smoothed(64, 64, 4, [](int x, int y) { return x == 63 && y == 63 ? 0.9f : 0; }), 0.1, 1);
    expect_paint(smoothed(0, 0, 4, [](int x, int y) { return x + y == 1 ? 0.8f : 0; }), 0.4, 1);
    expect_paint(smoothed(255, 255, 4, [](int x, int y) { return x + y == 509 ? 0.8f : 0; }), 0.4, 1);
    expect_paint(smoothed(64, 64, 4, [](int x, int) { return x == 62 ? 1.0f : 0; }), 0, 1);
    // A radius of 32 reaches 4: 9 columns.
    expect_paint(smoothed(64, 64, 32, [](int x, int) { return x == 60 ? 0.9f : 0; }), 0.1, 1);
    expect_paint(smoothed(64, 64, 32, [](int x, int) { return x == 59 ? 0.9f : 0; }), 0, 1);
}

TEST(Dab, AsksForEachShareOnce) {
    for (const BrushMode mode : {BrushMode::add, BrushMode::smooth, BrushMode::replace, BrushMode::erase}) {
        const Scene scene;
        PaintMap map = scene.map;
        Stroke stroke{map, {}, {}};
        Brush brush = brush_of(mode, 0.5);
        brush.radius = 20;
        std::map<std::pair<int, int>, int> asked;
        const ShareAt share = [&](int x, int y) { return ++asked[{x, y}], 0.0f; };
        for (const double x : {100, 105, 128, 100})
            dab(map, stroke, scene.dab_at({x, 128}, brush), brush, false, share);
        EXPECT_EQ(asked.empty(), mode == BrushMode::replace || mode == BrushMode::erase);
        for (const auto& [at, times] : asked) ASSERT_EQ(times, 1) << at.first << ", " << at.second;
    }
}

TEST(Dab, DoesNotPileUpWithinAStrokeUnlessAsked) {
    for (const BrushMode mode : {BrushMode::replace, BrushMode::add, BrushMode::smooth, BrushMode::erase}) {
        OneTexel again({0.2f, 0.5f});
        const Brush brush = brush_of(mode, 0.4);
        const Paint once = again.fall(brush, 0.5f, false, 0.5f);
        const PaintMap after = again.map;
        for (int i = 0; i < 5; ++i) EXPECT_EQ(again.fall(brush, 0.5f, false, 0.5f), once);
        EXPECT_EQ(again.fall(brush, 0.3f, false, 0.5f), once);
        EXPECT_EQ(again.map, after) << "and no tile is copied for it";
    }
    OneTexel texel({});
    Brush brush = brush_of(BrushMode::replace, 1, 0.5);
    brush.build_up = true;
    expect_paint(texel.fall(brush, 1), 1, 0.5);
    expect_paint(texel.fall(brush, 1), 1, 0.75);
    expect_paint(texel.fall(brush, 0.5f), 1, 0.8125);
}

/// Bytes of a map, null tiles as zeros.
std::vector<PaintTile> bytes_of(const PaintMap& map) {
    std::vector<PaintTile> tiles;
    for (const auto& tile : map.tiles) tiles.push_back(tile ? *tile : PaintTile{});
    return tiles;
}

bool same_bytes(const std::vector<PaintTile>& a, const std::vector<PaintTile>& b) {
    return std::ranges::equal(
        a, b, [](const auto& s, const auto& t) { return s.value == t.value && s.coverage == t.coverage; });
}

BrushMode any_mode() { return BrushMode(*whole(int(BrushMode::replace), int(BrushMode::erase))); }

float some_share(int x, int y) { return float((x * 7 + y * 13) % 101) / 100; }

struct Dabs {
    Brush brush;
    bool inverted = false;
    std::vector<Mask> masks;
};

Dabs any_dabs(const Scene& scene, int most) {
    Dabs dabs;
    dabs.brush = brush_of(any_mode(), *real(0, 1), *real(0.01, 1));
    dabs.brush.radius = *real(0.1, 50);
    dabs.brush.hardness = *real(0, 1);
    dabs.inverted = *whole(0, 1);
    for (int i = *whole(1, most); i > 0; --i)
        dabs.masks.push_back(scene.dab_at({*real(-30, 200), *real(-30, 200)}, dabs.brush));
    return dabs;
}

TEST(Stroke, DoesNotDependOnTheDabsOrder) {
    const Scene scene;
    expect_always("forwards = backwards, to the last bit", [&] {
        PaintMap before = scene.map;
        edit_texels(before, 0, 0, 90, 512, [](int x, int y, Paint) {
            return Paint{some_share(y, x), some_share(x, x)};
        });
        Dabs dabs = any_dabs(scene, 5);
        PaintMap one = before, other = before;
        Stroke forwards{before, {}, {}}, backwards{before, {}, {}};
        for (const Mask& mask : dabs.masks) dab(one, forwards, mask, dabs.brush, dabs.inverted, some_share);
        std::ranges::reverse(dabs.masks);
        for (const Mask& mask : dabs.masks)
            dab(other, backwards, mask, dabs.brush, dabs.inverted, some_share);
        RC_ASSERT(same_bytes(bytes_of(one), bytes_of(other)));
    });
}

TEST(Stroke, KeepsToItsMasksItsRangeAndItsOwnTiles) {
    const Scene scene;
    expect_always("random strokes one after the other", [&] {
        PaintMap map = scene.map;
        for (int strokes = *whole(1, 4); strokes > 0; --strokes) {
            const PaintMap before = map;
            const auto bytes = bytes_of(before);
            Stroke stroke{before, {}, {}};
            Dabs dabs = any_dabs(scene, 4);
            dabs.brush.build_up = *whole(0, 1);
            for (const Mask& mask : dabs.masks) dab(map, stroke, mask, dabs.brush, dabs.inverted, some_share);
            RC_ASSERT(same_bytes(bytes_of(before), bytes));  // what undo goes back to
            for (std::size_t t = 0; t < map.tiles.size(); ++t) {
                if (!map.tiles[t]) continue;
                bool covered = false;
                for (std::size_t i = 0; i < map.tiles[t]->value.size(); ++i) {
                    covered = covered || map.tiles[t]->coverage[i];
                    RC_ASSERT(map.tiles[t]->coverage[i] || !map.tiles[t]->value[i]);
                }
                RC_ASSERT(covered);
            }
            for (int y = 0; y < 256; ++y)
                for (int x = 0; x < 256; ++x) {
                    const bool touched = std::ranges::any_of(
                        dabs.masks, [=](const Mask& mask) { return strength_at(mask, x, y) > 0; });
                    if (!touched) RC_ASSERT(texel(map, x, y) == texel(before, x, y));
                }
            // Those that no mask meets are the same tiles still: the dabs reach no further than 250, of 8 x 8
            // tiles the first 4 x 4.
            for (std::size_t t = 0; t < 64; ++t)
                if (t / 8 >= 4 || t % 8 >= 4) RC_ASSERT(map.tiles[t] == before.tiles[t]);
        }
    });
}

TEST(Stroke, ErasesEverythingBackToABlankMap) {
    const Scene scene;
    PaintMap map = scene.map;
    Stroke paints{map, {}, {}};
    const Brush brush = round_brush(50);
    for (const double x : {200, 220, 240}) dab(map, paints, scene.dab_at({x, 256}, brush), brush, false, {});
    EXPECT_FALSE(is_blank(map));
    Stroke erases{map, {}, {}};
    Brush eraser = round_brush(200, 1);
    eraser.mode = BrushMode::erase;
    dab(map, erases, scene.dab_at({220, 256}, eraser), eraser, false, {});
    EXPECT_EQ(map, scene.map);
}

TEST(DabsBetween, AreASpacingApart) {
    Brush brush = round_brush(100);
    brush.spacing = 0.15;
    const auto xs = [&](double to) {
        std::vector<double> found;
        for (const glm::dvec2 p : dabs_between({0, 5}, {to, 5}, brush)) {
            EXPECT_EQ(p.y, 5);
            found.push_back(std::round(p.x * 1e9) / 1e9);
        }
        return found;
    };
    EXPECT_EQ(xs(45), (std::vector<double>{15, 30, 45}));
    EXPECT_EQ(xs(44.9), (std::vector<double>{15, 30}));
    EXPECT_EQ(xs(-31), (std::vector<double>{-15, -30}));
    EXPECT_TRUE(xs(14.9).empty());
    EXPECT_TRUE(xs(0).empty());
    const auto slanted = dabs_between({0, 0}, {90, 120}, brush);
    ASSERT_EQ(slanted.size(), 10u);
    EXPECT_NEAR(slanted[0].x, 9, 1e-12);
    EXPECT_NEAR(slanted[0].y, 12, 1e-12);
}

TEST(DabsBetween, HaveAnEnd) {
    Brush brush = round_brush(1e-9);
    const auto many = dabs_between({0, 0}, {1e6, 0}, brush);
    ASSERT_EQ(many.size(), 4096u);
    EXPECT_NEAR(many.back().x, 1e6, 1e-6);
    EXPECT_TRUE(dabs_between({0, 0}, {NAN, 0}, brush).empty());
    EXPECT_TRUE(dabs_between({0, 0}, {INFINITY, 0}, brush).empty());
}

}  // namespace
}  // namespace probewarp
