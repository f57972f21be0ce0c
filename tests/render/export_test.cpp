// The driver's drawing in parts gives what drawing all of it gives.
#include <gtest/gtest.h>

#include <cmath>

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
        scene.renderer.draw(view, 1);
        scene.renderer.read_back(whole, 0, 0, view, 1, {});
        const Image tiled = scene.by_driver(view);
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

}  // namespace
}  // namespace probewarp
