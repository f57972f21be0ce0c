// GIF: files without a palette, trailer or end code, frames beyond the canvas, and what describes the
// picture.
#include <gtest/gtest.h>

#include "image_checks.h"
#include "salvage.h"

namespace probewarp {
namespace {

using namespace testing;

constexpr Rgba black{0, 0, 0, 255}, red{255, 0, 0, 255}, green{0, 255, 0, 255}, blue{0, 0, 255, 255};
constexpr Rgba clear{0, 0, 0, 0};
const std::vector<Rgba> four{black, red, green, blue};

/// 2 x 2, with these bytes before the frame.
File four_pixels(const File& before = {}) {
    return make_gif(2, 2, 0, 0, 2, 2, false, before, lzw({0, 1, 2, 3}));
}

File cut(const File& file, std::ptrdiff_t bytes) { return {file.begin(), file.end() - bytes}; }

/// The same file without its palette, whose bytes follow the first thirteen.
File without_palette(File file) {
    file[10] = std::byte{0};
    file.erase(file.begin() + 13, file.begin() + 13 + 12);
    return file;
}

TEST(Gif, WithoutAPaletteIsGrey) {
    const File file = without_palette(make_gif(2, 2, 0, 0, 2, 2, false, {}, lzw({0, 1, 100, 255})));
    EXPECT_EQ(pixels(decode(file)),
              (std::vector<Rgba>{black, {1, 1, 1, 255}, {100, 100, 100, 255}, {255, 255, 255, 255}}));
    const File transparent = without_palette(
        make_gif(2, 1, 0, 0, 2, 1, false, bytes({0x21, 0xF9, 4, 1, 0, 0, 100, 0}), lzw({100, 101})));
    EXPECT_EQ(pixels(decode(transparent)), (std::vector<Rgba>{{100, 100, 100, 0}, {101, 101, 101, 255}}));
}

TEST(Gif, EndsWithTheLastPixelOfItsFirstFrame) {
    const File file =
        four_pixels();  // its end code is in one byte, before an empty sub-block and the trailer
    for (const int bytes : {1, 2, 3}) EXPECT_EQ(pixels(decode(cut(file, bytes))), four) << bytes;
    for (const File& behind : {bytes({0}), bytes({0x77, 0x88}), bytes({0x2C, 0, 0}), bytes({0x21, 0xFF})})
        EXPECT_EQ(pixels(decode(join({cut(file, 1), behind}))), four);
}

TEST(Gif, BytesBetweenBlocksArePassedOver) {
    EXPECT_EQ(pixels(decode(four_pixels(bytes({0, 0, 0x77})))), four);
    expect_refused(join({bytes_of("GIF89a"), le(2, 1), le(2, 1), File(500)}), "a.gif", "is truncated");
}

TEST(Gif, TheCanvasHoldsTheFrame) {
    const Image beyond = decode(make_gif(2, 2, 1, 1, 2, 2, false, {}, lzw({0, 1, 2, 3})));
    EXPECT_EQ(beyond.width, 3);
    EXPECT_EQ(pixels(beyond),
              (std::vector<Rgba>{clear, clear, clear, clear, black, red, clear, green, blue}));
    const Image none = decode(make_gif(0, 0, 0, 0, 2, 2, false, {}, lzw({0, 1, 2, 3})));
    EXPECT_EQ(none.width, 2);
    EXPECT_EQ(pixels(none), four);
    expect_refused(make_gif(1, 1, 40000, 0, 1, 1, false, {}, lzw({1})), "a.gif", "is 40001 x 1 pixels");
}

TEST(Gif, LiteralsOfMoreBitsThanBytesHave) {
    // 11 bits: 2048 is the clear code, and each code has 12 bits.
    const File data = bytes({0x00, 0x18, 0x00, 0x02, 0x10, 0x80});  // 2048, 1, 2, 2049
    File file = make_gif(2, 1, 0, 0, 2, 1, false, {}, data);
    file[file.size() - data.size() - 4] = std::byte{11};
    EXPECT_EQ(pixels(decode(file)), (std::vector<Rgba>{red, green}));
    for (const int length : {0, 12, 255}) {
        file[file.size() - data.size() - 4] = std::byte(length);
        expect_refused(file, "a.gif", "its codes have an impossible length");
    }
}

TEST(Gif, ProfileAndAspectAreRead) {
    const File profile(300, std::byte{5});
    const File icc = join({bytes({0x21, 0xFF, 11}), bytes_of("ICCRGBG1012"), sub_blocks(profile)});
    File file = four_pixels(icc);
    file[12] = std::byte(49 + 64);  // a pixel is twice as wide as high
    const Image image = decode(file);
    EXPECT_EQ(pixels(image), four);
    EXPECT_EQ(image.description.icc, profile);
    EXPECT_EQ(image.description.aspect, (Resolution{64, 128}));
    for (const int square : {0, 49}) {
        file[12] = std::byte(square);
        EXPECT_EQ(decode(file).description.aspect, std::nullopt);
    }
}

TEST(Gif, WhatIsThereIsSalvaged) {
    EXPECT_EQ(pixels(salvaged(cut(four_pixels(), 5))), (std::vector<Rgba>{black, red, clear, clear}));
    const auto two_by_two = [](const File& data) { return make_gif(2, 2, 0, 0, 2, 2, false, {}, data); };
    EXPECT_EQ(pixels(salvaged(two_by_two(lzw({2, 1, 3})))), (std::vector<Rgba>{green, red, blue, clear}))
        << "an end code too soon";
    EXPECT_EQ(pixels(salvaged(two_by_two(lzw({1, 2, 300, 1})))),
              (std::vector<Rgba>{red, green, clear, clear}))
        << "a code that makes no sense";
    // Half of an interlaced frame: its rows 0 and 8 of 9.
    EXPECT_EQ(pixels(salvaged(make_gif(1, 9, 0, 0, 1, 9, true, {}, lzw({1, 2})))),
              (std::vector<Rgba>{red, clear, clear, clear, clear, clear, clear, clear, green}));
    expect_nothing_to_salvage(cut(four_pixels(), 9));
}

}  // namespace
}  // namespace probewarp
