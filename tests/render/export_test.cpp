// The driver's drawing in parts gives what drawing all of it gives; an export says where it lies.
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

using Offset = std::optional<std::array<std::int32_t, 2>>;

/// What is written about an export's place, where the picture itself lies at `original`.
Offset offset_of(const View& view, Offset original) {
    Document document;
    Picture picture = *noise<std::uint8_t>(6, 4);
    picture.image.description.offset = original;
    document.picture = std::make_shared<const Picture>(std::move(picture));
    Deformation deformation;
    update(deformation, document);
    Rasterizer drawer(deformation, view, {});
    return ExportJob(drawer, deformation, view, {}).like().description.offset;
}

TEST(Offset, IsThatOfTheCanvasOnThePicture) {
    EXPECT_EQ(offset_of({{0, 0}, {1, 1}, 6, 4}, {}), Offset());
    EXPECT_EQ(offset_of({{-3, 5}, {1, 1}, 6, 4}, {}), (Offset{{-3, 5}}));
    EXPECT_EQ(offset_of({{-3, 5}, {2, 0.5}, 6, 4}, {}), (Offset{{-6, 3}}));  // exported pixels
    EXPECT_EQ(offset_of({{0.2, -0.2}, {1, 1}, 6, 4}, {}), Offset());
}

TEST(Offset, AddsToThatOfTheOriginal) {
    EXPECT_EQ(offset_of({{0, 0}, {1, 1}, 6, 4}, {{10, -20}}), (Offset{{10, -20}}));
    EXPECT_EQ(offset_of({{-3, 5}, {2, 2}, 6, 4}, {{10, -20}}), (Offset{{14, -30}}));
    EXPECT_EQ(offset_of({{-10, 20}, {2, 2}, 6, 4}, {{10, -20}}), (Offset{{0, 0}}));
    EXPECT_EQ(offset_of({{0, 0}, {1, 1}, 6, 4}, {{0, 0}}), (Offset{{0, 0}}));
}

TEST(Offset, IsLeftOutWhereNoFileCanSayIt) {
    EXPECT_EQ(offset_of({{0, 0}, {2, 2}, 6, 4}, {{2147483647, 0}}), Offset());
    EXPECT_EQ(offset_of({{0, 0}, {1, 1}, 6, 4}, {{2147483647, -2147483647}}),
              (Offset{{2147483647, -2147483647}}));
    EXPECT_EQ(offset_of({{1e300, 0}, {1, 1}, 6, 4}, {}), Offset());
}

}  // namespace
}  // namespace probewarp
