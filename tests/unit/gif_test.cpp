// GIF: frames, codes, files without a palette, trailer or end code, frames beyond the canvas, and what
// describes the picture.
#include <gtest/gtest.h>

#include <random>

#include "image_checks.h"
#include "io/lzw.h"
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

const File transparent_red = bytes({0x21, 0xF9, 4, 1, 0, 0, 1, 0});

TEST(Gif, FirstFrameOnItsCanvas) {
    const File file = make_gif(3, 2, 1, 0, 2, 2, false, {}, lzw({1, 2, 3, 0}));
    EXPECT_EQ(pixels(decode(file)), (std::vector<Rgba>{clear, red, green, clear, blue, black}));
    const File transparent = make_gif(2, 1, 0, 0, 2, 1, false, transparent_red, lzw({1, 2}));
    EXPECT_EQ(pixels(decode(transparent)), (std::vector<Rgba>{{255, 0, 0, 0}, green}));
    const File beyond = make_gif(2, 1, 0, 0, 2, 1, false, {}, lzw({200, 3}));
    EXPECT_EQ(pixels(decode(beyond)), (std::vector<Rgba>{clear, blue})) << "no such colour";
}

TEST(Gif, InterlacedRows) {
    // Nine rows: 0 8, 4, 2 6, 1 3 5 7.
    const Image image = decode(make_gif(1, 9, 0, 0, 1, 9, true, {}, lzw({0, 1, 2, 3, 3, 1, 1, 1, 1})));
    EXPECT_EQ(pixels(image), (std::vector<Rgba>{black, red, blue, red, green, red, blue, red, red}));
}

TEST(Gif, CodesOfEveryLength) {
    std::mt19937 random(1);
    std::vector<int> indices;
    std::vector<Rgba> meaning;
    for (int i = 0; i < 200 * 300; ++i) {  // fills the table twice over
        indices.push_back(int(random() % 4));
        meaning.push_back(std::array{black, red, green, blue}[std::size_t(indices.back())]);
    }
    EXPECT_EQ(pixels(decode(make_gif(200, 300, 0, 0, 200, 300, false, {}, lzw_compressed(indices)))),
              meaning);
}

TEST(Gif, LongStrings) {
    // Red, then each time the code that is just about to be defined: strings of 1, 2, 3 ... 100 pixels. 9
    // bits a code all along, for the table stays below 512.
    std::vector<int> codes{1};
    for (int code = 258; code < 357; ++code) codes.push_back(code);
    const Image image = decode(make_gif(101, 50, 0, 0, 101, 50, false, {}, lzw(codes)));
    EXPECT_EQ(pixels(image), std::vector<Rgba>(5050, red));
}

TEST(Gif, BadOnesAreRefused) {
    const auto gif = [](const File& data, int frame = 2) {
        return make_gif(2, 2, 0, 0, frame, 2, false, {}, data);
    };
    expect_refused(gif(lzw({1, 2, 3})), "a.gif", "pixels are missing");
    expect_refused(gif(lzw({1, 300, 1, 1})), "a.gif", "its codes make no sense");
    expect_refused(gif(lzw({258, 1, 1, 1})), "a.gif", "its codes make no sense");
    expect_refused(gif(lzw({1, 1, 1, 1}), 3), "a.gif", "pixels are missing");
    expect_refused(gif(lzw({1, 1, 1, 1}), 0), "a.gif", "its first frame is empty");
    expect_refused(make_gif(60000, 2, 0, 0, 1, 1, false, {}, lzw({1})), "a.gif", "is 60000 x 2 pixels");
    expect_refused(join({bytes_of("GIF89a"), le(2, 1), le(2, 1), bytes({0, 0, 0, 0x3B})}), "a.gif",
                   "no picture in it");
    expect_refused(make_gif(9000, 9000, 0, 0, 9000, 9000, false, {}, lzw({1})), "a.gif",
                   "pixels are missing");
}

/// An LZW stream that fills the table with strings of up to 3838 pixels, then names the longest a million
/// times: 4 thousand million pixels.
File endless_strings() {
    File data;
    std::uint64_t bits = 0;
    int count = 0, width = 9;
    const auto put = [&](unsigned code) {
        bits |= std::uint64_t(code) << count;
        for (count += width; count >= 8; count -= 8, bits >>= 8) data.push_back(std::byte(bits & 255));
    };
    put(256), put(1);
    for (unsigned next = 258; next < 4096; ++next) {
        put(next);
        if (next + 1 == 1u << width && width < 12) ++width;
    }
    for (int i = 0; i < 1'000'000; ++i) put(4095);
    return data;
}

TEST(Gif, StringsBeyondTheFrameCostNothing) {
    // stb_image would take all strings, however few pixels the frame has.
    const File data = endless_strings();
    EXPECT_EQ(pixels(decode(make_gif(2, 2, 0, 0, 2, 2, false, {}, data))), std::vector<Rgba>(4, red));
    EXPECT_EQ(pixels(decode(make_gif(2000, 3000, 0, 0, 2000, 3000, false, {}, data))).size(), 6'000'000u);
    // The work is that of the codes that are taken: each is of nine bits or more and gives a pixel or more.
    for (const auto& [count, most_bytes] : {std::pair{4u, 8}, {100u, 32}, {6'000'000u, 6'000}}) {
        std::vector<std::uint8_t> out(count);
        int taken = 0;
        const auto next_byte = [&] { return int(data[std::size_t(taken++)]); };
        EXPECT_EQ(decode_lzw(next_byte, 8, out), std::ptrdiff_t(count));
        EXPECT_LE(taken, most_bytes) << "bytes of codes for " << count << " pixels";
    }
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

TEST(Gif, TheFirstProfileCounts) {
    const auto icc = [](const File& profile) {
        return join({bytes({0x21, 0xFF, 11}), bytes_of("ICCRGBG1012"), sub_blocks(profile)});
    };
    const File first(300, std::byte{5}), second(200, std::byte{6});
    const Image image = decode(four_pixels(join({icc(first), icc(second), transparent_red, icc(second)})));
    EXPECT_EQ(image.description.icc, first);
    EXPECT_EQ(pixels(image), (std::vector<Rgba>{black, {255, 0, 0, 0}, green, blue}));
    const Description none = decode(four_pixels(join({icc({}), icc(second)}))).description;
    EXPECT_EQ(none.icc, File{}) << "be it of no use";
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
