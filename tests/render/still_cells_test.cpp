// What the mesh leaves out stays where it is: no pixel vanishes because a probe moved, whoever draws, and the
// fitted canvas holds it.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "render/context.h"
#include "render/overlay.h"
#include "scene.h"

namespace probewarp {
namespace {

constexpr int width = 160, height = 120, threshold = 50;

/// A disc with a soft shadow around it, most of which the mesh leaves out.
template <class Sample>
PicturePtr with_shadow() {
    Picture picture;
    picture.image.width = width;
    picture.image.height = height;
    constexpr double most = std::numeric_limits<Sample>::max();
    std::vector<Sample> rgba;
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const double off = std::hypot(x - 80, y - 60);
            const double alpha = off < 20 ? 1 : off < 50 ? 0.4 * (50 - off) / 30 : 0;
            for (const double value : {0.8, x / double(width), y / double(height), alpha})
                rgba.push_back(Sample(value * most));
        }
    picture.image.rgba = std::move(rgba);
    return std::make_shared<const Picture>(std::move(picture));
}

Document moved_by(const PicturePtr& picture, glm::dvec2 way) {
    Document document;
    document.picture = picture;
    document.mesh.threshold = threshold;
    Probe probe = new_probe(document, {80, 60});
    probe.now += way;
    document.probes.push_back(probe);
    return document;
}

/// The largest difference of two images' samples.
int difference(const Image& a, const Image& b) {
    int most = 0;
    for (int y = 0; y < a.height; ++y)
        for (int x = 0; x < a.width; ++x) {
            const auto p = pixel(a, x, y), q = pixel(b, x, y);
            if (p[3] == 0 && q[3] == 0) continue;  // colours under no alpha show nothing
            for (std::size_t k = 0; k < 4; ++k) most = std::max(most, std::abs(p[k] - q[k]));
        }
    return most;
}

template <class Sample>
void expect_nothing_vanishes() {
    const PicturePtr picture = with_shadow<Sample>();
    for (const double scale : {1.0, 2.0, 3.0}) {
        for (const int samples : {1, 2}) {
            Scene rest(moved_by(picture, {0, 0})), moved(moved_by(picture, {0.001, 0}));
            ASSERT_FALSE(moved.deformation.binding->still.triangles.empty());
            const View view = rest.whole(scale);
            const FileStyle style{samples, {}, false};
            // A thousandth of a pixel makes a thousandth of the steepest slope, and rounding one more.
            const int least = int(std::numeric_limits<Sample>::max() * 0.7 * 0.001) + 2;
            EXPECT_LE(difference(moved.by_processor(view, style), rest.by_processor(view, style)), least)
                << scale << " " << samples;
            EXPECT_LE(difference(moved.by_driver(view, style), rest.by_driver(view, style)), least)
                << scale << " " << samples;
        }
    }
}

TEST(StillCells, KeepEveryPixelThatIsSeen) {
    const auto context = open_context("osmesa");
    expect_nothing_vanishes<std::uint8_t>();
    expect_nothing_vanishes<std::uint16_t>();
}

TEST(StillCells, AreThereUnderAnOverlayToo) {
    const auto context = open_context("osmesa");
    Scene scene(moved_by(with_shadow<std::uint8_t>(), {0, 0}));
    const View view = scene.whole(1);
    const Image plain = scene.by_driver(view);
    const int probe = scene.document.probes[0].id;
    scene.renderer.set_overlay(weight_overlay(scene.deformation, probe), {});
    const Image overlaid = scene.by_driver(view, {1, {}, true});
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            EXPECT_NEAR(pixel(overlaid, x, y)[3], pixel(plain, x, y)[3], 1) << x << " " << y;
}

TEST(StillCells, StayWhileTheMeshMovesOverThem) {
    const auto context = open_context("osmesa");
    Scene scene(moved_by(with_shadow<std::uint8_t>(), {40, 0}));
    const Image& picture = scene.document.picture->image;
    for (const Image& shown : {scene.by_processor(scene.whole(1)), scene.by_driver(scene.whole(1))}) {
        // At the left the shadow's rim is as it was, and its inner part has gone with the disc.
        EXPECT_EQ(pixel(shown, 36, 60), pixel(picture, 36, 60));
        EXPECT_GT(pixel(picture, 36, 60)[3], 0);
        EXPECT_EQ(pixel(shown, 55, 60)[3], 0);
        EXPECT_EQ(pixel(shown, 120, 60), pixel(picture, 80, 60));
        // At the right the mesh covers the rim: both are seen.
        const int below = pixel(picture, 125, 60)[3], over = pixel(picture, 85, 60)[3];
        EXPECT_EQ(over, 255);
        EXPECT_GT(below, 0);
        EXPECT_EQ(pixel(shown, 125, 60)[3], 255);
    }
}

TEST(FittedCanvas, HoldsWhatTheMeshLeavesOut) {
    Deformation deformation;
    update(deformation, moved_by(with_shadow<std::uint8_t>(), {70, 0}));
    ExportSettings settings;
    settings.canvas = Canvas::fit;
    const View view = export_view(deformation, settings);
    const Image& picture = deformation.source.picture->image;
    Rasterizer whole(deformation, View{{-200, -200}, {1, 1}, 600, 600}, {});
    Image around = blank(picture, {{}, {}, 600, 600});
    whole.draw_rows(0, around);
    int seen = 0;
    for (int y = 0; y < 600; ++y)
        for (int x = 0; x < 600; ++x) {
            if (pixel(around, x, y)[3] == 0) continue;
            ++seen;
            const double px = x - 200 - view.origin.x, py = y - 200 - view.origin.y;
            EXPECT_TRUE(px >= 0 && py >= 0 && px < view.width && py < view.height) << x << " " << y;
        }
    EXPECT_GT(seen, 5000);
    EXPECT_LT(view.width, 200);  // and not much more
}

}  // namespace
}  // namespace probewarp
