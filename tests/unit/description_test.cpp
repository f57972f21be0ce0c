// What a file says of its colours and itself: written as it was read, or as a profile that says the same.
#include <gtest/gtest.h>

#include <Eigen/Dense>

#include "image_checks.h"
#include "io/colours.h"
#include "profiles.h"

namespace probewarp {
namespace {

using namespace testing;

Image small_picture() {
    std::vector<std::uint8_t> rgba;
    for (int i = 0; i < 4 * 3 * 4; ++i) rgba.push_back(i % 4 == 3 ? 255 : std::uint8_t(i * 5));
    return {4, 3, std::move(rgba), {}, {}};
}

Image described(const Description& description) {
    Image image = small_picture();
    image.description = description;
    return image;
}

const Chromaticities p3{31270, 32900, 68000, 32000, 26500, 69000, 15000, 6000};
const Chromaticities of_srgb{31270, 32900, 64000, 33000, 30000, 60000, 15000, 6000};
const File exif = join({bytes_of("II*"), bytes({0}), le(4, 8), le(2, 1), le(2, 0x8298), le(2, 2), le(4, 3),
                        bytes_of("me"), bytes({0, 0}), le(4, 0)});

/// The chunks' types, one behind the other, and what is in the one of that type.
std::string chunk_types(const File& png) {
    std::string types;
    for (std::size_t at = 8; at < png.size(); at += be32(png, at) + 12)
        types += std::string(reinterpret_cast<const char*>(&png[at + 4]), 4) + " ";
    return types;
}
File chunk_data(const File& png, std::string_view type) {
    for (std::size_t at = 8; at < png.size(); at += be32(png, at) + 12)
        if (std::string_view(reinterpret_cast<const char*>(&png[at + 4]), 4) == type)
            return {png.begin() + std::ptrdiff_t(at + 8),
                    png.begin() + std::ptrdiff_t(at + 8 + be32(png, at))};
    return bytes_of("no such chunk");
}

// ---- PNG ----

TEST(Description, OfAPngComesBack) {
    const std::vector<Description> all{
        {},
        {.icc = File(300, std::byte{7}), .resolution = Resolution{4000, 5000}},
        {.srgb_intent = std::uint8_t{0}},
        {.srgb_intent = std::uint8_t{3}, .gamma = 45455, .chromaticities = of_srgb},
        {.gamma = 100000},
        {.gamma = 55556, .chromaticities = p3, .aspect = Resolution{2, 1}},
        {.icc = File(99, std::byte{1}), .cicp = std::array<std::uint8_t, 4>{9, 16, 0, 1}, .exif = exif},
        {.cicp = std::array<std::uint8_t, 4>{12, 13, 0, 1}, .resolution = Resolution{1, 2147483647}},
        {.aspect = Resolution{1, 1}}};
    for (const Description& description : all)
        for (const bool deep : {false, true}) {
            Image image = described(description);
            if (deep) image.rgba = std::vector<std::uint16_t>(48, 4567);
            const Image back = decode(encode(image, "png"));
            EXPECT_EQ(back.description, description);
            EXPECT_EQ(back.rgba, image.rgba) << "described, not converted";
            EXPECT_EQ(encode(back, "png"), encode(image, "png"));
        }
}

TEST(Description, OfAPngStandsInTheOrderOfTheSpecification) {
    Description all{.icc = File(300, std::byte{7}),
                    .cicp = std::array<std::uint8_t, 4>{12, 13, 0, 1},
                    .srgb_intent = std::uint8_t{1},
                    .gamma = 45455,
                    .chromaticities = p3,
                    .resolution = Resolution{1, 2},
                    .aspect = Resolution{3, 4},
                    .exif = exif,
                    .offset = std::array<std::int32_t, 2>{-7, 300}};
    EXPECT_EQ(chunk_types(encode(described(all), "png")),
              "IHDR cICP iCCP gAMA cHRM pHYs eXIf oFFs IDAT IEND ");
    all.icc.clear();
    const File file = encode(described(all), "png");
    EXPECT_EQ(chunk_types(file), "IHDR cICP sRGB gAMA cHRM pHYs eXIf oFFs IDAT IEND ");
    EXPECT_EQ(chunk_data(file, "cICP"), bytes({12, 13, 0, 1}));
    EXPECT_EQ(chunk_data(file, "sRGB"), bytes({1}));
    EXPECT_EQ(chunk_data(file, "gAMA"), be(4, 45455));
    EXPECT_EQ(chunk_data(file, "cHRM"), join({be(4, 31270), be(4, 32900), be(4, 68000), be(4, 32000),
                                              be(4, 26500), be(4, 69000), be(4, 15000), be(4, 6000)}));
    EXPECT_EQ(chunk_data(file, "pHYs"), join({be(4, 1), be(4, 2), bytes({1})}));
    EXPECT_EQ(chunk_data(file, "eXIf"), exif);
    EXPECT_EQ(chunk_data(file, "oFFs"), join({be(4, 0xFFFFFFF9), be(4, 300), bytes({0})}));
    EXPECT_EQ(decode(file).description.offset, std::nullopt) << "where it lay is not where it lies now";
    EXPECT_EQ(chunk_types(encode(small_picture(), "png")), "IHDR IDAT IEND ");
    EXPECT_EQ(chunk_types(encode(described({.icc = File(9), .resolution = Resolution{1, 1}}), "png")),
              "IHDR iCCP pHYs IDAT IEND ");
}

TEST(Description, SizesThatCannotBeMeantAreNotWritten) {
    for (const Resolution& bad : {Resolution{0, 1}, Resolution{1, 1u << 31}}) {
        EXPECT_EQ(chunk_types(encode(described({.resolution = bad}), "png")), "IHDR IDAT IEND ");
        EXPECT_EQ(chunk_types(encode(described({.aspect = bad}), "png")), "IHDR IDAT IEND ");
    }
}

// ---- JPEG ----

TEST(Description, OfAPixelsAspectGoesThroughJpeg) {
    const auto through = [](const Resolution& aspect) {
        return decode(encode(described({.aspect = aspect}), "jpeg")).description;
    };
    EXPECT_EQ(through({2, 1}).aspect, (Resolution{2, 1}));
    EXPECT_EQ(through({2000000, 1000000}).aspect, (Resolution{2, 1}));
    EXPECT_EQ(through({59, 54}).aspect, (Resolution{59, 54}));
    EXPECT_EQ(through({1000003, 500009}).aspect, (Resolution{65535, 32768})) << "the nearest that fits";
    EXPECT_EQ(through({2147483647, 1}).aspect, (Resolution{65535, 1}));
    EXPECT_EQ(through({2, 1}).resolution, std::nullopt);
    EXPECT_EQ(encode(described({.aspect = Resolution{5, 5}}), "jpeg"), encode(small_picture(), "jpeg"));
    EXPECT_EQ(decode(encode(small_picture(), "jpeg")).description, Description{}) << "1:1 says nothing";
}

TEST(Description, OfColoursIsAProfileInAJpeg) {
    const Description linear{.gamma = 100000, .chromaticities = p3};
    const Image back = decode(encode(described(linear), "jpeg"));
    EXPECT_EQ(back.description.icc, profile_of(linear));
    EXPECT_FALSE(back.description.icc.empty());
    EXPECT_TRUE(decode(encode(described({.srgb_intent = std::uint8_t{0}}), "jpeg")).description.icc.empty());
}

// ---- profiles ----

/// White and primaries as H.273 has them, and the light of a signal.
struct Colours {
    std::array<double, 8> xy;
    std::function<double(double)> light;
};

/// Their XYZ relative to D50, by the textbook: primaries scaled to the white, Bradford's adaptation.
Xyz xyz_of(const Colours& colours, const std::array<double, 3>& rgb) {
    const auto xyz = [&](std::size_t i) {
        const double x = colours.xy[i], y = colours.xy[i + 1];
        return Eigen::Vector3d(x / y, 1, (1 - x - y) / y);
    };
    Eigen::Matrix3d primaries, bradford;
    primaries << xyz(2), xyz(4), xyz(6);
    bradford << 0.8951, 0.2664, -0.1614, -0.7502, 1.7135, 0.0367, 0.0389, -0.0685, 1.0296;
    const Eigen::Vector3d white = xyz(0), d50(0.9642, 1, 0.8249);
    const Eigen::Matrix3d to_xyz = primaries * (primaries.inverse() * white).asDiagonal();
    const Eigen::Vector3d scale = (bradford * d50).cwiseQuotient(bradford * white);
    const Eigen::Vector3d light(colours.light(rgb[0]), colours.light(rgb[1]), colours.light(rgb[2]));
    const Eigen::Vector3d out = bradford.inverse() * scale.asDiagonal() * bradford * to_xyz * light;
    return {out[0], out[1], out[2]};
}

void expect_profile(const Description& description, const Colours& colours, const std::string& what) {
    const File icc = profile_of(description);
    ASSERT_FALSE(icc.empty()) << what;
    for (const std::array<double, 3>& rgb :
         {std::array{1.0, 1.0, 1.0}, std::array{0.5, 0.5, 0.5}, std::array{1.0, 0.0, 0.0},
          std::array{0.0, 1.0, 0.0}, std::array{0.0, 0.0, 1.0}, std::array{0.2, 0.7, 0.9},
          std::array{0.03, 0.05, 0.01}}) {
        const Xyz expected = xyz_of(colours, rgb), found = xyz_of_profile(icc, rgb);
        // ICC's numbers have 16 bits behind the point, its curves 16 bits.
        for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(found[i], expected[i], 2e-4) << what << " " << i;
    }
}

double power(double v, double gamma) { return std::pow(v, gamma); }
double light_709(double v) { return v < 0.081 ? v / 4.5 : power((v + 0.099) / 1.099, 1 / 0.45); }
double light_srgb(double v) { return v <= 0.04045 ? v / 12.92 : power((v + 0.055) / 1.055, 2.4); }
double light_pq(double v) {
    const double e = power(v, 32.0 / 2523), c1 = 107.0 / 128, c2 = 2413.0 / 128, c3 = 2392.0 / 128;
    return power(std::max(e - c1, 0.0) / (c2 - c3 * e), 8192.0 / 1305);
}
double light_hlg(double v) {
    const double a = 0.17883277, b = 1 - 4 * a, c = 0.5 - a * std::log(4 * a);
    return v <= 0.5 ? v * v / 3 : (std::exp((v - c) / a) + b) / 12;
}

TEST(Description, CicpIsAProfileThatSaysTheSame) {
    const std::vector<std::pair<int, std::array<double, 8>>> primaries{
        {1, {.3127, .329, .64, .33, .30, .60, .15, .06}},
        {4, {.310, .316, .67, .33, .21, .71, .14, .08}},
        {5, {.3127, .329, .64, .33, .29, .60, .15, .06}},
        {6, {.3127, .329, .63, .34, .31, .595, .155, .07}},
        {9, {.3127, .329, .708, .292, .17, .797, .131, .046}},
        {11, {.314, .351, .68, .32, .265, .69, .15, .06}},
        {12, {.3127, .329, .68, .32, .265, .69, .15, .06}},
        {22, {.3127, .329, .63, .34, .295, .605, .155, .077}}};
    const std::vector<std::pair<int, std::function<double(double)>>> transfers{
        {1, light_709},
        {6, light_709},
        {14, light_709},
        {15, light_709},
        {4, [](double v) { return power(v, 2.2); }},
        {5, [](double v) { return power(v, 2.8); }},
        {8, [](double v) { return v; }},
        {13, light_srgb},
        {16, light_pq},
        {18, light_hlg}};
    for (const auto& [code, xy] : primaries)
        for (const auto& [transfer, light] : transfers) {
            if (code == 1 && transfer == 13) continue;  // sRGB
            const Description said{.cicp = std::array{std::uint8_t(code), std::uint8_t(transfer),
                                                      std::uint8_t{0}, std::uint8_t{1}}};
            expect_profile(said, {xy, light}, std::to_string(code) + "/" + std::to_string(transfer));
        }
}

TEST(Description, GammaAndChromaticitiesAreAProfileThatSaysTheSame) {
    const std::array<double, 8> xy{.3127, .329, .68, .32, .265, .69, .15, .06},
        srgb{.3127, .329, .64, .33, .30, .60, .15, .06};
    expect_profile({.gamma = 100000, .chromaticities = p3}, {xy, [](double v) { return v; }}, "linear");
    expect_profile({.gamma = 45455, .chromaticities = of_srgb},
                   {srgb, [](double v) { return power(v, 100000.0 / 45455); }}, "nearly sRGB, not quite");
    expect_profile({.gamma = 55556}, {srgb, [](double v) { return power(v, 100000.0 / 55556); }}, "1.8");
}

TEST(Description, TheFirstOfCicpProfileSrgbAndGammaIsMeant) {
    const File icc(200, std::byte{3});
    Description said{.icc = icc,
                     .cicp = std::array<std::uint8_t, 4>{12, 13, 0, 1},
                     .srgb_intent = std::uint8_t{0},
                     .gamma = 100000};
    EXPECT_EQ(profile_of(said), profile_of({.cicp = said.cicp}));
    said.cicp = std::array<std::uint8_t, 4>{1, 13, 0, 1};
    EXPECT_TRUE(profile_of(said).empty()) << "exactly sRGB";
    said.cicp = std::array<std::uint8_t, 4>{2, 2, 0, 1};
    EXPECT_EQ(profile_of(said), icc) << "unspecified";
    said.cicp.reset();
    EXPECT_EQ(profile_of(said), icc);
    said.icc.clear();
    EXPECT_TRUE(profile_of(said).empty());
    said.srgb_intent.reset();
    EXPECT_FALSE(profile_of(said).empty());
    EXPECT_TRUE(profile_of({}).empty());
    EXPECT_TRUE(profile_of({.chromaticities = p3}).empty()) << "of no gamma";
    for (const std::array<std::uint8_t, 4> unknown : {std::array<std::uint8_t, 4>{3, 1, 0, 1},
                                                      {1, 3, 0, 1},
                                                      {1, 8, 1, 1},
                                                      {1, 8, 0, 0},
                                                      {255, 255, 0, 1}})
        EXPECT_TRUE(profile_of({.cicp = unknown}).empty());
    // Chromaticities that span no colours.
    EXPECT_TRUE(
        profile_of({.gamma = 100000, .chromaticities = Chromaticities{1, 1, 1, 1, 1, 1, 1, 1}}).empty());
}

TEST(Description, ProfilesAreTheSameEachTime) {
    const Description said{.cicp = std::array<std::uint8_t, 4>{9, 18, 0, 1}};
    EXPECT_EQ(profile_of(said), profile_of(said));
    EXPECT_EQ(rgb_profile(grey_profile(1.8)), rgb_profile(grey_profile(1.8)));
}

// ---- grey ----

File grey_png(const File& icc) {
    return join({png_signature, png_header(2, 1, 8, 0),
                 png_chunk("iCCP", join({bytes({'g', 0, 0}), deflated(icc)})),
                 png_chunk("IDAT", deflated(bytes({0, 50, 200}))), png_chunk("IEND", {})});
}

/// Equal samples are grey, of the lightness that the grey profile gives them.
void expect_grey(const File& icc, const std::function<double(double)>& light) {
    for (const double v : {0.0, 0.1, 0.5, 0.9, 1.0}) {
        const Xyz found = xyz_of_profile(icc, {v, v, v});
        EXPECT_NEAR(found[0], 0.9642 * light(v), 3e-4) << v;
        EXPECT_NEAR(found[1], light(v), 3e-4) << v;
        EXPECT_NEAR(found[2], 0.8249 * light(v), 3e-4) << v;
    }
}

TEST(Description, AGreyProfileBecomesOneForRgb) {
    const auto gamma = [](double v) { return power(v, 1.8); };
    const Image image = decode(grey_png(grey_profile(1.8)));
    EXPECT_EQ(pixels(image), (std::vector<Rgba>{{50, 50, 50, 255}, {200, 200, 200, 255}}));
    expect_grey(image.description.icc, gamma);
    const Image back = decode(encode(image, "png"));
    EXPECT_EQ(back.description.icc, image.description.icc);
    const auto lightness = [](double v) { return xyz_of_lab({100 * v, 0, 0})[1]; };
    expect_grey(decode(grey_png(grey_profile(1, true))).description.icc, lightness);
    EXPECT_TRUE(decode(grey_png(inks_profile())).description.icc.empty()) << "of inks";
}

}  // namespace
}  // namespace probewarp
