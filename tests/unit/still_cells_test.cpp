// What the mesh leaves out although it can be seen: found where a threshold leaves it out, and nowhere else.
#include "model/still_cells.h"

#include <gtest/gtest.h>

#include "model/binding.h"
#include "pictures.h"

namespace probewarp {
namespace {

/// 8 x 4 pixels, clear but for those given as x, y, alpha.
template <class Sample = std::uint8_t>
Image clear_but_for(std::initializer_list<std::array<int, 3>> pixels) {
    Image image;
    image.width = 8;
    image.height = 4;
    std::vector<Sample> rgba(8 * 4 * 4);
    for (const auto& [x, y, alpha] : pixels) rgba[std::size_t(y * 8 + x) * 4 + 3] = Sample(alpha);
    image.rgba = std::move(rgba);
    return image;
}

/// left, top, right, bottom of each rectangle
std::vector<std::array<float, 4>> rectangles(const Image& image, const MeshSettings& settings) {
    const StillCells still = still_cells(image, settings, visible_cells(image, settings));
    EXPECT_EQ(still.triangles.size() * 4, still.corners.size() * 6);
    std::vector<std::array<float, 4>> all;
    for (std::size_t i = 0; i < still.corners.size(); i += 4)
        all.push_back(
            {still.corners[i].x, still.corners[i].y, still.corners[i + 3].x, still.corners[i + 3].y});
    return all;
}

using Rectangles = std::vector<std::array<float, 4>>;

TEST(StillCells, AreNoneWhereTheMeshCoversWhatIsSeen) {
    const Image image = clear_but_for({{0, 0, 200}, {6, 2, 1}});
    EXPECT_EQ(rectangles(image, {4, true, 0, 0}), Rectangles());
    EXPECT_EQ(rectangles(image, {4, false, 100, 0}), Rectangles());
    EXPECT_EQ(rectangles(image, {4, true, 100, 8}), Rectangles());  // the margin covers it
}

TEST(StillCells, AreThoseOfFaintPixelsAndOfTheirFiltering) {
    // Cells of 2 x 2 pixels. Pixel 6, 2 lies at the corner of its cell, so that it shows in those beside it
    // where the picture is enlarged.
    const Image image = clear_but_for({{0, 0, 200}, {6, 2, 100}});
    EXPECT_EQ(rectangles(image, {4, true, 100, 0}), (Rectangles{{4, 0, 8, 2}, {4, 2, 8, 4}}));
    EXPECT_EQ(rectangles(image, {4, true, 99, 0}), Rectangles());
}

TEST(StillCells, AreAlsoOfSixteenBits) {
    const Image image = clear_but_for<std::uint16_t>({{0, 0, 60000}, {7, 3, 1}});
    EXPECT_EQ(rectangles(image, {4, true, 1, 0}), (Rectangles{{6, 2, 8, 4}}));
    EXPECT_EQ(rectangles(image, {4, true, 0, 0}), Rectangles());
}

TEST(StillCells, NeverOverlapTheMesh) {
    const Image image = clear_but_for({{1, 1, 200}, {3, 1, 20}, {2, 3, 20}});
    const MeshSettings settings{4, true, 50, 0};
    const auto kept = visible_cells(image, settings);
    for (const auto& [left, top, right, bottom] : rectangles(image, settings))
        for (float x = left + 1; x < right; x += 2)
            EXPECT_FALSE(kept[std::size_t(top / 2) * 4 + std::size_t(x / 2)]) << x << " " << top;
    EXPECT_EQ(rectangles(image, settings), (Rectangles{{2, 0, 6, 2}, {0, 2, 6, 4}}));
}

TEST(StillCells, FollowThePictureThatABindingIsCarriedTo) {
    const auto document_of = [](int faint) {
        Picture picture;
        picture.image = clear_but_for({{1, 1, 200}, {6, 3, faint}});
        Document document;
        document.picture = std::make_shared<const Picture>(std::move(picture));
        document.mesh = {4, true, 50, 0};
        return document;
    };
    const auto binding = make_binding(document_of(20), nullptr);
    EXPECT_FALSE(binding->still.triangles.empty());
    const auto carried = carried_over(binding, document_of(0));
    ASSERT_TRUE(carried);
    EXPECT_TRUE(carried->still.triangles.empty());
    EXPECT_EQ(carried_over(carried, document_of(20))->still.triangles, binding->still.triangles);
}

}  // namespace
}  // namespace probewarp
