// A binding is carried over to another picture exactly where working it out anew would give the same.
#include "model/binding.h"

#include <gtest/gtest.h>

#include "model/deformation.h"

namespace probewarp {
namespace {

PicturePtr grey_picture(int width, int height, std::uint8_t shade) {
    Picture picture;
    picture.image.width = width;
    picture.image.height = height;
    std::vector<std::uint8_t> rgba(std::size_t(width * height * 4), shade);
    for (std::size_t i = 3; i < rgba.size(); i += 4) rgba[i] = 255;
    picture.image.rgba = std::move(rgba);
    return std::make_shared<const Picture>(std::move(picture));
}

Document posed(PicturePtr picture) {
    Document document;
    document.picture = std::move(picture);
    document.mesh.cells = 12;
    document.probes = {new_probe(document, {20, 20})};
    document.probes.push_back(new_probe(document, {60, 30}));
    return document;
}

PicturePtr half_transparent(int width, int height) {
    Picture picture = *grey_picture(width, height, 9);
    auto& rgba = std::get<0>(picture.image.rgba);
    std::fill(rgba.begin() + std::ptrdiff_t(rgba.size() / 2), rgba.end(), std::uint8_t(0));
    return std::make_shared<const Picture>(std::move(picture));
}

TEST(Binding, IsCarriedOverToAnotherPictureOfTheSameSize) {
    const Document first = posed(grey_picture(80, 50, 7)), second = posed(grey_picture(80, 50, 99));
    const auto binding = make_binding(first, nullptr);
    const auto carried = carried_over(binding, second), anew = make_binding(second, nullptr);
    ASSERT_NE(carried, nullptr);
    EXPECT_TRUE(is_bound(carried.get(), second));
    EXPECT_EQ(carried->mesh, binding->mesh) << "shared, not made again";
    EXPECT_EQ(carried->mesh->rest, anew->mesh->rest);
    EXPECT_EQ(carried->mesh->triangles, anew->mesh->triangles);
    EXPECT_EQ(carried->automatic, anew->automatic);
    EXPECT_EQ(carried->kept, anew->kept);
}

TEST(Binding, IsNotCarriedOverWhereItWouldDiffer) {
    const auto binding = make_binding(posed(grey_picture(80, 50, 7)), nullptr);
    EXPECT_EQ(carried_over(nullptr, posed(grey_picture(80, 50, 7))), nullptr);
    EXPECT_EQ(carried_over(binding, posed(grey_picture(81, 50, 7))), nullptr);
    EXPECT_EQ(carried_over(binding, posed(grey_picture(80, 51, 7))), nullptr);
    EXPECT_EQ(carried_over(binding, posed(half_transparent(80, 50))), nullptr) << "other cells";
    Document other = posed(grey_picture(80, 50, 7));
    other.probes[0].rest.x += 1;
    EXPECT_EQ(carried_over(binding, other), nullptr);
    other = posed(grey_picture(80, 50, 7));
    other.weights.scheme = "gaussian";
    EXPECT_EQ(carried_over(binding, other), nullptr);
    other = posed(grey_picture(80, 50, 7));
    other.mesh.cells = 13;
    EXPECT_EQ(carried_over(binding, other), nullptr);
}

}  // namespace
}  // namespace probewarp
