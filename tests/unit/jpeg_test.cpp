// JPEGs of unusual kinds that are sound, and what they say of their colours and their size.
#include <gtest/gtest.h>

#include <algorithm>

#include "image_checks.h"
#include "profiles.h"

namespace probewarp {
namespace {

using namespace testing;

/// A flat picture of 8 x 8 pixels.
File flat_jpeg(J_COLOR_SPACE space, const std::vector<int>& colour,
               const std::function<void(jpeg_compress_struct&)>& adjust = {}) {
    std::vector<std::uint8_t> samples;
    for (int i = 0; i < 64; ++i)
        for (const int v : colour) samples.push_back(std::uint8_t(v));
    return make_jpeg(8, 8, int(colour.size()), space, samples, adjust);
}

File rgb_jpeg(const std::function<void(jpeg_compress_struct&)>& adjust = {}) {
    return flat_jpeg(JCS_RGB, {200, 40, 60}, adjust);
}

/// 2 levels: the roundings of YCbCr and of the coefficients.
void expect_near(const Image& image, const std::array<double, 3>& colour) {
    for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(pixel(image, 4, 4)[c], colour[c], 2) << c;
    EXPECT_EQ(pixel(image, 4, 4)[3], 255);
}

// ---- profiles in their markers ----

File icc_marker(int part, int parts, const File& data) {
    return join({bytes({0xFF, 0xE2}), be(2, data.size() + 16), bytes_of("ICC_PROFILE"),
                 bytes({0, part, parts}), data});
}

TEST(Jpeg, AProfileWhosePartsDoNotFitIsLeftOut) {
    const File a(100, std::byte{1}), b(50, std::byte{2});
    const auto icc = [](const File& markers) {
        const File file = with_marker(rgb_jpeg(), markers);
        EXPECT_EQ(error_of(file, "a.jpg"), "");
        const Image image = decode(file);
        expect_near(image, {200, 40, 60});
        return image.description.icc;
    };
    EXPECT_EQ(icc(join({icc_marker(1, 2, a), icc_marker(2, 2, b)})), join({a, b}));
    EXPECT_EQ(icc(join({icc_marker(2, 2, b), icc_marker(1, 2, a)})), join({a, b})) << "in any order";
    EXPECT_TRUE(icc(icc_marker(1, 2, a)).empty()) << "one is missing";
    EXPECT_TRUE(icc(join({icc_marker(1, 2, a), icc_marker(1, 2, a), icc_marker(2, 2, b)})).empty())
        << "twice";
    EXPECT_TRUE(icc(join({icc_marker(1, 2, a), icc_marker(2, 3, b)})).empty()) << "of another number";
    EXPECT_TRUE(icc(icc_marker(0, 1, a)).empty()) << "of number 0";
    EXPECT_TRUE(icc(icc_marker(3, 2, a)).empty()) << "beyond the last";
    EXPECT_TRUE(icc(icc_marker(1, 1, {})).empty()) << "of no length";
    EXPECT_TRUE(icc(icc_marker(1, 0, a)).empty()) << "of none";
}

// ---- Adobe's marker ----

File with_adobe_transform(File file, int transform) {
    const File name = bytes_of("Adobe");
    const auto at = std::search(file.begin(), file.end(), name.begin(), name.end());
    EXPECT_NE(at, file.end());
    if (at != file.end()) at[11] = std::byte(transform);
    return file;
}

TEST(Jpeg, AdobesTransformsOfThreeComponents) {
    const auto adobe = [](jpeg_compress_struct& j) {
        j.write_JFIF_header = FALSE, j.write_Adobe_marker = TRUE;
    };
    const File file = rgb_jpeg(adobe);
    for (const int transform : {1, 2, 3, 255}) {
        EXPECT_EQ(error_of(with_adobe_transform(file, transform), "a.jpg"), "");
        expect_near(decode(with_adobe_transform(file, transform)), {200, 40, 60});
    }
    const File rgb = rgb_jpeg([&](jpeg_compress_struct& j) {
        jpeg_set_colorspace(&j, JCS_RGB);
        adobe(j);
    });
    expect_near(decode(with_adobe_transform(rgb, 0)), {200, 40, 60});
    const File ycck =
        flat_jpeg(JCS_CMYK, {200, 100, 50, 128}, [](auto& j) { jpeg_set_colorspace(&j, JCS_YCCK); });
    expect_near(decode(with_adobe_transform(ycck, 7)), {100, 50, 25});
}

// ---- printing inks ----

constexpr std::array<double, 4> ink{0.2, 0.4, 0.6, 0.1};

std::array<double, 3> colour_of_ink() { return srgb_of_xyz(xyz_of_lab(lab_of_inks(ink))); }

/// Full is no ink, with Adobe's marker as without, as other readers have it.
File inks_jpeg(bool adobe, const std::function<void(jpeg_compress_struct&)>& adjust = {}) {
    std::vector<int> samples;
    for (const double v : ink) samples.push_back(int(std::lround(255 * (1 - v))));
    return flat_jpeg(JCS_CMYK, samples, [&](jpeg_compress_struct& j) {
        j.write_Adobe_marker = adobe;
        if (adjust) adjust(j);
    });
}

TEST(Jpeg, InksAreConvertedThroughTheirProfile) {
    const File icc = icc_marker(1, 1, inks_profile());
    const auto ycck = [](jpeg_compress_struct& j) { jpeg_set_colorspace(&j, JCS_YCCK); };
    for (const File& file : {inks_jpeg(true), inks_jpeg(false), inks_jpeg(true, ycck)}) {
        const Image image = decode(with_marker(file, icc));
        expect_near(image, colour_of_ink());
        EXPECT_TRUE(image.description.icc.empty()) << "it is sRGB now";
        EXPECT_TRUE(image.opaque);
    }
}

TEST(Jpeg, InksWithoutAProfileOfTheirOwnAreConvertedPlainly) {
    const std::array<double, 3> plain{255 * 0.8 * 0.9, 255 * 0.6 * 0.9, 255 * 0.4 * 0.9};
    File cut = inks_profile();
    cut.resize(cut.size() / 2);
    for (const bool adobe : {true, false})
        for (const File& icc : {File{}, bytes_of("junk"), cut, grey_profile(2), File(500, std::byte{7})}) {
            const File file =
                icc.empty() ? inks_jpeg(adobe) : with_marker(inks_jpeg(adobe), icc_marker(1, 1, icc));
            const Image image = decode(file);
            expect_near(image, plain);
            EXPECT_TRUE(image.description.icc.empty());
        }
}

TEST(Jpeg, InksAreTurnedUprightToo) {
    std::vector<std::uint8_t> samples;
    for (int y = 0; y < 40; ++y)
        for (int x = 0; x < 16; ++x)
            for (const double v : ink)
                samples.push_back(y < 8 && x < 8 ? std::uint8_t(std::lround(255 * (1 - v))) : 255);
    const File file = make_jpeg(16, 40, 4, JCS_CMYK, samples, [](auto& j) { j.write_Adobe_marker = FALSE; });
    const Image image = decode(with_marker(file, join({exif_marker(6), icc_marker(1, 1, inks_profile())})));
    ASSERT_EQ(image.width, 40);
    const auto colour = colour_of_ink();
    for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(pixel(image, 36, 4)[c], colour[c], 2);
    const auto paper = srgb_of_xyz(xyz_of_lab(lab_of_inks({0, 0, 0, 0})));
    for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(pixel(image, 4, 4)[c], paper[c], 2);
}

TEST(Jpeg, AProfileOfInksIsNotForRgb) {
    EXPECT_TRUE(decode(with_marker(rgb_jpeg(), icc_marker(1, 1, inks_profile()))).description.icc.empty());
}

// ---- grey ----

TEST(Jpeg, AGreyProfileBecomesOneForRgb) {
    const File file = flat_jpeg(JCS_GRAYSCALE, {100});
    const Image image = decode(with_marker(file, icc_marker(1, 1, grey_profile(1.8))));
    EXPECT_EQ(pixel(image, 4, 4), (Rgba{100, 100, 100, 255}));
    const Xyz half = xyz_of_profile(image.description.icc, {0.5, 0.5, 0.5});
    EXPECT_NEAR(half[1], std::pow(0.5, 1.8), 3e-4);
    EXPECT_EQ(decode(encode(image, "jpeg")).description.icc, image.description.icc);
}

// ---- sizes ----

TEST(Jpeg, DensitiesOfEveryUnit) {
    const auto said = [](int unit, int x, int y) {
        return decode(rgb_jpeg([&](jpeg_compress_struct& j) {
                   j.density_unit = UINT8(unit), j.X_density = UINT16(x), j.Y_density = UINT16(y);
               }))
            .description;
    };
    EXPECT_EQ(said(1, 300, 150).resolution, (Resolution{11811, 5906}));
    EXPECT_EQ(said(2, 30, 15).resolution, (Resolution{3000, 1500}));
    EXPECT_EQ(said(0, 2, 1).aspect, (Resolution{2, 1}));
    EXPECT_EQ(said(0, 2, 1).resolution, std::nullopt);
    for (const Description& none :
         {said(0, 1, 1), said(0, 72, 72), said(1, 0, 72), said(0, 0, 1), said(3, 72, 72)})
        EXPECT_EQ(none, Description{});
}

TEST(Jpeg, ARatioGivesWayToExifsResolution) {
    const File file = rgb_jpeg([](jpeg_compress_struct& j) { j.X_density = 2, j.Y_density = 1; });
    EXPECT_EQ(decode(with_marker(file, exif_marker(6))).description.aspect, (Resolution{1, 2}))
        << "on its side";
    const Description said = decode(with_marker(file, exif_marker(1, 50))).description;
    EXPECT_EQ(said.resolution, (Resolution{5000, 5000}));
    EXPECT_EQ(said.aspect, std::nullopt);
}

// ---- what is passed over, and what is not read ----

TEST(Jpeg, BytesBetweenMarkersAreHarmless) {
    const File file = rgb_jpeg();
    for (const File& between : {bytes({0, 0, 0}), bytes({0xFF, 0xFF, 0xFF}), bytes({0xFF, 0xE5, 0, 2})})
        expect_near(
            decode(with_marker(File(file.begin(), file.end()), join({bytes({0xFF, 0xE5, 0, 2}), between}))),
            {200, 40, 60});
    expect_near(decode(join({file, bytes_of("garbage")})), {200, 40, 60});
}

TEST(Jpeg, UnusualKindsAreNamed) {
    File file = rgb_jpeg();
    const File frame = bytes({0xFF, 0xC0});
    const auto at =
        std::size_t(std::search(file.begin(), file.end(), frame.begin(), frame.end()) - file.begin());
    file[at + 4] = std::byte{12};
    expect_refused(file, "a.jpg", "is of an unusual kind (Unsupported JPEG data precision 12)");
    file[at + 4] = std::byte{8};
    file[at + 1] = std::byte{0xC3};
    expect_refused(file, "a.jpg", "is of an unusual kind (Unsupported JPEG process: SOF type 0xc3)");
}

TEST(Jpeg, MarkersWithoutEndAreRefused) {
    // libjpeg looks through all that it has kept for each one more.
    const File file = make_jpeg(8, 8, 1, JCS_GRAYSCALE, std::vector<std::uint8_t>(64, 9));
    const auto with = [&](int type, int count) {
        File markers;
        for (int i = 0; i < count; ++i) markers += bytes({0xFF, type, 0, 2});
        return with_marker(file, join({markers, exif_marker(1, 10)}));
    };
    for (const int type : {0xE1, 0xE2}) {
        const Image image = decode(with(type, 9'999));
        EXPECT_EQ(pixels(image), pixels(decode(file)));
        EXPECT_EQ(image.description.resolution, (Resolution{1000, 1000}));
        for (const bool salvage : {false, true})
            EXPECT_THROW(decode_picture(with(type, 10'000), "a.jpg", Pixels::whole, {.salvage = salvage}),
                         Error);
        expect_refused(with(type, 10'000), "a.jpg",
                       "a.jpg: has far more application markers than a picture needs; expected a usual JPEG");
    }
    EXPECT_EQ(pixels(decode(with(0xED, 50'000))), pixels(decode(file))) << "these are not kept";
}

}  // namespace
}  // namespace probewarp
