// BMP of every version: headers, palettes, masks, run lengths, colours; and what is written.
#include <gtest/gtest.h>

#include "image_checks.h"
#include "salvage.h"

namespace probewarp {
namespace {

using namespace testing;

constexpr Rgba black{0, 0, 0, 255}, red{255, 0, 0, 255}, green{0, 255, 0, 255}, blue{0, 0, 255, 255};
constexpr Rgba clear{0, 0, 0, 0};

const File palette = bytes({255, 0, 0, 0, 0, 0, 255, 0, 0, 255, 0, 0});  // blue, red, green

struct Bmp {
    int header = 40;  // bytes, 16 or more
    int width = 1, height = 1, bits = 24, compression = 0, colours = 0;
    std::vector<std::pair<int, std::uint32_t>> fields{};  // more of the header: where, and what
    File between{};                                       // masks or a palette
    File pixels{};
    int offset = -1;  // of the pixels; -1: where they are
};

File make(const Bmp& bmp) {
    File info = join({le(4, std::uint64_t(bmp.header)), le(4, std::uint32_t(bmp.width)),
                      le(4, std::uint32_t(bmp.height)), le(2, 1), le(2, std::uint64_t(bmp.bits)),
                      le(4, std::uint64_t(bmp.compression)), File(12), le(4, std::uint64_t(bmp.colours))});
    info.resize(std::size_t(bmp.header));
    for (const auto& [at, value] : bmp.fields) std::copy_n(le(4, value).begin(), 4, info.begin() + at);
    const std::size_t start = 14 + info.size() + bmp.between.size();
    const std::size_t offset = bmp.offset < 0 ? start : std::size_t(bmp.offset);
    return join({bytes_of("BM"), le(4, start + bmp.pixels.size()), le(4, 0), le(4, offset), info, bmp.between,
                 bmp.pixels});
}

File masks(std::uint32_t r, std::uint32_t g, std::uint32_t b) { return join({le(4, r), le(4, g), le(4, b)}); }

// ---- kinds ----

const File red_green_blue = bytes({0, 0, 255, 0, 0, 255, 0, 0, 255, 0, 0, 0});  // a palette

TEST(Bmp, PalettesOfEveryDepth) {
    const std::vector<Rgba> meaning{red, green, blue, red, blue, green, green, green, red};
    // Rows from the bottom up, four bytes each.
    EXPECT_EQ(
        pixels(decode(make_bmp(9, 1, 8, 0, red_green_blue, bytes({0, 1, 2, 0, 2, 1, 1, 1, 0, 0, 0, 0})))),
        meaning);
    EXPECT_EQ(
        pixels(decode(make_bmp(9, 1, 4, 0, red_green_blue, bytes({0x01, 0x20, 0x21, 0x11, 0x00, 0, 0, 0})))),
        meaning);
    const File two = bytes({0, 0, 255, 0, 0, 255, 0, 0});
    EXPECT_EQ(pixels(decode(make_bmp(3, 2, 1, 0, two, bytes({0b010'00000, 0, 0, 0, 0b110'00000, 0, 0, 0})))),
              (std::vector<Rgba>{green, green, red, red, green, red}));
    // The oldest header, three bytes a colour.
    const File core = bytes({0, 0, 255, 0, 255, 0, 255, 0, 0});
    EXPECT_EQ(pixels(decode(make_bmp(3, 1, 8, 0, core, bytes({2, 1, 0, 0}), true))),
              (std::vector<Rgba>{blue, green, red}));
    // Colours that the palette does not have are black, not what memory held before.
    EXPECT_EQ(pixels(decode(make_bmp(2, 1, 8, 0, red_green_blue, bytes({255, 3, 0, 0})))),
              (std::vector<Rgba>{black, black}));
}

TEST(Bmp, TrueColourAndMasks) {
    const Image image = decode(make_bmp(1, -2, 24, 0, {}, bytes({0, 0, 255, 0, 255, 0, 0, 0})));
    EXPECT_EQ(pixels(image), (std::vector<Rgba>{red, blue})) << "negative height: from the top down";
    EXPECT_EQ(image.description.resolution, (Resolution{2000, 3000}));
    EXPECT_EQ(pixels(decode(make_bmp(2, 1, 16, 0, {}, bytes({0x00, 0x7C, 0xE0, 0x03})))),
              (std::vector<Rgba>{red, green}));
    const File masks565 = join({le(4, 0xF800), le(4, 0x07E0), le(4, 0x001F)});
    EXPECT_EQ(pixels(decode(make_bmp(2, 1, 16, 3, masks565, bytes({0x00, 0xF8, 0x1F, 0x00})))),
              (std::vector<Rgba>{red, blue}));
    const File masks4444 = join({le(4, 0x0F00), le(4, 0x00F0), le(4, 0x000F), le(4, 0xF000)});
    EXPECT_EQ(pixels(decode(make_bmp(2, 1, 16, 6, masks4444, bytes({0x12, 0x80, 0xFF, 0x0F})))),
              (std::vector<Rgba>{{0, 17, 34, 136}, {255, 255, 255, 0}}));
    // 32 bits without masks: the fourth byte means nothing.
    EXPECT_EQ(pixels(decode(make_bmp(2, 1, 32, 0, {}, bytes({1, 2, 3, 0, 4, 5, 6, 9})))),
              (std::vector<Rgba>{{3, 2, 1, 255}, {6, 5, 4, 255}}));
    EXPECT_EQ(pixels(decode(make_bmp(2, 1, 32, 0, {}, bytes({1, 2, 3, 0, 4, 5, 6, 0})))),
              (std::vector<Rgba>{{3, 2, 1, 255}, {6, 5, 4, 255}}));
}

TEST(Bmp, BadOnesAreRefused) {
    const File row = bytes({0, 0, 0, 0});
    expect_refused(make_bmp(1, 1, 7, 0, {}, row), "a.bmp", "is damaged (it has 7 bits a pixel)");
    expect_refused(make_bmp(1, 1, 8, 0, bytes({0}), row), "a.bmp", "it has no palette");
    expect_refused(make_bmp(1, 1, 4, 1, red_green_blue, row), "a.bmp", "does not go with 4 bits a pixel");
    expect_refused(make_bmp(40000, 1, 24, 0, {}, row), "a.bmp", "is 40000 x 1 pixels");
    expect_refused(make_bmp(-1, 1, 24, 0, {}, row), "a.bmp", "is -1 x 1 pixels");
    expect_refused(make_bmp(1, std::numeric_limits<int>::min(), 24, 0, {}, row), "a.bmp",
                   "is 1 x 2147483648 pixels");
    expect_refused(make_bmp(9000, 9000, 24, 0, {}, row), "a.bmp", "is truncated");
    const File scattered = join({le(4, 0xF00F), le(4, 0x07E0), le(4, 0x001F)});
    expect_refused(make_bmp(1, 1, 16, 3, scattered, bytes({0xFF, 0xFF, 0, 0})), "a.bmp",
                   "do not stand together");
}

// ---- headers and palettes ----

TEST(Bmp, HeadersOfEveryLength) {
    for (const int header : {16, 20, 24, 28, 32, 36, 40, 42, 44, 46, 48, 52, 56, 60, 64, 108, 124})
        EXPECT_EQ(pixels(decode(make({.header = header, .pixels = bytes({0, 0, 255, 0})}))),
                  (std::vector<Rgba>{red}))
            << header;
    // OS/2's may end before it says how many colours there are.
    for (const int header : {16, 36, 64})
        EXPECT_EQ(pixels(decode(make({.header = header,
                                      .width = 2,
                                      .bits = 8,
                                      .between = palette,
                                      .pixels = bytes({2, 1, 0, 0})}))),
                  (std::vector<Rgba>{green, red}));
    for (const int header : {13, 15, 65, 66, 107, 109, 125})
        expect_refused(make({.header = std::max(header, 24), .fields = {{0, std::uint32_t(header)}}}),
                       "a.bmp", "its header has an unknown length");
}

TEST(Bmp, TwoBitsAPixel) {
    EXPECT_EQ(pixels(decode(make({.width = 5,
                                  .bits = 2,
                                  .between = palette,
                                  .pixels = bytes({0b00'01'10'01, 0b11'000000, 0, 0})}))),
              (std::vector<Rgba>{blue, red, green, red, black}));
}

TEST(Bmp, PalettesLongerAndShorterThanTheirDepth) {
    const File long_palette = join({palette, File(297 * 4)});
    EXPECT_EQ(pixels(decode(make({.width = 2,
                                  .bits = 8,
                                  .colours = 300,
                                  .between = long_palette,
                                  .pixels = bytes({1, 255, 0, 0})}))),
              (std::vector<Rgba>{red, black}));
    // More are announced than there is room for.
    EXPECT_EQ(pixels(decode(make({.width = 2,
                                  .bits = 8,
                                  .colours = 0x7FFFFFFF,
                                  .between = palette,
                                  .pixels = bytes({1, 3, 0, 0})}))),
              (std::vector<Rgba>{red, black}));
}

TEST(Bmp, PixelsFollowThePaletteWhereTheirOffsetForgetsIt) {
    for (const int offset : {0, 54})
        EXPECT_EQ(pixels(decode(make({.width = 2,
                                      .bits = 8,
                                      .colours = 3,
                                      .between = palette,
                                      .pixels = bytes({1, 2, 0, 0}),
                                      .offset = offset}))),
                  (std::vector<Rgba>{red, green}));
    EXPECT_EQ(pixels(decode(make({.bits = 16,
                                  .compression = 3,
                                  .between = masks(0xF800, 0x7E0, 0x1F),
                                  .pixels = bytes({0, 0xF8, 0, 0}),
                                  .offset = 0}))),
              (std::vector<Rgba>{red}));
    // Above 8 bits a palette is a hint, which is counted here and not there.
    for (const int bits : {24, 32}) {
        const File pixel = bytes({0, 0, 255, 0});
        for (const int colours : {1, 256})
            for (const File& behind : {File{}, File(2000)})
                EXPECT_EQ(
                    pixels(decode(make({.bits = bits, .colours = colours, .pixels = join({pixel, behind})}))),
                    (std::vector<Rgba>{red}));
        EXPECT_EQ(pixels(decode(
                      make({.bits = bits, .colours = 3, .between = palette, .pixels = pixel, .offset = 0}))),
                  (std::vector<Rgba>{red}))
            << "no offset, and the hint there";
    }
    EXPECT_EQ(pixels(decode(make({.bits = 16,
                                  .compression = 3,
                                  .colours = 256,
                                  .between = masks(0xF800, 0x7E0, 0x1F),
                                  .pixels = bytes({0, 0xF8, 0, 0}),
                                  .offset = 54}))),
              (std::vector<Rgba>{red}))
        << "masks are no hint";
    const File gap = join({File(7), bytes({0, 0, 255, 0})});
    EXPECT_EQ(pixels(decode(make({.pixels = gap, .offset = 54 + 7}))), (std::vector<Rgba>{red}));
    expect_refused(make({.pixels = bytes({1, 2, 3, 0}), .offset = 40}), "a.bmp",
                   "its pixels start inside its header");
    expect_refused(make({.pixels = bytes({1, 2, 3, 0}), .offset = 1000}), "a.bmp", "is truncated");
}

TEST(Bmp, FirstBitmapOfAnOs2Array) {
    const File bmp = make({.pixels = bytes({0, 0, 255, 0}), .offset = 14 + 54});
    const File array = join({bytes_of("BA"), le(4, 40), le(4, 0), le(4, 0), bmp});
    EXPECT_EQ(pixels(decode(array)), (std::vector<Rgba>{red}));
    expect_each_cut_refused(array, "a.bmp");
}

// ---- masks ----

TEST(Bmp, MasksOfAnyWidth) {
    const File ten = make({.width = 2,
                           .bits = 32,
                           .compression = 3,
                           .between = masks(0x3FF, 0xFFC00, 0x3FF00000),
                           .pixels = join({le(4, 1023 | 512 << 10 | 1 << 20), le(4, 0xC0000000)})});
    const Image image = decode(ten);
    EXPECT_EQ(image.bits(), 16) << "ten bits are more than eight hold";
    EXPECT_EQ(pixels(image), (std::vector<Rgba>{{65535, 32800, 64, 65535}, {0, 0, 0, 65535}}));
    EXPECT_EQ(pixels(decode(make({.bits = 32,
                                  .compression = 3,
                                  .between = masks(0xFFFFFFFF, 0, 0),
                                  .pixels = le(4, 0x80000000)}))),
              (std::vector<Rgba>{{32768, 0, 0, 65535}}));
    EXPECT_EQ(pixels(decode(make({.bits = 16,
                                  .compression = 3,
                                  .between = masks(0x3, 0x1C, 0x20),
                                  .pixels = join({le(2, 2 | 3 << 2 | 1 << 5), le(2, 0)})}))),
              (std::vector<Rgba>{{170, 109, 255, 255}}));
    EXPECT_EQ(
        pixels(decode(make(
            {.compression = 3, .between = masks(0xFF, 0xFF00, 0xFF0000), .pixels = bytes({1, 2, 3, 0})}))),
        (std::vector<Rgba>{{1, 2, 3, 255}}));
    expect_refused(make({.bits = 32, .compression = 3, .between = masks(0, 0, 0), .pixels = File(4)}),
                   "a.bmp", "no bits are given to its colours");
}

TEST(Bmp, AlphaOnlyWhereAMaskGivesItBits) {
    const auto one = [](int header, int compression, File between) {
        Bmp bmp{.header = header,
                .bits = 32,
                .compression = compression,
                .fields = {{40, 0xFF0000}, {44, 0xFF00}, {48, 0xFF}, {52, 0xFF000000}},
                .between = std::move(between),
                .pixels = bytes({1, 2, 3, 4})};
        bmp.fields.resize(header >= 56 ? 4 : header >= 52 ? 3 : 0);
        return pixels(decode(make(bmp)))[0];
    };
    const File rgb = masks(0xFF0000, 0xFF00, 0xFF), rgba = join({rgb, le(4, 0xFF000000)});
    EXPECT_EQ(one(40, 0, {}), (Rgba{3, 2, 1, 255}));
    EXPECT_EQ(one(108, 0, {}), (Rgba{3, 2, 1, 255})) << "uncompressed: the masks are not looked at";
    EXPECT_EQ(one(40, 3, rgb), (Rgba{3, 2, 1, 255}));
    EXPECT_EQ(one(40, 6, rgba), (Rgba{3, 2, 1, 4}));
    EXPECT_EQ(one(52, 3, {}), (Rgba{3, 2, 1, 255}));
    for (const int header : {56, 108, 124}) EXPECT_EQ(one(header, 3, {}), (Rgba{3, 2, 1, 4})) << header;
}

// ---- run lengths ----

File runs(int width, int height, int bits, const File& data) {
    return make({.width = width,
                 .height = height,
                 .bits = bits,
                 .compression = bits == 8 ? 1 : 2,
                 .colours = 3,
                 .between = palette,
                 .pixels = data});
}

TEST(Bmp, RunsOfBytes) {
    // Rows from the bottom up: a run of three and a filled-up stretch of three; two single ones, the end of
    // the row, the end of the picture.
    const File data = bytes({3, 1, 0, 3, 2, 1, 0, 99, 0, 0, 1, 2, 1, 1, 0, 0, 0, 1});
    EXPECT_EQ(pixels(decode(runs(6, 2, 8, data))),
              (std::vector<Rgba>{green, red, blue, blue, blue, blue, red, red, red, green, red, blue}));
    // From the top down, which no writer does and every reader reads.
    EXPECT_EQ(pixels(decode(runs(2, -2, 8, bytes({2, 1, 0, 0, 2, 2, 0, 1})))),
              (std::vector<Rgba>{red, red, green, green}));
}

TEST(Bmp, RunsOfNibbles) {
    // A run of five alternates; of a stretch of five, three bytes are stored and one fills them up.
    const File data = bytes({5, 0x12, 0, 5, 0x21, 0x10, 0x20, 0, 0, 1});
    EXPECT_EQ(pixels(decode(runs(10, 1, 4, data))),
              (std::vector<Rgba>{red, green, red, green, red, green, red, red, blue, green}));
}

TEST(Bmp, PixelsThatRunsPassOverHaveTheFirstColour) {
    // Two right and one up, then one pixel.
    EXPECT_EQ(pixels(decode(runs(3, 3, 8, bytes({0, 2, 2, 1, 1, 1, 0, 1})))),
              (std::vector<Rgba>{blue, blue, blue, blue, blue, red, blue, blue, blue}));
    EXPECT_EQ(pixels(decode(runs(3, 1, 8, bytes({1, 2, 0, 1})))), (std::vector<Rgba>{green, blue, blue}));
    EXPECT_EQ(pixels(decode(runs(1, 1, 8, bytes({0, 2, 255, 255, 9, 1, 0, 1})))), (std::vector<Rgba>{blue}))
        << "beyond the picture";
}

TEST(Bmp, RunsBeyondTheirRowAreCutOff) {
    EXPECT_EQ(pixels(decode(runs(2, 2, 8, bytes({255, 1, 7, 2, 0, 0, 2, 2, 0, 1})))),
              (std::vector<Rgba>{green, green, red, red}));
    EXPECT_EQ(pixels(decode(runs(2, 2, 8, bytes({0, 3, 1, 2, 0, 0, 0, 0, 2, 2, 0, 1})))),
              (std::vector<Rgba>{green, green, red, green}));
    EXPECT_EQ(pixels(decode(runs(2, 2, 8, bytes({0, 0, 1, 1, 9, 2, 0, 1})))),
              (std::vector<Rgba>{red, green, blue, blue}));
}

TEST(Bmp, RunsMayEndWithoutTheirMark) {
    EXPECT_EQ(pixels(decode(runs(2, 2, 8, bytes({2, 1, 0, 0, 2, 2})))),
              (std::vector<Rgba>{green, green, red, red}));
    expect_each_cut_refused(runs(2, 2, 8, bytes({2, 1, 0, 0, 2, 2})), "a.bmp");
    expect_each_cut_refused(runs(4, 1, 4, bytes({0, 4, 0x12, 0x12})), "a.bmp");
    expect_each_cut_refused(runs(4, 2, 8, bytes({0, 2, 1, 1, 0, 3, 1, 2, 1})), "a.bmp");
}

TEST(Bmp, WhatIsPackedOtherwiseIsNamed) {
    const auto packed = [](int header, int bits, int compression) {
        return make({.header = header, .bits = bits, .compression = compression, .pixels = File(100)});
    };
    expect_refused(packed(40, 0, 4), "a.bmp", "holds its pixels as a JPEG picture; expected");
    expect_refused(packed(124, 0, 5), "a.bmp", "holds its pixels as a PNG picture; expected");
    expect_refused(packed(64, 1, 3), "a.bmp", "holds its pixels as Huffman codes; expected");
    expect_refused(packed(64, 24, 4), "a.bmp", "holds its pixels as runs of 24 bits; expected");
    expect_refused(packed(40, 32, 11), "a.bmp", "holds its pixels as CMYK inks; expected");
    expect_refused(packed(40, 64, 0), "a.bmp", "has 64 bits a pixel; expected");
    expect_refused(packed(40, 24, 1), "a.bmp", "its compression does not go with 24 bits a pixel");
    expect_refused(packed(40, 24, 77), "a.bmp", "its compression does not go with 24 bits a pixel");
}

// ---- colours ----

constexpr std::uint32_t srgb = 0x73524742, windows = 0x57696E20, linked = 0x4C494E4B, embedded = 0x4D424544;

Description described_by(int header, std::vector<std::pair<int, std::uint32_t>> fields,
                         const File& behind = {}) {
    return decode(make({.header = header,
                        .fields = std::move(fields),
                        .pixels = join({bytes({1, 2, 3, 0}), behind})}))
        .description;
}

TEST(Bmp, SrgbWithItsIntent) {
    EXPECT_EQ(described_by(108, {{56, srgb}}).srgb_intent, 0);
    const std::vector<std::pair<std::uint32_t, int>> intents{{1, 2}, {2, 1}, {4, 0}, {8, 3}, {0, 0}};
    for (const auto& [bit, intent] : intents)
        EXPECT_EQ(described_by(124, {{56, srgb}, {108, bit}}).srgb_intent, intent) << bit;
    EXPECT_EQ(described_by(124, {{56, windows}, {108, 4}}), Description{});
    EXPECT_EQ(described_by(124, {}), Description{}) << "calibrated by nothing but zeros";
}

TEST(Bmp, CalibratedColours) {
    const auto fixed = [](double v) { return std::uint32_t(v * (1 << 30)); };
    const auto calibrated = [&](double gamma, const std::array<double, 9>& xyz) {
        std::vector<std::pair<int, std::uint32_t>> fields;
        for (int i = 0; i < 9; ++i) fields.push_back({60 + 4 * i, fixed(xyz[std::size_t(i)])});
        for (const int at : {96, 100, 104}) fields.push_back({at, std::uint32_t(gamma * 65536 + 0.5)});
        return fields;
    };
    // Chromaticities, whose parts sum to 1, and D65 for white; the exponent to linear light or from it.
    const std::array<double, 9> xyz{0.64, 0.33, 0.03, 0.30, 0.60, 0.10, 0.15, 0.06, 0.79};
    const Chromaticities expected{31270, 32900, 64000, 33000, 30000, 60000, 15000, 6000};
    for (const double gamma : {2.2, 1 / 2.2}) {
        const Description found = described_by(108, calibrated(gamma, xyz));
        ASSERT_TRUE(found.gamma && found.chromaticities);
        EXPECT_NEAR(*found.gamma, 45455, 3);
        EXPECT_EQ(*found.chromaticities, expected);
    }
    // CIE XYZ of sRGB's primaries, of which white is the sum.
    const std::array<double, 9> absolute{0.4124, 0.2126, 0.0193, 0.3576, 0.7152,
                                         0.1192, 0.1805, 0.0722, 0.9505};
    const Description found = described_by(108, calibrated(1, absolute));
    EXPECT_EQ(found.gamma, 100000u);
    ASSERT_TRUE(found.chromaticities);
    for (std::size_t i = 0; i < 8; ++i) EXPECT_NEAR((*found.chromaticities)[i], expected[i], 20) << i;
    // Different curves for the colours are nothing that can be carried on.
    auto fields = calibrated(2.2, xyz);
    fields.back().second *= 2;
    EXPECT_EQ(described_by(108, fields), Description{});
}

TEST(Bmp, EmbeddedProfile) {
    const File profile(200, std::byte{7});
    const auto with = [&](std::uint32_t kind, std::uint32_t at, std::uint32_t size) {
        return described_by(124, {{56, kind}, {112, at}, {116, size}}, profile).icc;
    };
    EXPECT_EQ(with(embedded, 128, 200), profile) << "behind the header and one row of four bytes";
    EXPECT_EQ(with(linked, 128, 200), File{});
    EXPECT_EQ(with(embedded, 129, 200), File{}) << "beyond the file";
    EXPECT_EQ(with(embedded, 0xFFFFFFFF, 0xFFFFFFFF), File{});
}

TEST(Bmp, AProfileIsWrittenAndReadBack) {
    for (const int alpha : {255, 90}) {
        Image image{2, 2, std::vector<std::uint8_t>(16, 255), {}};
        std::get<0>(image.rgba)[4] = 7;
        std::get<0>(image.rgba)[3] = std::uint8_t(alpha);
        const File plain = encode(image, "bmp");
        EXPECT_EQ(std::to_integer<int>(plain[14]), alpha == 255 ? 40 : 108);
        image.description.resolution = Resolution{3000, 2000};
        image.description.icc = File(301, std::byte{9});
        const File file = encode(image, "bmp");
        EXPECT_EQ(std::to_integer<int>(file[14]), 124);
        EXPECT_EQ(File(file.begin() + 2, file.begin() + 6), le(4, file.size()));
        const Image back = decode(file);
        EXPECT_EQ(pixels(back), pixels(image));
        EXPECT_EQ(back.description, image.description);
    }
    // Gamma becomes a profile, for a header of BMP's has no exact place for it.
    Image image{1, 1, std::vector<std::uint8_t>(4, 255), {}};
    image.description.gamma = 100000;
    EXPECT_GT(decode(encode(image, "bmp")).description.icc.size(), 300u);
    for (const int intent : {0, 1, 2, 3}) {
        image.description.srgb_intent = std::uint8_t(intent);
        const Image back = decode(encode(image, "bmp"));
        EXPECT_EQ(back.description.srgb_intent, intent);
        EXPECT_TRUE(back.description.icc.empty());
        EXPECT_EQ(pixels(back), pixels(image));
    }
}

// ---- files that end too soon ----

TEST(Bmp, WhatIsThereIsSalvaged) {
    const File row = bytes({0, 0, 255, 0, 255, 0, 0, 0});  // red, green and two bytes to fill it up
    EXPECT_EQ(
        pixels(salvaged(make({.width = 2, .height = 3, .pixels = join({row, row, bytes({0, 0, 255})})}))),
        (std::vector<Rgba>{red, clear, red, green, red, green}));
    EXPECT_EQ(pixels(salvaged(runs(2, 2, 8, bytes({2, 1, 0, 0, 1, 2})))),
              (std::vector<Rgba>{green, clear, red, red}));
    EXPECT_EQ(pixels(salvaged(runs(4, 1, 8, bytes({0, 3, 1, 2})))),
              (std::vector<Rgba>{red, green, clear, clear}));
    EXPECT_EQ(pixels(salvaged(runs(6, 1, 4, bytes({0, 5, 0x12})))),
              (std::vector<Rgba>{red, green, clear, clear, clear, clear}));
    expect_nothing_to_salvage(make({}));
    expect_nothing_to_salvage(runs(2, 2, 8, {}));
}

}  // namespace
}  // namespace probewarp
