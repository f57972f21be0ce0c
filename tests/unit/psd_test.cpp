// io/psd*.cpp: every mode, depth and packing of PSD and PSB, which channel is alpha, and what is carried
// over.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "exif_files.h"
#include "image_checks.h"
#include "io/exif.h"
#include "psd_files.h"

namespace probewarp {
namespace {

using namespace testing;

Rgba only_pixel(const PsdSpec& spec) {
    const std::vector<Rgba> all = pixels(decode(make_psd(spec)));
    EXPECT_EQ(all.size(), 1u);
    return all[0];
}

void expect_near(const Rgba& found, const Rgba& meant, int tolerance) {
    for (std::size_t c = 0; c < 4; ++c) EXPECT_NEAR(found[c], meant[c], tolerance) << "sample " << c;
}

/// sRGB's transfer function (IEC 61966-2-1). light: 0 to 1; the sample: 0 to full
int srgb_sample(double light, int full) {
    light = std::clamp(light, 0.0, 1.0);
    const double v = light <= 0.0031308 ? 12.92 * light : 1.055 * std::pow(light, 1 / 2.4) - 0.055;
    return int(std::lround(v * full));
}

/// CIE's formulae, and the matrix of sRGB adapted to D50 by Bradford's.
Rgba srgb_of_lab(double l, double a, double b, int full) {
    const auto cube = [](double t) { return t > 6 / 29.0 ? t * t * t : 108 / 841.0 * (t - 4 / 29.0); };
    const double fy = (l + 16) / 116, x = 0.9642 * cube(fy + a / 500), y = cube(fy),
                 z = 0.8249 * cube(fy - b / 200);
    return {srgb_sample(3.1338561 * x - 1.6168667 * y - 0.4906146 * z, full),
            srgb_sample(-0.9787684 * x + 1.9161415 * y + 0.0334540 * z, full),
            srgb_sample(0.0719453 * x - 0.2289914 * y + 1.4052427 * z, full), full};
}

// ---- how the rows lie ----

TEST(Psd, RawAndPacked) {
    const File planes = bytes({1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12});  // 2 x 2, red, green, blue
    const std::vector<Rgba> meaning{{1, 5, 9, 255}, {2, 6, 10, 255}, {3, 7, 11, 255}, {4, 8, 12, 255}};
    for (const bool large : {false, true})
        EXPECT_EQ(pixels(decode(make_psd({.width = 2, .height = 2, .rows = planes, .large = large}))),
                  meaning);
    // 3 x 1, PackBits: literal, run, and a run after a no-op.
    const File packed = bytes({2, 1, 2, 3, 254, 7, 128, 255, 9, 0, 4});
    for (const std::size_t length : {2u, 4u})
        EXPECT_EQ(pixels(decode(make_psd({.width = 3,
                                          .rows = join({be(length, 4), be(length, 2), be(length, 5), packed}),
                                          .compression = 1,
                                          .large = length == 4}))),
                  (std::vector<Rgba>{{1, 7, 9, 255}, {2, 7, 9, 255}, {3, 7, 4, 255}}));
    const Image deep = decode(make_psd({.mode = 1,
                                        .bits = 16,
                                        .channels = 1,
                                        .width = 2,
                                        .rows = join({be(2, 5), bytes({3, 1, 2, 3, 4})}),
                                        .compression = 1}));
    EXPECT_EQ(deep.bits(), 16);
    EXPECT_EQ(pixels(deep), (std::vector<Rgba>{{258, 258, 258, 65535}, {772, 772, 772, 65535}}));
}

TEST(Psd, Deflated) {
    const File planes = bytes({1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 0, 0, 0, 200});
    const std::vector<Rgba> meaning{{1, 5, 9, 255}, {2, 6, 10, 255}, {3, 7, 11, 255}, {4, 8, 12, 255}};
    // The fourth channel is no part of the picture.
    EXPECT_EQ(pixels(decode(make_psd(
                  {.channels = 4, .width = 2, .height = 2, .rows = deflated(planes), .compression = 2}))),
              meaning);
    const auto differences = [](int bits, int width, const File& rows) {
        return pixels(decode(make_psd({.mode = 1,
                                       .bits = bits,
                                       .channels = 1,
                                       .width = width,
                                       .height = 2,
                                       .rows = deflated(rows),
                                       .compression = 3})));
    };
    const auto grey = [](int v, int full) { return Rgba{v, v, v, full}; };
    EXPECT_EQ(differences(8, 3, bytes({10, 253, 243, 1, 1, 1})),
              (std::vector<Rgba>{grey(10, 255), grey(7, 255), grey(250, 255), grey(1, 255), grey(2, 255),
                                 grey(3, 255)}));
    EXPECT_EQ(
        differences(16, 2, join({be(2, 0x01FF), be(2, 1), be(2, 0x0200), be(2, 0xFFFF)})),
        (std::vector<Rgba>{grey(0x1FF, 65535), grey(0x200, 65535), grey(0x200, 65535), grey(0x1FF, 65535)}));
    // 0.5 (3F000000) and 1 (3F800000): their first bytes, their second ones, and so on.
    const File halves = bytes({0x3F, 0, 0xC1, 0x80, 0x80, 0, 0, 0});
    EXPECT_EQ(differences(32, 2, join({halves, halves})),
              (std::vector<Rgba>{grey(srgb_sample(0.5, 65535), 65535), grey(65535, 65535),
                                 grey(srgb_sample(0.5, 65535), 65535), grey(65535, 65535)}));
}

// ---- modes ----

TEST(Psd, Bitmap) {
    const Rgba black{0, 0, 0, 255}, white{255, 255, 255, 255};
    const PsdSpec spec{.mode = 0,
                       .bits = 1,
                       .channels = 1,
                       .width = 9,
                       .height = 2,
                       .rows = bytes({0x80, 0x80, 0x7F, 0x7F})};
    std::vector<Rgba> meaning(18, white);
    meaning[0] = meaning[8] = black;
    for (std::size_t i = 10; i < 17; ++i) meaning[i] = black;
    EXPECT_EQ(pixels(decode(make_psd(spec))), meaning);
}

TEST(Psd, Indexed) {
    File palette(768);
    for (int c = 0; c < 3; ++c)
        for (int i = 0; i < 3; ++i) palette[std::size_t(c * 256 + i)] = std::byte(10 * i + c);
    PsdSpec spec{.mode = 2, .channels = 1, .width = 4, .rows = bytes({2, 1, 0, 255}), .palette = palette};
    EXPECT_EQ(pixels(decode(make_psd(spec))),
              (std::vector<Rgba>{{20, 21, 22, 255}, {10, 11, 12, 255}, {0, 1, 2, 255}, {0, 0, 0, 255}}));
    spec.resources = psd_resource(1047, be(2, 1));
    EXPECT_EQ(pixels(decode(make_psd(spec)))[1], (Rgba{10, 11, 12, 0}));
    spec.resources = psd_resource(1047, be(2, 257));
    EXPECT_EQ(pixels(decode(make_psd(spec)))[1][3], 255) << "no colour has that number";
    spec.palette = bytes({1, 2, 3, 4, 5, 6});
    EXPECT_EQ(pixels(decode(make_psd(spec))),
              (std::vector<Rgba>{{0, 0, 0, 255}, {2, 4, 6, 255}, {1, 3, 5, 255}, {0, 0, 0, 255}}));
}

TEST(Psd, DuotoneIsGrey) {
    EXPECT_EQ(only_pixel({.mode = 8, .channels = 1, .rows = bytes({90}), .palette = File(20)}),
              (Rgba{90, 90, 90, 255}));
}

TEST(Psd, InksWithoutProfile) {
    // Full is no ink: light = (samples of cyan, magenta, yellow) times that of black.
    EXPECT_EQ(only_pixel({.mode = 4, .channels = 4, .rows = bytes({255, 100, 50, 255})}),
              (Rgba{255, 100, 50, 255}));
    EXPECT_EQ(only_pixel({.mode = 4, .channels = 4, .rows = bytes({255, 100, 50, 51})}),
              (Rgba{51, 20, 10, 255}));
    EXPECT_EQ(only_pixel({.mode = 4,
                          .bits = 16,
                          .channels = 4,
                          .rows = join({be(2, 65535), be(2, 1000), be(2, 500), be(2, 13107)})}),
              (Rgba{13107, 200, 100, 65535}));
}

TEST(Psd, InksByTheirProfile) {
    const File profile = psd_resource(1039, cmyk_icc());
    for (const int bits : {8, 16}) {
        const std::size_t size = std::size_t(bits / 8);
        const std::uint64_t full = bits == 8 ? 255 : 65535;
        const auto inks = [&](std::uint64_t cyan, std::uint64_t black) {
            const File rows = join({be(size, cyan), be(size, full), be(size, full), be(size, black)});
            return decode(
                make_psd({.mode = 4, .bits = bits, .channels = 4, .rows = rows, .resources = profile}));
        };
        const int tolerance = bits == 8 ? 1 : 150;  // the profile's 16 bits, and Little CMS's table of it
        expect_near(pixels(inks(full, full))[0], srgb_of_lab(100, 0, 0, int(full)), tolerance);
        expect_near(pixels(inks(0, full))[0], srgb_of_lab(60, -30, -40, int(full)), tolerance);
        expect_near(pixels(inks(full, 0))[0], srgb_of_lab(0, 0, 0, int(full)), tolerance);
        EXPECT_TRUE(inks(0, full).description.icc.empty()) << "the pixels are sRGB";
    }
}

TEST(Psd, MultichannelsAreInks) {
    EXPECT_EQ(only_pixel({.mode = 7, .channels = 4, .rows = bytes({255, 100, 50, 51})}),
              (Rgba{51, 20, 10, 255}));
    EXPECT_EQ(only_pixel({.mode = 7, .channels = 3, .rows = bytes({200, 100, 50})}),
              (Rgba{200, 100, 50, 255}));
    EXPECT_EQ(only_pixel({.mode = 7, .channels = 2, .rows = bytes({200, 100})}), (Rgba{200, 100, 255, 255}));
    EXPECT_EQ(only_pixel({.mode = 7, .channels = 1, .rows = bytes({80})}), (Rgba{80, 80, 80, 255}));
    EXPECT_EQ(only_pixel({.mode = 7, .channels = 6, .rows = bytes({200, 100, 50, 255, 1, 2})}),
              (Rgba{200, 100, 50, 255}));
}

TEST(Psd, Lab) {
    for (const auto& [l, a, b] :
         {std::array{255, 128, 128}, std::array{0, 128, 128}, std::array{128, 128, 128},
          std::array{140, 140, 90}, std::array{77, 100, 150}, std::array{220, 120, 160}})
        expect_near(only_pixel({.mode = 9, .rows = bytes({l, a, b})}),
                    srgb_of_lab(l / 2.55, a - 128, b - 128, 255), 1);
    // 16 bits: 65535 is a lightness of 100, 32768 no colour, and 256 a unit.
    const auto deep = [](double l, double a, double b) {
        return PsdSpec{
            .mode = 9,
            .bits = 16,
            .rows = join({be(2, std::uint64_t(std::lround(l * 655.35))),
                          be(2, std::uint64_t(32768 + a * 256)), be(2, std::uint64_t(32768 + b * 256))})};
    };
    // Half a unit of a or b, or of a lightness, would make a difference of 200 and more.
    expect_near(only_pixel(deep(100, 0, 0)), {65535, 65535, 65535, 65535}, 30);
    expect_near(only_pixel(deep(50, 0, 0)), srgb_of_lab(50, 0, 0, 65535), 30);
    expect_near(only_pixel(deep(60, -10.5, 20.25)), srgb_of_lab(60, -10.5, 20.25, 65535), 30);
    // Red, green and blue of sRGB, as Lab under D50 is commonly given.
    expect_near(only_pixel(deep(54.29, 80.81, 69.89)), {65535, 0, 0, 65535}, 600);
    expect_near(only_pixel(deep(87.82, -79.29, 80.99)), {0, 65535, 0, 65535}, 600);
    expect_near(only_pixel(deep(29.57, 68.30, -112.03)), {0, 0, 65535, 65535}, 600);
}

TEST(Psd, FloatingPointIsLight) {
    const auto rgb = [](float r, float g, float b, const File& resources = {}) {
        const Image image = decode(make_psd(
            {.bits = 32, .rows = join({be_float(r), be_float(g), be_float(b)}), .resources = resources}));
        EXPECT_EQ(image.bits(), 16);
        EXPECT_TRUE(image.description.icc.empty());
        return pixels(image)[0];
    };
    const int half = srgb_sample(0.5, 65535);
    EXPECT_EQ(half, 48192);
    EXPECT_EQ(rgb(0, 0.5f, 1), (Rgba{0, half, 65535, 65535}));
    EXPECT_EQ(rgb(2, -1, 0.5f), (Rgba{65535, 0, half, 65535}));
    constexpr float infinity = std::numeric_limits<float>::infinity();
    const float nan = std::numeric_limits<float>::quiet_NaN();
    EXPECT_EQ(rgb(nan, infinity, -infinity), (Rgba{0, 65535, 0, 65535}));
    // Light of Adobe RGB's primaries, whatever the curves that the profile has for other depths.
    for (const double exponent : {1.0, 2.2}) {
        const Rgba found = rgb(0.2f, 0.5f, 0.2f, psd_resource(1039, wide_rgb_icc(exponent)));
        const Rgba meant{srgb_sample(1.39836 * 0.2 - 0.39836 * 0.5, 65535), half,
                         srgb_sample(-0.04293 * 0.5 + 1.04293 * 0.2, 65535), 65535};
        expect_near(found, meant, 100);  // the matrices' digits
    }
    EXPECT_EQ(only_pixel({.mode = 1, .bits = 32, .channels = 1, .rows = be_float(0.5f)}),
              (Rgba{half, half, half, 65535}));
}

TEST(Psd, ExifIsCarried) {
    const ByteOrder order{true};
    const File exif = make_exif(order, {.main = {text(0x013B, "Somebody"), order.two(0x0112, 6)}});
    const Image image =
        decode(make_psd({.rows = bytes({1, 2, 3}), .resources = psd_resource(1058, exif)}), "a.psd");
    EXPECT_EQ(image.description.exif, parse_exif(exif).block);
    EXPECT_FALSE(image.description.exif.empty());
}

// ---- alpha ----

TEST(Psd, ExtraChannelIsAlphaOnlyWhereTheFileSaysSo) {
    const auto alpha = [](const File& resources, const File& layers, int bits = 8, bool large = false) {
        const std::size_t size = std::size_t(bits / 8);
        const File rows = join({be(size, 200), be(size, 40), be(size, 60), be(size, 3), be(size, 5)});
        return only_pixel({.bits = bits,
                           .channels = 5,
                           .rows = rows,
                           .large = large,
                           .resources = resources,
                           .layers = layers})[3];
    };
    EXPECT_EQ(alpha({}, {}), 255);
    EXPECT_EQ(alpha(psd_resource(1006, bytes_of("\7Alpha 1")), psd_layer_count(2)), 255);
    EXPECT_EQ(alpha(psd_resource(1053, join({be(4, 2), be(4, 3)})), {}), 255) << "saved selections";
    EXPECT_EQ(alpha(psd_resource(1053, join({be(4, 0), be(4, 3)})), {}), 3);
    EXPECT_EQ(alpha(psd_resource(1053, join({be(4, 3), be(4, 0)})), {}), 5);
    EXPECT_EQ(alpha(psd_resource(1053, join({be(4, 3), be(4, 4), be(4, 0)})), {}), 255) << "no such channel";
    for (const bool large : {false, true}) {
        EXPECT_EQ(alpha({}, psd_layer_count(1, large), 8, large), 255);
        EXPECT_EQ(alpha({}, psd_layer_count(-1, large), 8, large), 3);
        for (const auto key : {"Lr16", "Lr32", "Layr"}) {
            EXPECT_EQ(alpha({}, psd_layer_count_in_block(key, 2, large), 16, large), 65535);
            EXPECT_EQ(alpha({}, psd_layer_count_in_block(key, -2, large), 16, large), 3);
        }
    }
    EXPECT_EQ(only_pixel({.rows = bytes({200, 40, 60}), .layers = psd_layer_count(-1)}),
              (Rgba{200, 40, 60, 255}));
}

TEST(Psd, LayersThatMakeNoSenseAreNoMatter) {
    for (const File& layers :
         {be(2, 9), be(4, 1), join({be(4, 99), be(2, 0xFFFF)}), join({be(4, 0), be(4, 99)}),
          join({be(4, 0), be(4, 0), bytes_of("8BIMLr16"), be(4, 99), be(2, 0xFFFF)}),
          join({be(4, 0), be(4, 0), bytes_of("8BIMLr16"), be(4, 0), bytes_of("8BIMLr1")})})
        EXPECT_EQ(only_pixel({.channels = 4, .rows = bytes({1, 2, 3, 4}), .layers = layers}),
                  (Rgba{1, 2, 3, 255}));
}

TEST(Psd, AlphaMergedOntoWhiteOrNot) {
    const auto one = [](int c, int alpha) {
        return only_pixel(
            {.channels = 4, .rows = bytes({c, 255, 200, alpha}), .layers = psd_layer_count(-1)});
    };
    EXPECT_EQ(one(127, 128), (Rgba{0, 255, 145, 128}));  // 50 % of black, white and grey, on white
    EXPECT_EQ(one(90, 128), (Rgba{90, 255, 200, 128})) << "too dark to have white in it";
    EXPECT_EQ(one(90, 255), (Rgba{90, 255, 200, 255}));
    EXPECT_EQ(one(90, 0), (Rgba{90, 255, 200, 0}));
}

TEST(Psd, AlphaMergedOntoWhiteInOtherModes) {
    const auto one = [](int mode, int bits, const File& rows) {
        const int channels = int(rows.size()) * 8 / bits;
        return only_pixel(
            {.mode = mode, .bits = bits, .channels = channels, .rows = rows, .layers = psd_layer_count(-1)});
    };
    EXPECT_EQ(one(1, 8, bytes({191, 128})), (Rgba{128, 128, 128, 128}));
    EXPECT_EQ(one(1, 16, join({be(2, 65535 - 16384), be(2, 32768)})), (Rgba{32768, 32768, 32768, 32768}));
    // The white of inks is none of them, and that of a and b is 128.
    EXPECT_EQ(one(4, 8, bytes({127, 255, 200, 255, 128})), (Rgba{0, 255, 145, 128}));
    const Rgba unmixed = only_pixel({.mode = 9, .rows = bytes({100, 148, 88})});
    expect_near(one(9, 8, bytes({177, 138, 108, 128})), {unmixed[0], unmixed[1], unmixed[2], 128}, 2);
    // A lightness with white in it, but more colour than half can have.
    const Rgba mixed = only_pixel({.mode = 9, .rows = bytes({220, 255, 108})});
    EXPECT_EQ(one(9, 8, bytes({220, 255, 108, 64})), (Rgba{mixed[0], mixed[1], mixed[2], 64}));
    const int half = srgb_sample(0.5, 65535);
    EXPECT_EQ(one(1, 32, join({be_float(0.75f), be_float(0.5f)})), (Rgba{half, half, half, 32768}));
}

TEST(Psd, DeflatedChannelsAreReadAgainFromTheirBeginnings) {
    // Two rows of inks on white: looked through for white, for damage, and then read. Before the alpha stands
    // a channel that is no part of the picture.
    const File planes = bytes({127, 0, 255, 255, 200, 0, 255, 255, 9, 9, 128, 255});
    const File resources = psd_resource(1053, join({be(4, 7), be(4, 0)}));
    const std::vector<Rgba> meaning{{0, 255, 145, 128}, {0, 255, 0, 255}};
    for (const int compression : {0, 2})
        EXPECT_EQ(pixels(decode(make_psd({.mode = 4,
                                          .channels = 6,
                                          .height = 2,
                                          .rows = compression == 0 ? planes : deflated(planes),
                                          .compression = compression,
                                          .resources = resources}))),
                  meaning);
}

// ---- what a file says about itself ----

File pixel_aspect(double aspect) {
    return psd_resource(1064, join({be(4, 1), be(8, std::bit_cast<std::uint64_t>(aspect))}));
}

Description description_of(const PsdSpec& spec) { return decode(make_psd(spec)).description; }

TEST(Psd, ResolutionIsPerInchWhateverUnitIsShown) {
    for (const int unit : {1, 2}) {
        const auto described =
            description_of({.rows = File(3), .resources = psd_resolution(300, 72.5, unit)});
        EXPECT_EQ(described.resolution, (Resolution{11811, 2854}));
    }
    EXPECT_FALSE(description_of({.rows = File(3), .resources = psd_resolution(0, 72, 1)}).resolution);
    EXPECT_FALSE(description_of({.rows = File(3)}).resolution);
    EXPECT_FALSE(description_of({.rows = File(3), .resources = psd_resource(1005, File(15))}).resolution);
}

TEST(Psd, PixelsThatAreNotSquare) {
    const auto described = [](const File& resources) {
        return description_of({.rows = File(3), .resources = resources});
    };
    EXPECT_EQ(described(pixel_aspect(2)).aspect, (Resolution{1, 2})) << "twice as wide as high";
    EXPECT_EQ(described(pixel_aspect(0.9091)).aspect, (Resolution{10000, 9091}));
    EXPECT_FALSE(described(pixel_aspect(1)).aspect);
    EXPECT_FALSE(described(pixel_aspect(std::numeric_limits<double>::quiet_NaN())).aspect);
    EXPECT_FALSE(described(pixel_aspect(-2)).aspect);
    EXPECT_EQ(described(join({pixel_aspect(2), psd_resolution(100, 100, 1)})).resolution,
              (Resolution{3937, 7874}));
    EXPECT_EQ(described(join({psd_resolution(100, 50, 1), pixel_aspect(2)})).resolution,
              (Resolution{3937, 1969}));
}

TEST(Psd, ProfileIsCarriedOverWithThePixelsAsTheyAre) {
    const File profile = wide_rgb_icc(2.2), resource = psd_resource(1039, profile, "odd"),
               before = psd_resource(1000, bytes({1, 2, 3}), "even");
    const Image image =
        decode(make_psd({.rows = bytes({200, 40, 60}), .resources = join({before, resource})}));
    EXPECT_EQ(image.description.icc, profile);
    EXPECT_EQ(pixels(image)[0], (Rgba{200, 40, 60, 255}));
    EXPECT_EQ(description_of(
                  {.mode = 2, .channels = 1, .rows = File(1), .palette = File(768), .resources = resource})
                  .icc,
              profile);
    const auto grey = description_of(
        {.mode = 1, .channels = 1, .rows = bytes({9}), .resources = psd_resource(1039, grey_icc())});
    EXPECT_EQ(File(grey.icc.begin() + 16, grey.icc.begin() + 20), bytes_of("RGB "));
    EXPECT_TRUE(description_of({.mode = 9, .rows = File(3), .resources = resource}).icc.empty());
}

TEST(Psd, ResourcesThatBreakOffAreNoMatter) {
    const File list = join({psd_resolution(300, 300, 1), pixel_aspect(2)});
    for (std::size_t size = 0; size < list.size(); ++size) {
        const File cut(list.begin(), list.begin() + std::ptrdiff_t(size));
        const auto described = description_of({.rows = File(3), .resources = cut});
        EXPECT_EQ(described.resolution.has_value(), size >= 28) << size;
    }
}

// ---- no merged picture ----

TEST(Psd, WithoutAMergedPictureIsRefusedWithTheRemedy) {
    const auto version_info = [](int real) {
        return psd_resource(1057, join({be(4, 1), bytes({real}), be(4, 0), be(4, 0), be(4, 1)}));
    };
    const std::string words =
        "was saved without a merged picture; expected one: save the PSD again in Photoshop with "
        "\"Maximize Compatibility\"";
    const File white = bytes({255, 255, 255}), coloured = bytes({200, 40, 60});
    for (const File& layers : {psd_layer_count(1), psd_layer_count_in_block("Lr16", -1, false)})
        for (const File& rows : {white, coloured})
            expect_refused(make_psd({.rows = rows, .resources = version_info(0), .layers = layers}), "a.psd",
                           words);
    expect_refused(make_psd({.rows = white, .resources = version_info(0)}), "a.psd", words);
    EXPECT_EQ(only_pixel({.rows = coloured, .resources = version_info(0)}), (Rgba{200, 40, 60, 255}))
        << "without layers, what is there is the picture";
    EXPECT_EQ(only_pixel({.rows = white, .resources = version_info(1), .layers = psd_layer_count(1)}),
              (Rgba{255, 255, 255, 255}));
}

}  // namespace
}  // namespace probewarp
