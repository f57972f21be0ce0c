// Exporting's short cuts: what goes straight into integers, and what goes without mipmaps, is what the long
// way gives.
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "render/context.h"
#include "exporting/export.h"
#include "scene.h"

namespace probewarp {
namespace {

/// The layer's weights add up to 1 but for float's rounding, some 2^-23: there a hundredth of the 65535 steps
/// of 16 bits may fall to the neighbour, of the 255 steps of 8 bits one value in 30000.
void expect_the_same_but_for_rounding(const Image& a, const Image& b) {
    std::size_t others = 0, steps = 0;
    for (int y = 0; y < a.height; ++y)
        for (int x = 0; x < a.width; ++x)
            for (std::size_t c = 0; c < 4; ++c) {
                const int off = std::abs(pixel(a, x, y)[c] - pixel(b, x, y)[c]);
                others += off > 1;
                steps += off == 1;
            }
    const double values = 4.0 * a.width * a.height;
    EXPECT_EQ(others, 0u);
    EXPECT_LE(double(steps), values / (a.bits() == 16 ? 100 : 30000));
}

TEST(Straight, IsWhatTheLayerGives) {
    const auto context = open_context("osmesa");
    for (const auto& picture : {noise<std::uint8_t>(300, 200), noise<std::uint16_t>(300, 200)})
        for (const double angle : {0.0, 0.4, 1.5})
            for (const double scale : {1.0, 0.6, 2.5}) {
                Scene scene(pulled(picture, angle));
                const View view = scene.whole(scale);
                for (const auto& background :
                     {std::optional<Colour>{}, std::optional<Colour>{{250, 3, 77}}}) {
                    Image straight = scene.blank(view), layered = straight;
                    scene.render(straight, view, {1, background, false});
                    scene.renderer.draw(view, 1);
                    scene.renderer.read_back(layered, 0, 0, view, 1, background);
                    SCOPED_TRACE(std::to_string(angle) + ", " + std::to_string(scale));
                    expect_the_same_but_for_rounding(straight, layered);
                }
            }
}

TEST(Tiles, DoNotShow) {
    // 4500 x 3000 pixels are two tiles across, the second a narrow one, and twelve down.
    const auto context = open_context("osmesa");
    for (const int clear : {-1, 7}) {
        Scene scene(pulled(noise<std::uint8_t>(300, 200, clear), 0.3));
        const View view = scene.whole(15);
        Image whole = scene.blank(view);
        scene.render(whole, view);
        ExportSettings settings;
        settings.scale = 15;
        ExportJob job(scene.renderer, scene.document, scene.deformation, settings);
        while (!job.done()) job.step();
        const Image tiled = job.take();
        ASSERT_EQ(tiled.rgba.index(), whole.rgba.index());
        std::size_t others = 0, steps = 0;
        const auto &a = std::get<0>(tiled.rgba), &b = std::get<0>(whole.rgba);
        ASSERT_EQ(a.size(), b.size());
        for (std::size_t i = 0; i < a.size(); ++i) {
            const int off = std::abs(a[i] - b[i]);
            others += off > 1;
            steps += off == 1;
        }
        // Places are rounded to 2^-15 of a pixel, from which noise makes 255 / 32768 of a step at most; on
        // the border a pixel may be covered in one of the two only.
        EXPECT_LE(others, 4u * 8);
        EXPECT_LE(double(steps), double(a.size()) / 128);
    }
}

TEST(Straight, IsNotForWhatCanBeSeenThrough) {
    // One clear pixel in the last of a texture's uploads, which hold a million pixels each.
    const auto context = open_context("osmesa");
    Scene scene(pulled(noise<std::uint8_t>(1300, 1200, 1100), 0.2));
    const View view = scene.whole(1);
    Image image = scene.blank(view), layered = image;
    scene.render(image, view);
    scene.renderer.draw(view, 1);
    scene.renderer.read_back(layered, 0, 0, view, 1, {});
    EXPECT_EQ(image.rgba, layered.rgba);
    scene.deformation.moved = false;
    scene.renderer.set_positions({}, false);
    scene.render(image, view);
    EXPECT_EQ(image.rgba, scene.document.picture->image.rgba);
}

TEST(Footprints, WithoutMipmapsNothingChangesWhereNoneAreWanted) {
    const auto context = open_context("osmesa");
    std::size_t without = 0, with = 0;
    for (const double angle : {0.0, 0.1, 0.4, 1.5})
        for (const double scale : {1.0, 0.97, 1.2})
            for (const bool folded : {false, true}) {
                Document document = pulled(noise<std::uint8_t>(400, 300), angle);
                if (folded) document.probes[0].now.x += 250;  // later triangles lie over earlier ones
                Scene scene(document);
                const View whole = scene.whole(scale);
                const Footprints footprints(scene.deformation, whole);
                for (int top = 0; top < whole.height; top += 64)
                    for (int left = 0; left < whole.width; left += 150) {
                        View tile = whole;
                        tile.origin += glm::dvec2(left, top) / whole.scale;
                        tile.width = 150, tile.height = 64;
                        Image mipmapped = scene.blank(tile), plain = mipmapped;
                        scene.render(mipmapped, tile);
                        const auto runs = footprints.runs_within(tile);
                        scene.renderer.render(plain, 0, 0, tile, {}, runs);
                        ASSERT_EQ(plain.rgba, mipmapped.rgba) << left << ", " << top << ", " << angle;
                        for (const TriangleRun& run : runs) (run.shrunk ? with : without) += run.count;
                    }
            }
    EXPECT_GT(without, 10'000u) << "else nothing was tested";
    EXPECT_GT(with, 10'000u) << "else all would do";
}

TEST(Footprints, MoreLevelsThanWantedChangeNothing) {
    const auto context = open_context("osmesa");
    for (const double scale : {1.0, 0.99, 0.9, 0.51, 0.5, 0.49, 0.26, 0.24, 0.05})
        for (const bool moved : {true, false}) {
            Document document = pulled(noise<std::uint8_t>(400, 300), 0.3);
            if (!moved) document.probes.clear();
            Scene scene(document);
            const View view = scene.whole(scale);
            const int wanted = Footprints(scene.deformation, view).wanted_levels();
            Image all = scene.blank(view), few = all;
            scene.render(all, view);
            scene.renderer.set_picture(upload_picture(document.picture->image, wanted));
            scene.render(few, view);
            EXPECT_EQ(few.rgba, all.rgba) << scale;
            if (!moved && scale == 1.0) {
                EXPECT_EQ(wanted, 0);
            }
            if (!moved && scale == 0.51) {
                EXPECT_EQ(wanted, 1) << "no more than are";
            }
        }
}

}  // namespace
}  // namespace probewarp
