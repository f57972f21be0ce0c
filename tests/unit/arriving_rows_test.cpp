// Pictures that are handed over while their rows are still being decoded.
#include <algorithm>
#include <random>
#include <span>

#include "image_checks.h"
#include "io/file.h"
#include "io/project.h"
#include "model/document.h"
#include "pictures.h"
#include "temporary_folder.h"

namespace probewarp {
namespace {

using namespace testing;
using ::testing::HasSubstr;

/// Noise of several portions of rows, the last of them not whole. alpha: of its first pixel
Image noise(int width, int height, std::uint8_t alpha = 255) {
    Image image;
    image.width = width;
    image.height = height;
    std::mt19937 random(5);
    std::vector<std::uint8_t> rgba(std::size_t(width) * std::size_t(height) * 4);
    for (std::size_t i = 0; i < rgba.size(); ++i) rgba[i] = i % 4 == 3 ? 255 : std::uint8_t(random());
    rgba[3] = alpha;
    image.rgba = std::move(rgba);
    return image;
}

std::span<const std::byte> first_rows(const Image& image, int rows) {
    return pixel_bytes(image).first(std::size_t(rows) * std::size_t(image.width) * 4);
}

TEST(ArrivingRows, AreThereOnceTheyHaveBeenWaitedFor) {
    for (const char* format : {"png", "jpeg"}) {
        const File file = encode(noise(70, 500), format);
        const Image whole = decode(file);
        const Picture picture = decode_picture(file, "x", Pixels::arriving);
        ASSERT_TRUE(picture.arriving) << format;
        EXPECT_TRUE(picture.image.opaque);
        EXPECT_EQ(picture.image.height, 500);
        for (const int rows : {0, 1, 33, 250, 499, 500}) {
            wait_for_rows(picture, rows);
            EXPECT_TRUE(std::ranges::equal(first_rows(picture.image, rows), first_rows(whole, rows))) << rows;
        }
        EXPECT_GT(picture.arriving->times().decoding, 0) << format;
    }
}

TEST(ArrivingRows, AreOfOpaquePicturesOnly) {
    // Whether any of it is clear decides over the mesh, before anything is drawn.
    const Picture picture = decode_picture(encode(noise(70, 100, 254), "png"), "x", Pixels::arriving);
    EXPECT_FALSE(picture.arriving);
    EXPECT_FALSE(picture.image.opaque);
    EXPECT_EQ(picture.image.rgba, noise(70, 100, 254).rgba);
}

TEST(ArrivingRows, OfATurnedPictureAreTurned) {
    const File file = encode(noise(70, 90), "jpeg", {.quality = 100});
    const Image stored = decode(file);
    for (int orientation = 2; orientation <= 8; ++orientation) {
        const Image upright = decode(with_marker(file, exif_marker(orientation)));
        ASSERT_EQ(upright.width, orientation >= 5 ? 90 : 70);
        ASSERT_EQ(upright.height, orientation >= 5 ? 70 : 90);
        const bool mirrored_x = orientation == 2 || orientation == 3 || orientation == 7 || orientation == 8;
        const bool mirrored_y = orientation == 3 || orientation == 4 || orientation == 6 || orientation == 7;
        bool same = true;
        for (int y = 0; y < 90; ++y)
            for (int x = 0; x < 70; ++x) {
                const int u = mirrored_x ? 69 - x : x, v = mirrored_y ? 89 - y : y;
                same &=
                    pixel(stored, x, y) == (orientation >= 5 ? pixel(upright, v, u) : pixel(upright, u, v));
            }
        EXPECT_TRUE(same) << orientation;
    }
}

TEST(ArrivingRows, ThatNeverComeSayWhy) {
    File file = encode(noise(70, 500), "jpeg");
    file.resize(file.size() / 2);
    const Picture picture = decode_picture(file, "half.jpg", Pixels::arriving);
    wait_for_rows(picture, 100);
    for (const int rows : {500, 400})  // as often as one asks
        EXPECT_THAT(error_of([&] { wait_for_rows(picture, rows); }),
                    HasSubstr("half.jpg: is truncated; expected a whole JPEG file"));
}

TEST(ArrivingRows, OfAProjectSayWhyWithItsName) {
    Document document;
    Picture whole = decode_picture(encode(noise(70, 500), "jpeg"), "a.jpg");
    whole.original.resize(whole.original.size() / 2);
    document.picture = std::make_shared<const Picture>(std::move(whole));
    const Document opened = decode_project(encode_project(document), "b.probewarp", Pixels::arriving);
    EXPECT_EQ(opened.picture->name, "a.jpg");
    const std::string error = error_of([&] { wait_for_rows(*opened.picture, 500); });
    EXPECT_THAT(error, ::testing::StartsWith("b.probewarp: image"));
    EXPECT_EQ(error_of([&] { decode_project(encode_project(document), "b.probewarp"); }), error);
}

TEST(ArrivingRows, EndWithThePicture) {
    // The thread that brings them writes into its pixels.
    const File file = encode(noise(70, 3000), "png");
    for (int i = 0; i < 20; ++i) decode_picture(file, "x", Pixels::arriving);
}

}  // namespace
}  // namespace probewarp
