// Exporting's short cuts: drawing in parts, with the triangles that show there and the mipmaps that are
// wanted, gives what drawing all of it with everything gives.
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "exporting/export.h"
#include "raster/rasterizer.h"
#include "render/context.h"
#include "scene.h"

namespace probewarp {
namespace {

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

/// What the processor draws, by these triangles and with so many mipmaps.
Image drawn(const Scene& scene, const View& view, TriangleRun triangles, int levels) {
    Rasterizer rasterizer(scene.document.picture->image, levels);
    rasterizer.set_mesh(mesh_of(scene.deformation), scene.deformation.now, scene.deformation.moved);
    Image image = scene.blank(view);
    rasterizer.render(image, 0, 0, view, {}, triangles);
    return image;
}

TEST(Footprints, WhatIsNotWithinAPartDoesNotShowThere) {
    const auto context = open_context("osmesa");
    std::size_t within = 0, all = 0;
    for (const double angle : {0.0, 0.4, 1.5})
        for (const bool folded : {false, true}) {
            Document document = pulled(noise<std::uint8_t>(400, 300), angle);
            if (folded) document.probes[0].now.x += 250;  // later triangles lie over earlier ones
            const Scene scene(document);
            const View whole = scene.whole(0.97);
            for (int top = 0; top < whole.height; top += 64)
                for (int left = 0; left < whole.width; left += 150) {
                    View part = whole;
                    part.origin += glm::dvec2(left, top) / whole.scale;
                    part.width = 150, part.height = 64;
                    const TriangleRun some = TriangleBoxes(scene.deformation).within(part);
                    ASSERT_EQ(drawn(scene, part, some, 1).rgba,
                              drawn(scene, part, everything(scene.deformation), 1).rgba)
                        << left << ", " << top << ", " << angle;
                    within += some.count;
                    all += everything(scene.deformation).count;
                }
        }
    EXPECT_LT(within, all / 2) << "else nothing is saved";
}

TEST(Footprints, MoreLevelsThanWantedChangeNothing) {
    const auto context = open_context("osmesa");
    for (const double scale : {1.0, 0.99, 0.9, 0.51, 0.5, 0.49, 0.26, 0.24, 0.05})
        for (const bool moved : {true, false}) {
            Document document = pulled(noise<std::uint8_t>(400, 300), 0.3);
            if (!moved) document.probes.clear();
            Scene scene(document);
            const View view = scene.whole(scale);
            const int wanted = wanted_levels(scene.deformation, view);
            const TriangleRun triangles = everything(scene.deformation);
            EXPECT_EQ(drawn(scene, view, triangles, wanted).rgba, drawn(scene, view, triangles, 31).rgba)
                << scale;
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
