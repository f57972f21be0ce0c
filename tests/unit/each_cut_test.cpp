// Each cut of a file of every format: no beginning of a file passes for the whole.
#include <gtest/gtest.h>

#include <random>

#include "image_checks.h"

namespace probewarp {
namespace {

using namespace testing;

// Exceptions: a TGA's footer, whatever stands behind the codes of a GIF's first frame or a PNG's pixels, a
// plain bitmap's last line break.

const File red_green_blue = bytes({0, 0, 255, 0, 0, 255, 0, 0, 255, 0, 0, 0});  // a palette of three
const File transparent_red = bytes({0x21, 0xF9, 4, 1, 0, 0, 1, 0});
const Description described{.icc = File(50), .resolution = Resolution{1, 2}};

TEST(EachCut, OfPngIsRefused) {
    constexpr std::size_t behind_the_pixels = 12;  // IEND
    PngSpec spec{3, 3, 8, SPNG_COLOR_TYPE_INDEXED, true, {0, 1, 1, 0, 0, 1, 1, 0, 1}, {}, {}, true};
    spec.palette.n_entries = 2;
    spec.transparency.n_type3_entries = 1;
    expect_each_cut_refused(make_png(spec), "a.png", behind_the_pixels);
    Image image{4, 2, std::vector<std::uint16_t>(32, 999), described};
    expect_each_cut_refused(find_image_format("png")->encode(image, {}), "a.png", behind_the_pixels);
}

TEST(EachCut, OfJpegIsRefused) {
    std::vector<std::uint8_t> samples;
    for (int i = 0; i < 40 * 40 * 3; ++i) samples.push_back(std::uint8_t(i * i / 7));
    expect_each_cut_refused(make_jpeg(40, 40, 3, JCS_RGB, samples), "a.jpg");
    expect_each_cut_refused(
        make_jpeg(40, 40, 3, JCS_RGB, samples, [](auto& j) { jpeg_simple_progression(&j); }), "a.jpg");
    expect_each_cut_refused(make_jpeg(40, 40, 3, JCS_RGB, samples, [](auto& j) { j.restart_interval = 2; }),
                            "a.jpg");
    samples.resize(40 * 40);
    expect_each_cut_refused(with_marker(make_jpeg(40, 40, 1, JCS_GRAYSCALE, samples), exif_marker(6, 10)),
                            "a.jpg");
}

TEST(EachCut, OfJpegBeforeItsLastMarkerIsRefused) {
    // Whether the decoder looks at what follows the last pixels depends on how many bytes it took at a time.
    std::mt19937 random(1);
    for (int i = 0; i < 50; ++i) {
        std::vector<std::uint8_t> noise(64);
        for (std::uint8_t& v : noise) v = std::uint8_t(random() % 256);
        const File file = make_jpeg(8, 8, 1, JCS_GRAYSCALE, noise);
        for (const int cut : {1, 2})
            expect_refused(File(file.begin(), file.end() - cut), "a.jpg", "is truncated");
    }
}

TEST(EachCut, OfBmpIsRefused) {
    expect_each_cut_refused(make_bmp(3, 2, 24, 0, {}, File(24)), "a.bmp");
    expect_each_cut_refused(make_bmp(3, 2, 8, 0, red_green_blue, File(8)), "a.bmp");
    expect_each_cut_refused(make_bmp(3, 2, 1, 0, red_green_blue, File(8), true), "a.bmp");
    expect_each_cut_refused(
        make_bmp(50, 20, 16, 3, join({le(4, 0xF800), le(4, 0x07E0), le(4, 0x001F)}), File(2000)), "a.bmp");
}

TEST(EachCut, OfTgaIsRefused) {
    expect_each_cut_refused(make_tga(64, 9, 2, 24, 0, File(64 * 9 * 3)), "a.tga");
    expect_each_cut_refused(make_tga(9, 2, 3, 8, 0, File(18)), "a.tga");
    expect_each_cut_refused(make_tga(9, 2, 10, 32, 0, bytes({0x8F, 1, 2, 3, 4, 1, 1, 2, 3, 4, 5, 6, 7, 8})),
                            "a.tga");
    const File palette =
        join({bytes({3, 1, 9}), le(2, 5), le(2, 2), bytes({16, 0, 0, 0, 0}), le(2, 2), le(2, 3),
              bytes({16, 0}), bytes_of("an!"), bytes({1, 2, 3, 4}), bytes({0x84, 6, 0, 0, 5, 0})});
    expect_each_cut_refused(palette, "a.tga");
}

TEST(EachCut, OfGifIsRefused) {
    // Up to the last byte with a bit of the last pixel's code. What follows it is the rest of the end code,
    // an empty sub-block and the trailer.
    const auto needed = [](File file, std::ptrdiff_t spare) {
        return File(file.begin(), file.end() - spare);
    };
    expect_each_cut_refused(needed(make_gif(3, 2, 1, 0, 2, 2, true, transparent_red, lzw({1, 2, 3, 0})), 3),
                            "a.gif");
    std::vector<int> many(2000);
    for (std::size_t i = 0; i < many.size(); ++i) many[i] = int(i * i % 4);
    expect_each_cut_refused(needed(make_gif(40, 50, 0, 0, 40, 50, false, {}, lzw(many)), 3), "a.gif");
}

TEST(EachCut, OfPnmIsRefused) {
    for (const auto text : {"P1 3 2 1 0 1 0 1 1", "P2 2 2 255 1 23 255 0\n", "P3 1 1 65535 1 2 30000\n",
                            "P4 9 2 abcd", "P5 2 2 255 abcd", "P6 1 1 65535 abcdef"})
        expect_each_cut_refused(bytes_of(text), "a.pnm");
}

}  // namespace
}  // namespace probewarp
