// Picture files in and out: each format's kinds come out right, what is written comes back, and what is cut,
// bad or hostile is refused with a sentence, quickly.
#include "io/image_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include "image_checks.h"
#include "io/file.h"
#include "temporary_folder.h"

namespace probewarp {
namespace {

using namespace testing;
using ::testing::HasSubstr;
using ::testing::StartsWith;

/// 8 or 16 bits: every pixel another, with colour under zero alpha, unless it is to be opaque.
template <class Sample>
Image sample_image(bool opaque, int width = 13, int height = 7) {
    constexpr int full = std::numeric_limits<Sample>::max();
    std::vector<Sample> rgba;
    for (int i = 0; i < width * height; ++i)
        for (const int v : {i * 997, i * 3001 + 7, full - i * 499,
                            opaque       ? full
                            : i % 3 == 0 ? 0
                                         : full - i * 251})
            rgba.push_back(Sample(v));
    Image image{width, height, std::move(rgba), {}, {}};
    for (int i = 0; i < 300; ++i) image.description.icc.push_back(std::byte(i * i % 251));
    image.description.resolution = Resolution{2835, 11800};
    return image;
}

std::vector<Rgba> rounded_to_8_bits(std::vector<Rgba> all) {
    for (Rgba& p : all)
        for (int& v : p) v = (v * 255 + 32767) / 65535;
    return all;
}

// ---- the table ----

TEST(ImageFile, FormatsAreFoundByNameAndByEnding) {
    EXPECT_EQ(find_image_format("tiff"), nullptr);
    EXPECT_EQ(image_format_of("a.b/c"), nullptr);
    EXPECT_EQ(image_format_of("folder.png/A.JPeG"), find_image_format("jpeg"));
    for (const ImageFormat& format : image_formats()) {
        EXPECT_EQ(find_image_format(format.name), &format);
        ASSERT_FALSE(format.extensions.empty());
        for (const auto ending : format.extensions)
            EXPECT_EQ(image_format_of(std::string("x").append(ending)), &format);
    }
}

TEST(ImageFile, TheContentDecidesExceptForTga) {
    const Image image = sample_image<std::uint8_t>(true);
    const Picture picture = decode_picture(encode(image, "bmp"), "folder/not really.png");
    EXPECT_EQ(picture.format, "bmp");
    EXPECT_EQ(picture.name, "not really.png");
    EXPECT_EQ(picture.original, encode(image, "bmp"));
    EXPECT_EQ(decode_picture(encode(image, "tga"), "x.TGA").format, "tga");
    EXPECT_EQ(decode_picture(encode(image, "png"), "x.tga").format, "png");
    EXPECT_EQ(error_of(bytes_of("just text"), "x.dat"),
              "x.dat: is not a picture that can be read; expected PNG, JPEG, BMP, TGA, GIF, PSD or PNM");
    EXPECT_THAT(error_of(bytes_of("just text"), "bad\nname\x1b"), StartsWith("bad?name?: is not a picture"));
}

TEST(ImageFile, ReadsFromAFile) {
    const TemporaryFolder folder;
    const Image image = sample_image<std::uint8_t>(false);
    write_file(folder.path / "a.png", encode(image, "png"));
    const Picture picture = read_picture(folder.path / "a.png");
    EXPECT_EQ(picture.name, "a.png");
    EXPECT_EQ(pixels(picture.image), pixels(image));
    EXPECT_THROW(read_picture(folder.path), Error);
    EXPECT_THROW(read_picture("/dev/zero"), Error);
    ASSERT_EQ(::mkfifo((folder.path / "fifo").c_str(), 0600), 0);
    EXPECT_THROW(read_picture(folder.path / "fifo"), Error);
}

TEST(ImageFile, SizesAreCheckedAtTheirLimits) {
    EXPECT_NO_THROW(check_image_size(32768, 1, 8));
    EXPECT_THROW(check_image_size(32769, 1, 8), Error);
    EXPECT_NO_THROW(check_image_size(12288, 8192, 8));  // 384 MiB
    EXPECT_THROW(check_image_size(12288, 8193, 8), Error);
    EXPECT_NO_THROW(check_image_size(6144, 8192, 16));
    EXPECT_THROW(check_image_size(12288, 8192, 16), Error);
    for (const long long bad : {0LL, -1LL, 1LL << 62}) {
        EXPECT_THROW(check_image_size(bad, 1, 8), Error);
        EXPECT_THROW(check_image_size(1, bad, 8), Error);
    }
}

// ---- round trips ----

TEST(ImageFile, PngKeepsEverything) {
    for (const bool opaque : {true, false})
        for (const Image& image : {sample_image<std::uint8_t>(opaque), sample_image<std::uint16_t>(opaque)}) {
            const File file = encode(image, "png");
            const Image back = decode(file);
            EXPECT_EQ(back.bits(), image.bits());
            EXPECT_EQ(pixels(back), pixels(image));
            EXPECT_EQ(back.description.icc, image.description.icc);
            EXPECT_EQ(back.description.resolution, image.description.resolution);
            EXPECT_EQ(std::to_integer<int>(file[25]), opaque ? 2 : 6) << "colour type";
            EXPECT_EQ(encode(image, "png"), file);
        }
    Image plain = sample_image<std::uint8_t>(true);
    plain.description.icc.clear();
    plain.description.resolution.reset();
    EXPECT_TRUE(decode(encode(plain, "png")).description.icc.empty());
    EXPECT_EQ(decode(encode(plain, "png")).description.resolution, std::nullopt);
    for (const std::uint32_t beyond : {0u, 1u << 31}) {
        plain.description.resolution = Resolution{beyond, 1};
        EXPECT_EQ(decode(encode(plain, "png")).description.resolution, std::nullopt);
        EXPECT_EQ(decode(encode(plain, "bmp")).description.resolution, std::nullopt);
    }
}

TEST(ImageFile, BmpAndTgaKeepThePixelsInEightBits) {
    for (const char* format : {"bmp", "tga"})
        for (const bool opaque : {true, false}) {
            const Image image = sample_image<std::uint8_t>(opaque),
                        deep = sample_image<std::uint16_t>(opaque);
            const Image back = decode(encode(image, format), "x.tga");
            EXPECT_EQ(pixels(back), pixels(image));
            EXPECT_EQ(back.description.resolution,
                      format == std::string("bmp") ? image.description.resolution : std::nullopt);
            EXPECT_EQ(pixels(decode(encode(deep, format), "x.tga")), rounded_to_8_bits(pixels(deep)));
            EXPECT_EQ(encode(image, format), encode(image, format));
        }
}

TEST(ImageFile, TgaRunsComeBack) {  // its writer packs runs of equal pixels
    Image image = sample_image<std::uint8_t>(true, 300, 3);
    image.description = {};  // nothing to be appended
    auto& rgba = std::get<0>(image.rgba);
    for (std::size_t i = 0; i < rgba.size(); ++i)
        rgba[i] = i % 4 == 3 ? 255 : std::uint8_t(i / 4 % 300 / 140 * 80 + i % 2);
    const File file = encode(image, "tga");
    EXPECT_LT(file.size(), 200u);
    EXPECT_EQ(pixels(decode(file, "x.tga")), pixels(image));
}

TEST(ImageFile, JpegLiesOnTheBackgroundAndKeepsProfileAndResolution) {
    const EncodeOptions options{{250, 10, 100}, 100};
    Image image = sample_image<std::uint8_t>(false, 16, 16);
    // One grey on a grey background: at quality 100 nothing of it is lost, so that the rounding shows.
    for (const int grey : {0, 1, 100, 255})
        for (const int alpha : {0, 1, 127, 128, 254, 255}) {
            const Rgba over{(grey * alpha + 77 * (255 - alpha) + 127) / 255};
            for (const int scale : {1, 257}) {
                std::vector<std::uint8_t> flat(1024);
                std::vector<std::uint16_t> deep(1024);
                for (std::size_t i = 0; i < 1024; ++i)
                    flat[i] = std::uint8_t(i % 4 == 3 ? alpha : grey), deep[i] = std::uint16_t(flat[i] * 257);
                if (scale == 1)
                    image.rgba = flat;
                else
                    image.rgba = deep;
                const Image back = decode(encode(image, "jpeg", {{77, 77, 77}, 100}));
                EXPECT_EQ(pixel(back, 3, 3), (Rgba{over[0], over[0], over[0], 255})) << grey << " " << alpha;
            }
        }
    image.rgba = std::vector<std::uint8_t>(1024);  // nothing but background
    const Image back = decode(encode(image, "jpeg", options));
    for (std::size_t c = 0; c < 3; ++c)
        EXPECT_NEAR(pixel(back, 5, 5)[c], (Rgba{250, 10, 100}[c]), 2);  // YCbCr rounds
    EXPECT_EQ(back.description.icc, image.description.icc);
    EXPECT_EQ(back.description.resolution, (Resolution{2835, 11811}));  // 72 and 300 dots per inch
    image.description.resolution = Resolution{4300, 65535 * 100};
    EXPECT_EQ(decode(encode(image, "jpeg")).description.resolution, image.description.resolution)
        << "exact in dots per centimetre";
    image.description.resolution = Resolution{100, 2'000'000'000};
    EXPECT_EQ(decode(encode(image, "jpeg")).description.resolution, std::nullopt)
        << "beyond what JFIF can say";
    EXPECT_LT(encode(sample_image<std::uint8_t>(true), "jpeg", {{}, 10}).size(),
              encode(sample_image<std::uint8_t>(true), "jpeg", {{}, 95}).size());
}

TEST(ImageFile, JpegFindsTheOneClearPixelOfARow) {
    for (const std::size_t clear : {0u, 7u, 15u}) {
        Image image = sample_image<std::uint8_t>(true, 16, 16);
        std::vector<std::uint8_t> rgba(1024, 200);
        for (std::size_t i = 3; i < rgba.size(); i += 4) rgba[i] = 255;
        rgba[(5 * 16 + clear) * 4 + 3] = 0;
        image.rgba = rgba;
        const Image back = decode(encode(image, "jpeg", {{60, 60, 60}, 100}));
        // At quality 100 the coefficients round by at most a half each: 2 grey levels at a pixel.
        for (int x = 0; x < 16; ++x)
            for (const int y : {4, 5, 6})
                EXPECT_NEAR(pixel(back, x, y)[0], y == 5 && x == int(clear) ? 60 : 200, 2) << x << ", " << y;
    }
}

TEST(ImageFile, JpegHasItsColoursAtFullSize) {
    Image image = sample_image<std::uint8_t>(true, 16, 16);
    for (std::size_t i = 0; i < 1024; ++i)  // red and blue columns, one pixel wide
        std::get<0>(image.rgba)[i] = i % 4 == 3 || (i / 4 % 2 == 0 ? i % 4 == 0 : i % 4 == 2) ? 255 : 0;
    const Image back = decode(encode(image, "jpeg", {{}, 100}));
    EXPECT_GT(pixel(back, 8, 8)[0], 245);
    EXPECT_LT(pixel(back, 9, 8)[0], 10);
}

// ---- PNG ----

/// 5 x 3 of that kind with every sample another, and what it means in RGBA.
std::pair<PngSpec, std::vector<Rgba>> png_kind(int type, int depth, bool interlaced, bool transparent) {
    PngSpec spec{5, 3, depth, type, interlaced, {}, {}, {}, transparent};
    const std::size_t channels = type == 2 ? 3 : type == 4 ? 2 : type == 6 ? 4 : 1;
    const int full = (1 << depth) - 1, out_full = depth == 16 ? 65535 : 255;
    for (std::size_t i = 0; i < 15 * channels; ++i)
        spec.samples.push_back(std::uint16_t(i * 4877 % (unsigned(full) + 1)));
    spec.transparency.gray = spec.transparency.red = spec.samples[0];
    spec.transparency.green = spec.samples[1];
    spec.transparency.blue = spec.samples[2];
    if (type == 3) {
        spec.palette.n_entries = unsigned(full) + 1;
        spec.transparency.n_type3_entries = 2;
        spec.transparency.type3_alpha[0] = 9;
        spec.transparency.type3_alpha[1] = 100;
        for (int i = 0; i <= full; ++i)
            spec.palette.entries[i] = {std::uint8_t(i), std::uint8_t(255 - i), std::uint8_t(i * 3), 0};
    }
    std::vector<Rgba> meaning;
    for (std::size_t i = 0; i < spec.samples.size(); i += channels) {
        const auto s = [&](std::size_t c) {
            return int(spec.samples[i + c] * std::int64_t{out_full} / full);
        };
        const bool keyed = transparent && type < 3 &&
                           std::equal(&spec.samples[i], &spec.samples[i] + channels, spec.samples.data());
        if (type == 3) {
            const int v = spec.samples[i];
            meaning.push_back({v, 255 - v, v * 3 & 255, !transparent || v > 1 ? 255 : v == 0 ? 9 : 100});
        } else if (type == 0 || type == 4) {
            meaning.push_back({s(0), s(0), s(0), type == 4 ? s(1) : keyed ? 0 : out_full});
        } else {
            meaning.push_back({s(0), s(1), s(2), type == 6 ? s(3) : keyed ? 0 : out_full});
        }
    }
    return {spec, meaning};
}

TEST(ImageFile, PngOfEveryKind) {
    const std::vector<std::pair<int, std::vector<int>>> kinds{
        {0, {1, 2, 4, 8, 16}}, {2, {8, 16}}, {3, {1, 2, 4, 8}}, {4, {8, 16}}, {6, {8, 16}}};
    for (const auto& [type, depths] : kinds)
        for (const int depth : depths)
            for (const bool interlaced : {false, true})
                for (const bool transparent : {false, true}) {
                    if (transparent && type > 3) continue;
                    SCOPED_TRACE(std::to_string(type) + " " + std::to_string(depth) +
                                 (interlaced ? " i" : "") + (transparent ? " t" : ""));
                    const auto [spec, meaning] = png_kind(type, depth, interlaced, transparent);
                    const Image image = decode(make_png(spec));
                    EXPECT_EQ(image.bits(), depth == 16 ? 16 : 8);
                    EXPECT_EQ(pixels(image), meaning);
                }
}

TEST(ImageFile, LargeInterlacedPng) {  // takes a way of its own through the reader
    PngSpec spec{2100, 2000, 8, 0, true, {}, {}, {}, false};
    for (std::size_t i = 0; i < 2100 * 2000; ++i) spec.samples.push_back(std::uint16_t(i % 251));
    const File file = make_png(spec);
    EXPECT_EQ(pixel(decode(file), 2099, 1999)[1], (2100 * 2000 - 1) % 251);
}

File small_png(const File& extra, const File& idat) {
    return join(
        {png_signature, png_header(2, 2, 8, 0), extra, png_chunk("IDAT", idat), png_chunk("IEND", {})});
}

TEST(ImageFile, PngBombsAndLies) {
    const File idat = deflated(bytes({0, 1, 2, 0, 3, 4}));
    ASSERT_EQ(error_of(small_png({}, idat), "a.png"), "");
    const auto of_size = [&](std::uint32_t w, std::uint32_t h) {
        return join({png_signature, png_header(w, h, 8, 6), png_chunk("IDAT", idat), png_chunk("IEND", {})});
    };
    expect_refused(of_size(10000, 10000), "a.png", "too little data for 10000 x 10000 pixels");
    expect_refused(of_size(100000, 1), "a.png", "is 100000 x 1 pixels; expected 1 to 32768 pixels a side");
    expect_refused(of_size(32768, 32768), "a.png", "at most 100 million pixels");
    expect_refused(of_size(0, 1), "a.png", "is 0 x 1 pixels");

    const File bomb = deflate_bomb(1024);
    expect_refused(small_png({}, bomb), "a.png", "more data than its pixels need");
    const long long before = peak_memory();
    for (const char* type : {"iCCP", "zTXt"}) {
        const File file = small_png(png_chunk(type, join({bytes_of("x"), bytes({0, 0}), bomb})), idat);
        EXPECT_EQ(pixels(decode(file)).size(), 4u) << "left out: " << type;
        EXPECT_TRUE(decode(file).description.icc.empty());
    }
    EXPECT_LT(peak_memory() - before, 64 << 20) << "a gibibyte was not unpacked";
    expect_refused(small_png({}, deflated(bytes({0, 1, 2, 0, 3}))), "a.png",
                   "is damaged (IDAT stream too short)");
    expect_refused(small_png(png_chunk("ABCD", {}), idat), "a.png", "is damaged");
}

TEST(ImageFile, PngWithAnyBitOfItsPixelsFlippedIsRefused) {
    Image image = sample_image<std::uint8_t>(false);
    const File file = encode(image, "png");
    for (std::size_t i = 8; i < file.size(); ++i) {
        File bad = file;
        bad[i] ^= std::byte{4};
        try {  // an ancillary chunk's name may become another one's, which is not read
            EXPECT_EQ(pixels(decode(bad)), pixels(image)) << i;
        } catch (const Error&) {
        }
    }
}

TEST(ImageFile, AProfileForGreyIsNotKept) {
    Image image = sample_image<std::uint8_t>(true);
    image.description.icc = join({File(16), bytes_of("GRAY"), File(100)});
    EXPECT_TRUE(decode(encode(image, "png")).description.icc.empty());
    EXPECT_TRUE(decode(encode(image, "jpeg")).description.icc.empty());
}

// ---- JPEG ----

/// Six greys, "abc" above "def", 8 x 8 pixels each.
File six_greys(const std::function<void(jpeg_compress_struct&)>& adjust = {}) {
    std::vector<std::uint8_t> samples;
    for (int y = 0; y < 16; ++y)
        for (int x = 0; x < 24; ++x) samples.push_back(std::uint8_t(40 + 30 * (y / 8 * 3 + x / 8)));
    return make_jpeg(24, 16, 1, JCS_GRAYSCALE, samples, adjust);
}

/// The letters of the 8 x 8 blocks, rows parted by '/'.
std::string letters(const Image& image) {
    std::string text;
    for (int y = 4; y < image.height; y += 8) {
        if (y > 4) text += '/';
        for (int x = 4; x < image.width; x += 8) text += char('a' + (pixel(image, x, y)[0] - 40 + 15) / 30);
    }
    return text;
}

TEST(ImageFile, JpegIsTurnedUpright) {
    const char* upright[] = {"abc/def",  "abc/def",  "cba/fed",  "fed/cba",  "def/abc",
                             "ad/be/cf", "da/eb/fc", "fc/eb/da", "cf/be/ad", "abc/def"};
    const File file = six_greys([](jpeg_compress_struct& jpeg) {
        jpeg.density_unit = 2;
        jpeg.X_density = 10;
        jpeg.Y_density = 20;
    });
    for (int orientation = 0; orientation < 10; ++orientation) {
        const Image image = decode(with_marker(file, exif_marker(orientation)));
        EXPECT_EQ(letters(image), upright[orientation]) << orientation;
        const bool swapped = orientation >= 5 && orientation <= 8;
        EXPECT_EQ(image.description.resolution, (swapped ? Resolution{2000, 1000} : Resolution{1000, 2000}))
            << orientation;
    }
}

TEST(ImageFile, JpegTakesItsResolutionFromJfifElseFromExif) {
    const auto dots = [](jpeg_compress_struct& jpeg) {
        jpeg.density_unit = 1, jpeg.X_density = jpeg.Y_density = 72;
    };
    EXPECT_EQ(decode(six_greys()).description.resolution, std::nullopt);
    EXPECT_EQ(decode(with_marker(six_greys(), exif_marker(1, 50))).description.resolution,
              (Resolution{5000, 5000}));
    EXPECT_EQ(decode(with_marker(six_greys(dots), exif_marker(1, 50))).description.resolution,
              (Resolution{2835, 2835}));
    EXPECT_EQ(letters(decode(
                  with_marker(six_greys(), bytes({0xFF, 0xE1, 0, 10, 'E', 'x', 'i', 'f', 0, 0, 'I', 'I'})))),
              "abc/def");
}

TEST(ImageFile, JpegOfEveryKind) {
    EXPECT_EQ(letters(decode(six_greys([](jpeg_compress_struct& j) { j.arith_code = TRUE; }))), "abc/def");
    EXPECT_EQ(letters(decode(six_greys([](jpeg_compress_struct& j) { jpeg_simple_progression(&j); }))),
              "abc/def");
    const auto one_colour = [](J_COLOR_SPACE space, std::vector<std::uint8_t> colour, auto... adjust) {
        std::vector<std::uint8_t> samples;
        for (int i = 0; i < 64; ++i) samples.insert(samples.end(), colour.begin(), colour.end());
        return pixel(decode(make_jpeg(8, 8, int(colour.size()), space, samples, adjust...)), 4, 4);
    };
    const auto near = [](Rgba a, Rgba b) {  // 2: the rounding of YCbCr
        for (std::size_t c = 0; c < 4; ++c) EXPECT_NEAR(a[c], b[c], 2);
    };
    near(one_colour(JCS_RGB, {200, 30, 60}), {200, 30, 60, 255});
    near(
        one_colour(JCS_RGB, {200, 30, 60}, [](jpeg_compress_struct& j) { jpeg_set_colorspace(&j, JCS_RGB); }),
        {200, 30, 60, 255});
    // Adobe's way: 255 is no ink.
    near(one_colour(JCS_CMYK, {200, 100, 50, 128}), {100, 50, 25, 255});
    near(one_colour(JCS_CMYK, {200, 100, 50, 128},
                    [](jpeg_compress_struct& j) { jpeg_set_colorspace(&j, JCS_YCCK); }),
         {100, 50, 25, 255});
    // So do other readers without its marker.
    near(one_colour(JCS_CMYK, {200, 100, 50, 128},
                    [](jpeg_compress_struct& j) { j.write_Adobe_marker = FALSE; }),
         {100, 50, 25, 255});
}

TEST(ImageFile, JpegWithMoreScansThanAnybodyNeedsIsRefused) {
    const auto with_scans = [](int count) {
        return six_greys([count](jpeg_compress_struct& jpeg) {
            static std::vector<jpeg_scan_info> scans;
            scans.assign(1, {1, {0}, 0, 0, 0, 0});
            for (int k = 1; k < 64; ++k)
                for (int bit = 1; bit >= 0 && int(scans.size()) < count; --bit)
                    scans.push_back({1, {0}, k, k, bit == 1 ? 0 : 1, bit});
            jpeg.scan_info = scans.data();
            jpeg.num_scans = int(scans.size());
        });
    };
    EXPECT_EQ(letters(decode(with_scans(64))), "abc/def");
    expect_refused(with_scans(65), "a.jpg", "far more scans than its size explains");
}

TEST(ImageFile, DamagedJpegIsRefused) {
    File bad = six_greys();
    bad[bad.size() - 10] = std::byte{0xFF};  // a marker amid the data
    bad[bad.size() - 9] = std::byte{0xD3};
    expect_refused(bad, "a.jpg", "is damaged");
    expect_refused(join({bytes({0xFF, 0xD8, 0xFF, 0xD9})}), "a.jpg", "is damaged");
}

}  // namespace
}  // namespace probewarp
