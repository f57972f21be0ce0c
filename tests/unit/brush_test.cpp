// What each of the brush's operations leaves on the paint, and where the dabs of a stroke fall.
#include "model/brush.h"

#include <map>

#include "brush_scene.h"
#include "generators.h"

namespace probewarp {
namespace {

using testing::BrushScene;
using testing::expect_always;
using testing::real;
using testing::round_brush;
using testing::strength_at;
using testing::whole;

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
        const BrushScene scene;
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

Dabs any_dabs(const BrushScene& scene, int most) {
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
    const BrushScene scene;
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
    const BrushScene scene;
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
    const BrushScene scene;
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
