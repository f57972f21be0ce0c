// TGA: where its alpha comes from, palettes, corners, what its second version adds, and how it is recognised
// without a signature.
#include <gtest/gtest.h>

#include <random>

#include "image_checks.h"
#include "salvage.h"

namespace probewarp {
namespace {

using namespace testing;

constexpr Rgba black{0, 0, 0, 255}, red{255, 0, 0, 255}, green{0, 255, 0, 255}, blue{0, 0, 255, 255};
constexpr Rgba clear{0, 0, 0, 0};

struct Palette {
    int first = 0, count = 0, bits = 0;
    File colours{};
};

File make(int width, int height, int type, int bits, int descriptor, const Palette& palette, const File& data,
          const std::string& id = "") {
    const auto two = [](int v) { return le(2, std::uint64_t(v)); };
    return join({bytes({int(id.size()), palette.bits > 0, type}), two(palette.first), two(palette.count),
                 bytes({palette.bits}), two(0), two(0), two(width), two(height), bytes({bits, descriptor}),
                 bytes_of(id), palette.colours, data});
}

std::vector<Rgba> row(int type, int bits, int descriptor, const File& data, const Palette& palette = {}) {
    const int count = int(data.size()) / ((bits + 7) / 8);
    return pixels(decode(make(count, 1, type, bits, descriptor, palette, data), "a.tga"));
}

struct Extension {
    int alpha = 3;
    std::array<int, 2> aspect{}, gamma{};
};

/// The file in the second version.
File extended(const File& file, const Extension& extension) {
    File area = le(2, 495);
    area.resize(495);
    const auto put = [&](std::size_t at, int v) {
        std::copy_n(le(2, std::uint64_t(v)).begin(), 2, area.begin() + std::ptrdiff_t(at));
    };
    put(474, extension.aspect[0]), put(476, extension.aspect[1]);
    put(478, extension.gamma[0]), put(480, extension.gamma[1]);
    area[494] = std::byte(extension.alpha);
    return join({file, area, le(4, file.size()), le(4, 0), bytes_of("TRUEVISION-XFILE."), bytes({0})});
}

// ---- kinds ----

TEST(Tga, OfEveryKind) {
    const auto of = [](int type, int bits, int descriptor, const File& data) {
        return pixels(decode(make_tga(2, 2, type, bits, descriptor, data), "a.tga"));
    };
    const File rows = bytes({0, 0, 255, 0, 255, 0, 255, 0, 0, 0, 0, 0});
    EXPECT_EQ(of(2, 24, 0, rows), (std::vector<Rgba>{blue, black, red, green})) << "from the bottom up";
    EXPECT_EQ(of(2, 24, 0x20, rows), (std::vector<Rgba>{red, green, blue, black})) << "from the top down";
    EXPECT_EQ(of(2, 24, 0x30, rows), (std::vector<Rgba>{green, red, black, blue})) << "from right to left";
    EXPECT_EQ(of(2, 32, 0x28, bytes({1, 2, 3, 4, 1, 2, 3, 4, 1, 2, 3, 4, 5, 6, 7, 0})).back(),
              (Rgba{7, 6, 5, 0}));
    EXPECT_EQ(of(3, 8, 0x20, bytes({1, 2, 3, 4}))[2], (Rgba{3, 3, 3, 255}));
    EXPECT_EQ(of(2, 16, 0x20, bytes({0, 0x7C, 0xE0, 3, 0x1F, 0, 0, 0})),
              (std::vector<Rgba>{red, green, blue, black}));
    // A run of three, then one by itself; runs may go on in the next row.
    EXPECT_EQ(of(10, 24, 0x20, bytes({0x82, 0, 0, 255, 0, 255, 0, 0})),
              (std::vector<Rgba>{red, red, red, blue}));
}

TEST(Tga, PaletteThatStartsLate) {
    // Two colours, the first of which has number 5.
    const File file = join({bytes({3, 1, 1}), le(2, 5), le(2, 2), bytes({24, 0, 0, 0, 0}), le(2, 2), le(2, 1),
                            bytes({8, 0x20}), bytes_of("an!"), bytes({0, 0, 255, 0, 255, 0}), bytes({6, 5})});
    EXPECT_EQ(pixels(decode(file, "a.tga")), (std::vector<Rgba>{green, red}));
}

TEST(Tga, BadOnesAreRefused) {
    expect_refused(make_tga(60000, 1, 2, 24, 0, bytes({1})), "a.tga", "is 60000 x 1 pixels");
    expect_refused(make_tga(9000, 9000, 10, 24, 0, bytes({0xFF, 1, 2, 3})), "a.tga", "is truncated");
    expect_refused(make_tga(0, 1, 2, 24, 0, bytes({1})), "a.tga", "is not a picture");
}

// ---- alpha ----

TEST(Tga, AlphaOnlyWhereTheDescriptorSaysSo) {
    const File deep = bytes({1, 2, 3, 0, 4, 5, 6, 128});
    EXPECT_EQ(row(2, 32, 0x20, deep), (std::vector<Rgba>{{3, 2, 1, 255}, {6, 5, 4, 255}}));
    EXPECT_EQ(row(2, 32, 0x28, deep), (std::vector<Rgba>{{3, 2, 1, 0}, {6, 5, 4, 128}}));
    const File words = join({le(2, 0x7C00), le(2, 0x801F)});
    EXPECT_EQ(row(2, 16, 0x20, words), (std::vector<Rgba>{red, blue}));
    EXPECT_EQ(row(2, 15, 0x20, words), (std::vector<Rgba>{red, blue}));
    EXPECT_EQ(row(2, 16, 0x21, words), (std::vector<Rgba>{{255, 0, 0, 0}, blue}));
    const File grey = bytes({7, 0, 9, 128});
    EXPECT_EQ(row(3, 16, 0x20, grey), (std::vector<Rgba>{{7, 7, 7, 255}, {9, 9, 9, 255}}));
    EXPECT_EQ(row(3, 16, 0x28, grey), (std::vector<Rgba>{{7, 7, 7, 0}, {9, 9, 9, 128}}));
    const Palette palette{0, 2, 32, deep};
    EXPECT_EQ(row(1, 8, 0x20, bytes({1, 0}), palette), (std::vector<Rgba>{{6, 5, 4, 255}, {3, 2, 1, 255}}));
    EXPECT_EQ(row(1, 8, 0x28, bytes({1, 0}), palette), (std::vector<Rgba>{{6, 5, 4, 128}, {3, 2, 1, 0}}));
}

TEST(Tga, TheSecondVersionSaysWhatAlphaIs) {
    const auto one = [](int descriptor, int alpha) {
        const File file = make(1, 1, 2, 32, descriptor, {}, bytes({10, 20, 100, 128}));
        return pixels(decode(extended(file, {.alpha = alpha}), "a.tga"))[0];
    };
    for (const int descriptor : {0x20, 0x28}) {
        for (const int nothing : {0, 1, 2}) EXPECT_EQ(one(descriptor, nothing), (Rgba{100, 20, 10, 255}));
        EXPECT_EQ(one(descriptor, 3), (Rgba{100, 20, 10, 128}));
        EXPECT_EQ(one(descriptor, 4), (Rgba{199, 40, 20, 128})) << "multiplied by alpha";
    }
    const auto premultiplied = [](const File& pixel) {
        return pixels(decode(extended(make(1, 1, 2, 32, 0x28, {}, pixel), {.alpha = 4}), "a.tga"))[0];
    };
    EXPECT_EQ(premultiplied(bytes({200, 1, 0, 100})), (Rgba{0, 3, 255, 100})) << "brighter than its alpha";
    EXPECT_EQ(premultiplied(bytes({3, 2, 1, 0})), (Rgba{1, 2, 3, 0}));
}

TEST(Tga, TheDescriptorOfWhatIsWrittenIsRight) {
    Image image{1, 1, std::vector<std::uint8_t>{1, 2, 3, 4}, {}};
    EXPECT_EQ(std::to_integer<int>(encode(image, "tga")[17]) & 15, 8);
    EXPECT_EQ(pixels(decode(encode(image, "tga"), "a.tga")), pixels(image));
    std::get<0>(image.rgba)[3] = 255;
    EXPECT_EQ(std::to_integer<int>(encode(image, "tga")[17]) & 15, 0);
}

// ---- palettes, rows and runs ----

TEST(Tga, PalettesOfEveryDepth) {
    const File words = join({le(2, 0x7C00), le(2, 0x03E0)});
    for (const int bits : {15, 16})
        EXPECT_EQ(row(1, 8, 0x20, bytes({1, 0, 2}), {0, 2, bits, words}),
                  (std::vector<Rgba>{green, red, black}))
            << "a colour that is not there is black";
    // Numbers of 16 bits; the palette starts late.
    EXPECT_EQ(row(1, 16, 0x20, join({le(2, 301), le(2, 300), le(2, 299)}), {300, 2, 15, words}),
              (std::vector<Rgba>{green, red, black}));
}

TEST(Tga, PaletteThatIsNotUsed) {
    for (const int type : {2, 10}) {
        const File data = type == 2 ? bytes({0, 0, 255}) : bytes({0, 0, 0, 255});
        for (const int bits : {15, 24, 32})
            EXPECT_EQ(pixels(decode(make(1, 1, type, 24, 0, {0, 2, bits, File(std::size_t(bits + 7) / 8 * 2)},
                                         data, "a name"),
                                    "a.tga")),
                      (std::vector<Rgba>{red}));
    }
    EXPECT_EQ(pixels(decode(make(1, 1, 3, 8, 0, {0, 2, 24, File(6)}, bytes({9})), "a.tga")),
              (std::vector<Rgba>{{9, 9, 9, 255}}));
}

TEST(Tga, RunsInEveryCorner) {
    // Across the end of a row: three red, then one green, one blue.
    const File data = bytes({0x82, 0, 0, 255, 0x01, 0, 255, 0, 255, 0, 0, 0x00, 0, 0, 0});
    const auto of = [&](int descriptor) {
        return pixels(decode(make(2, 3, 10, 24, descriptor, {}, data), "a.tga"));
    };
    EXPECT_EQ(of(0x20), (std::vector<Rgba>{red, red, red, green, blue, black}));
    EXPECT_EQ(of(0x30), (std::vector<Rgba>{red, red, green, red, black, blue}));
    EXPECT_EQ(of(0x00), (std::vector<Rgba>{blue, black, red, green, red, red}));
    EXPECT_EQ(of(0x10), (std::vector<Rgba>{black, blue, green, red, red, red}));
    // Of palettes and of grey.
    EXPECT_EQ(pixels(decode(
                  make(3, 1, 9, 8, 0, {4, 2, 15, join({le(2, 0x7C00), le(2, 0x1F)})}, bytes({0x81, 5, 0, 4})),
                  "a.tga")),
              (std::vector<Rgba>{blue, blue, red}));
    EXPECT_EQ(pixels(decode(make(3, 1, 11, 8, 0, {}, bytes({0x83, 5})), "a.tga")),
              std::vector<Rgba>(3, {5, 5, 5, 255}))
        << "a run beyond the picture is cut off";
}

// ---- colours and shape of pixels ----

TEST(Tga, GammaAndAspectOfTheSecondVersion) {
    const File file = make(1, 1, 2, 24, 0, {}, bytes({1, 2, 3}));
    const auto described = [&](const Extension& extension) {
        return decode(extended(file, extension), "a.tga").description;
    };
    EXPECT_EQ(described({.gamma = {22, 10}}).gamma, 45455u);
    EXPECT_EQ(described({.gamma = {1, 1}}).gamma, 100000u);
    EXPECT_EQ(described({.aspect = {2, 1}}).aspect, (Resolution{1, 2})) << "twice as wide as high";
    for (const Extension& nothing :
         {Extension{}, Extension{.aspect = {1, 1}, .gamma = {2, 0}}, Extension{.gamma = {0, 1}},
          Extension{.aspect = {0, 3}, .gamma = {300, 1}}})
        EXPECT_EQ(described(nothing), Description{});
    // A footer that points nowhere.
    const File footer = join({le(4, 0), bytes_of("TRUEVISION-XFILE."), bytes({0})});
    for (const std::uint32_t start : {0u, 17u, 20u, 0xFFFFFFFFu}) {
        const Image image = decode(join({file, le(4, start), footer}), "a.tga");
        EXPECT_EQ(image.description, Description{});
        EXPECT_EQ(pixels(image), (std::vector<Rgba>{{3, 2, 1, 255}}));
    }
}

TEST(Tga, GammaAndAspectAreWrittenAndReadBack) {
    for (const int alpha : {255, 7}) {
        Image image{1, 2, std::vector<std::uint8_t>{1, 2, 3, std::uint8_t(alpha), 5, 6, 7, 255}, {}};
        const File plain = encode(image, "tga");
        image.description.gamma = 45455;
        image.description.aspect = Resolution{3, 2};
        const File file = encode(image, "tga");
        EXPECT_EQ(file.size(), plain.size() + 495 + 26);
        const Image back = decode(file, "any name");
        EXPECT_EQ(pixels(back), pixels(image));
        EXPECT_EQ(back.description, image.description);
    }
    Image image{1, 1, std::vector<std::uint8_t>(4, 255), {}};
    const File plain = encode(image, "tga");
    image.description.resolution = Resolution{11811, 5905};
    EXPECT_EQ(decode(encode(image, "tga"), "a.tga").description.aspect, (Resolution{11811, 5905}));
    image.description.resolution = Resolution{3000000, 1000000};
    EXPECT_EQ(decode(encode(image, "tga"), "a.tga").description.aspect, (Resolution{3, 1}));
    // Square pixels, and sRGB beside a gamma that stands for it, need no word.
    image.description = {.srgb_intent = 0, .gamma = 45455, .resolution = Resolution{3000, 3000}};
    EXPECT_EQ(encode(image, "tga"), plain);
}

// ---- recognition ----

TEST(Tga, EveryEndingOfItsOwnAndNone) {
    const File file = make(2, 1, 2, 24, 0x20, {}, bytes({0, 0, 255, 0, 255, 0}));
    for (const char* name : {"a.tga", "a.VDA", "a.icb", "a.vst", "picture", "a.tga.old", "a.png"})
        EXPECT_EQ(decode_picture(file, name).format, "tga") << name;
    // A file by another name has to end where its pixels do, unless it is signed.
    const File longer = join({file, File(1)});
    EXPECT_EQ(error_of(longer, "a.tga"), "");
    EXPECT_NE(error_of(longer, "picture"), "");
    EXPECT_EQ(error_of(extended(longer, {}), "picture"), "");
    EXPECT_NE(error_of(File(file.begin(), file.end() - 1), "picture"), "");
    expect_refused(File(file.begin(), file.end() - 1), "a.vst", "is truncated; expected a whole TGA file");
    const File runs = make(200, 1, 10, 24, 0, {}, bytes({0xFF, 1, 2, 3, 0xC7, 1, 2, 3}));
    EXPECT_EQ(error_of(runs, "picture"), "");
    EXPECT_NE(error_of(join({runs, File(1)}), "picture"), "");
    EXPECT_NE(error_of(File(runs.begin(), runs.end() - 1), "picture"), "");
}

TEST(Tga, NothingElseIsTakenForOne) {
    // By another name, a header that makes sense is not enough.
    std::mt19937 random(1);
    int sensible = 0;
    for (int i = 0; i < 20000; ++i) {
        File file = make(int(random() % 300), int(random() % 300), int(random() % 12), int(random() % 5) * 8,
                         int(random() % 256), {}, {});
        file.resize(18 + random() % 3000);
        sensible += error_of(file, "a.tga").find("is not a picture") == std::string::npos;
        EXPECT_NE(error_of(file, "fuzz"), "");
    }
    EXPECT_GT(sensible, 1000);
}

// ---- files that end too soon ----

TEST(Tga, WhatIsThereIsSalvaged) {
    EXPECT_EQ(pixels(salvaged(make(2, 2, 2, 24, 0x20, {}, bytes({0, 0, 255, 0, 255, 0, 255, 0, 0, 1, 2})))),
              (std::vector<Rgba>{red, green, blue, clear}));
    EXPECT_EQ(pixels(salvaged(make(2, 2, 10, 24, 0, {}, bytes({0x80, 0, 0, 255, 2, 255, 0, 0, 0})))),
              (std::vector<Rgba>{clear, clear, red, blue}));
    expect_nothing_to_salvage(make(2, 2, 2, 24, 0, {}, bytes({1, 2})));
    expect_nothing_to_salvage(make(2, 2, 10, 24, 0, {}, bytes({0x80, 1})));
}

}  // namespace
}  // namespace probewarp
