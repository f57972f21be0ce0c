// BMP, TGA, GIF and PNM: their kinds, each cut of a file of every format, and bad files. bmp_test.cpp and its
// like hold what each format has of its own.
#include <gtest/gtest.h>

#include <random>

#include "image_checks.h"
#include "io/lzw.h"

namespace probewarp {
namespace {

using namespace testing;

constexpr Rgba black{0, 0, 0, 255}, red{255, 0, 0, 255}, green{0, 255, 0, 255}, blue{0, 0, 255, 255};

// ---- BMP ----

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

// ---- TGA ----

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

// ---- GIF ----

const File transparent_red = bytes({0x21, 0xF9, 4, 1, 0, 0, 1, 0});

TEST(Gif, FirstFrameOnItsCanvas) {
    const File file = make_gif(3, 2, 1, 0, 2, 2, false, {}, lzw({1, 2, 3, 0}));
    const Rgba nothing{0, 0, 0, 0};
    EXPECT_EQ(pixels(decode(file)), (std::vector<Rgba>{nothing, red, green, nothing, blue, black}));
    const File clear = make_gif(2, 1, 0, 0, 2, 1, false, transparent_red, lzw({1, 2}));
    EXPECT_EQ(pixels(decode(clear)), (std::vector<Rgba>{{255, 0, 0, 0}, green}));
    const File beyond = make_gif(2, 1, 0, 0, 2, 1, false, {}, lzw({200, 3}));
    EXPECT_EQ(pixels(decode(beyond)), (std::vector<Rgba>{nothing, blue})) << "no such colour";
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

// ---- PNM ----

TEST(Pnm, OfEveryKind) {
    const auto of = [](std::string_view text) { return pixels(decode(bytes_of(text))); };
    const Rgba white{255, 255, 255, 255};
    EXPECT_EQ(of("P1 # a comment\n3 1\n1 0\n1"), (std::vector<Rgba>{black, white, black}));
    EXPECT_EQ(of("P1\n3 1\n101"), (std::vector<Rgba>{black, white, black}));
    EXPECT_EQ(of("P2\n2 1\n4\n0#x\n1\n"), (std::vector<Rgba>{black, {64, 64, 64, 255}}));
    EXPECT_EQ(of("P3 1 2 255 255 0 0 0 0 255 "), (std::vector<Rgba>{red, blue}));
    EXPECT_EQ(of("P4\n9 2\n\x80\x80\x7f\x7f"), ([&] {
                  std::vector<Rgba> all(18, white);
                  all[0] = all[8] = black;
                  for (std::size_t i = 10; i < 17; ++i) all[i] = black;
                  return all;
              }()));
    EXPECT_EQ(of("P5 2 1 255\n\x01\xfe"), (std::vector<Rgba>{{1, 1, 1, 255}, {254, 254, 254, 255}}));
    EXPECT_EQ(of("P6 1 1 100\nd2#"), (std::vector<Rgba>{{255, 128, 89, 255}}));
    const Image deep = decode(bytes_of("P6 1 1 65535\n\x01\x02\x03\x04\x05\x06"));
    EXPECT_EQ(deep.bits(), 16);
    EXPECT_EQ(pixels(deep), (std::vector<Rgba>{{258, 772, 1286, 65535}}));
    EXPECT_EQ(decode(bytes_of("P2 1 1 256 256 ")).bits(), 16);
}

TEST(Pnm, BadOnesAreRefused) {
    expect_refused(bytes_of("P5 2 1 0\n\x01\x01"), "a.pgm", "its highest sample is not 1 to 65535");
    expect_refused(bytes_of("P5 2 1 65536\n\x01\x01"), "a.pgm", "its highest sample is not 1 to 65535");
    expect_refused(bytes_of("P5 2 -1 255\n\x01\x01"), "a.pgm", "a number is missing");
    expect_refused(bytes_of("P5 2 99999999999 255\n\x01\x01"), "a.pgm", "a number is too large");
    expect_refused(bytes_of("P5 0 1 255\n\x01\x01"), "a.pgm", "is 0 x 1 pixels");
    expect_refused(bytes_of("P1 2 1\n12\n"), "a.pbm", "a bit is neither 0 nor 1");
    for (const char kind : {'1', '2', '3', '4', '5', '6'})
        expect_refused(bytes_of(std::string("P").append(1, kind).append(" 9000 9000 255\n1")), "a.pnm",
                       "is truncated");
}

// ---- each cut of a file ----

// Exceptions: a TGA's footer, whatever stands behind the codes of a GIF's first frame or a PNG's pixels, a
// plain bitmap's last line break.

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
