// Paint as PNG files: what comes back, what is shared, and what is refused.
#include "io/paint_file.h"

#include "generators.h"
#include "io/image_file.h"
#include "pictures.h"

namespace probewarp {
namespace {

using testing::error_of;
using testing::expect_always;
using testing::real;
using testing::same_paint;
using testing::whole;

constexpr glm::dvec2 extent{1, 0.75};

PaintMap map_of(int width, int height) { return empty_paint_map(width, height, extent); }

std::vector<std::byte> png_of(int width, int height, std::vector<std::uint8_t> rgba) {
    Image image;
    image.width = width;
    image.height = height;
    image.rgba = std::move(rgba);
    return find_image_format("png")->encode(image, {});
}

TEST(PaintFile, GivesThePaintBack) {
    expect_always("every texel, and no more tiles than there were", [] {
        PaintMap map = map_of(*whole(1, 200), *whole(1, 150));
        for (int rectangles = *whole(0, 4); rectangles > 0; --rectangles) {
            const int left = *whole(0, 199), top = *whole(0, 149);
            const auto value = std::uint16_t(*whole(0, 65535)), coverage = std::uint16_t(*whole(1, 65535));
            edit_texels(map, left, top, left + *whole(1, 100), top + *whole(1, 100),
                        [&](int x, int y, Paint) {
                            return Paint{from_stored(std::uint16_t(value ^ std::uint16_t(x))),
                                         from_stored(std::uint16_t(coverage ^ (std::uint16_t(y) << 8)))};
                        });
        }
        RC_ASSERT(same_paint(decode_paint(encode_paint(map), extent), map));
    });
}

TEST(PaintFile, TilesAllTheSameAreOne) {
    PaintMap map = map_of(64 * 3, 64 * 2 + 5);
    edit_texels(map, 0, 0, map.width, map.height, [](int x, int, Paint) {
        return Paint{x < 64 ? 0.5f : 1.0f, 1};
    });
    const PaintMap read = decode_paint(encode_paint(map), extent);
    EXPECT_TRUE(same_paint(read, map));
    EXPECT_EQ(read.tiles[0], read.tiles[3]);
    EXPECT_EQ(read.tiles[1], read.tiles[2]);
    EXPECT_NE(read.tiles[0], read.tiles[1]);
    EXPECT_NE(read.tiles[4], read.tiles[7]);  // the last row's are not full: beyond the edge they are 0
    // Two full tiles that stand in six places, and three at the edge.
    EXPECT_EQ(painted_texels(read), 5u * 64 * 64);
    EXPECT_EQ(painted_texels(map_of(200, 200)), 0u);
}

TEST(PaintFile, TakesNoMoreThanIsLeftOfTheBudget) {
    PaintMap map = map_of(128, 64);
    edit_texels(map, 0, 0, 128, 64, [](int, int, Paint) { return Paint{0.5f, 1}; });
    const std::vector<std::byte> png = encode_paint(map);
    constexpr std::size_t texels = 128 * 64, painted = 64 * 64;  // its two tiles are one
    PaintBudget budget;
    EXPECT_TRUE(same_paint(decode_paint(png, extent, budget), map));
    EXPECT_EQ(budget.texels, texels);
    EXPECT_EQ(budget.painted, painted);
    constexpr std::size_t most_texels = std::size_t{1} << 28, most_painted = std::size_t{1} << 27;
    const auto refusal = [&](std::size_t texels_before, std::size_t painted_before) {
        PaintBudget taken{texels_before, painted_before};
        return error_of([&] { decode_paint(png, extent, taken); });
    };
    EXPECT_EQ(refusal(most_texels - texels, most_painted - painted), "");
    EXPECT_EQ(refusal(most_texels - texels + 1, 0),
              "the paint takes 268 million texels; expected at most 268 million");
    EXPECT_EQ(refusal(0, most_painted - painted + 1),
              "the paint takes 134 million texels; expected at most 134 million");
}

TEST(PaintFile, GreyWithoutAlphaCoversEverything) {
    const std::vector<std::uint16_t> grey{0, 1, 256, 32767, 65534, 65535};
    const PaintMap map = decode_paint(encode_grey_png(3, 2, grey), extent);
    ASSERT_EQ(map.width, 3);
    ASSERT_EQ(map.height, 2);
    for (int i = 0; i < 6; ++i)
        EXPECT_EQ(texel(map, i % 3, i / 3), (Paint{from_stored(grey[std::size_t(i)]), 1}));
}

TEST(PaintFile, AGreyFileIsAPictureOf16Bits) {
    const std::vector<std::uint16_t> grey{0x1234, 0xfedc};
    const Image image = find_image_format("png")->decode(encode_grey_png(1, 2, grey), {});
    EXPECT_EQ(image.width, 1);
    EXPECT_EQ(image.height, 2);
    EXPECT_EQ(image.bits(), 16);
    EXPECT_EQ(pixel(image, 0, 0), (std::array{0x1234, 0x1234, 0x1234, 0xffff}));
    EXPECT_EQ(pixel(image, 0, 1), (std::array{0xfedc, 0xfedc, 0xfedc, 0xffff}));
}

TEST(PaintFile, ColoursCountWithTheirMean) {
    const PaintMap map =
        decode_paint(png_of(2, 2, {255, 0, 0, 255, 10, 20, 31, 51, 9, 9, 9, 255, 200, 1, 2, 0}), extent);
    EXPECT_EQ(texel(map, 0, 0), (Paint{from_stored(21845), 1}));  // 65535 / 3
    // 61 / 3 of 255 steps are 5225 2/3 of 65535, and a fifth of 255 is one of 65535.
    EXPECT_EQ(texel(map, 1, 0), (Paint{from_stored(5226), from_stored(13107)}));
    EXPECT_EQ(texel(map, 0, 1), (Paint{from_stored(9 * 257), 1}));
    EXPECT_EQ(texel(map, 1, 1), Paint{});  // where nothing is covered there is no value
    EXPECT_EQ(map.tiles[0]->value[65], 0);
}

TEST(PaintFile, ABlankMapHasNoTiles) {
    const PaintMap map = decode_paint(encode_paint(map_of(100, 100)), extent);
    EXPECT_EQ(map, map_of(100, 100));
    EXPECT_EQ(decode_paint(png_of(1, 1, {5, 5, 5, 0}), extent).tiles[0], nullptr);
}

TEST(PaintFile, TheSamePaintGivesTheSameBytes) {
    PaintMap map = map_of(70, 70);
    edit_texels(map, 3, 3, 69, 9, [](int x, int, Paint) { return Paint{float(x) / 70, 0.5f}; });
    EXPECT_EQ(encode_paint(map), encode_paint(map));
    EXPECT_EQ(encode_paint(decode_paint(encode_paint(map), extent)), encode_paint(map));
}

TEST(PaintFile, WhatIsBrokenIsRefused) {
    PaintMap map = map_of(70, 5);
    edit_texels(map, 0, 0, 70, 5, [](int x, int, Paint) { return Paint{float(x) / 70, 1}; });
    const auto whole_file = encode_paint(map);
    const std::size_t end_chunk = 12;  // without it all pixels are there
    for (std::size_t length = 0; length + end_chunk < whole_file.size(); ++length)
        EXPECT_NE(error_of([&] { decode_paint(std::span(whole_file).first(length), extent); }), "") << length;
    auto wrong = whole_file;
    wrong[0] = std::byte{'X'};
    EXPECT_NE(error_of([&] { decode_paint(wrong, extent); }), "");
}

}  // namespace
}  // namespace probewarp
