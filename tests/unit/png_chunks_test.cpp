// PNGs that are odd and sound: faulty, doubled or misplaced ancillary chunks, unusual streams, ends that are
// missing. What is critical must be right all the same.
#include <gtest/gtest.h>

#include "exif_files.h"
#include "image_checks.h"

namespace probewarp {
namespace {

using namespace testing;

const File end_chunk = png_chunk("IEND", {});

/// With a checksum that is wrong.
File unsound(std::string_view type, const File& data) {
    File chunk = png_chunk(type, data);
    chunk.back() ^= std::byte{1};
    return chunk;
}

/// The chunk, which says that it is `length` bytes long.
File of_length(std::size_t length, const File& chunk) {
    return join({be(4, length), File(chunk.begin() + 4, chunk.end())});
}

// RGB, 2 x 2.
const File rgb_head = join({png_signature, png_header(2, 2, 8, 2)});
const File rgb_raw = bytes({0, 200, 10, 20, 0, 0, 255, 0, 1, 2, 3, 4, 5, 6});
const File rgb_data = png_chunk("IDAT", deflated(rgb_raw));
const std::vector<Rgba> rgb{{200, 10, 20, 255}, {0, 0, 255, 255}, {1, 2, 3, 255}, {4, 5, 6, 255}};
const std::vector<Rgba> keyed{{200, 10, 20, 0}, {0, 0, 255, 255}, {1, 2, 3, 255}, {4, 5, 6, 255}};
const File key = bytes({0, 200, 0, 10, 0, 20});

// Indexed, 2 x 2: the indices 0 to 3.
const File indexed_head = join({png_signature, png_header(2, 2, 8, 3)});
const File indexed_data = png_chunk("IDAT", deflated(bytes({0, 0, 1, 0, 2, 3})));
const File palette = bytes({10, 20, 30, 40, 50, 60, 70, 80, 90, 100, 110, 120});
const File plte = png_chunk("PLTE", palette);

std::vector<Rgba> indexed(const std::vector<int>& alphas) {
    std::vector<Rgba> all;
    for (int i = 0; i < 4; ++i)
        all.push_back(
            {30 * i + 10, 30 * i + 20, 30 * i + 30, i < int(alphas.size()) ? alphas[std::size_t(i)] : 255});
    return all;
}

/// The RGB picture with these between IHDR and the pixels.
File with(const File& chunks) { return join({rgb_head, chunks, rgb_data, end_chunk}); }

void expect_pixels(const File& file, const std::vector<Rgba>& meaning, const std::string& what) {
    SCOPED_TRACE(what);
    ASSERT_EQ(error_of(file, "a.png"), "");
    EXPECT_EQ(pixels(decode(file)), meaning);
}

TEST(PngChunks, AncillaryOnesThatAreFaultyAreLeftOut) {
    const File phys = join({be(4, 4000), be(4, 4000), bytes({1})});
    for (const auto& [type, data] : std::vector<std::pair<std::string, File>>{
             {"pHYs", phys},
             {"tEXt", bytes({'a', 0, 'b'})},
             {"gAMA", be(4, 100000)},
             {"tRNS", key},
             {"eXIf", make_exif(ByteOrder{true}, {.main = {ByteOrder{true}.two(0x0112, 3)}})},
             {"iCCP", join({bytes({'n', 0, 0}), deflated(File(200))})},
             {"sRGB", bytes({0})},
             {"cICP", bytes({1, 8, 0, 1})}}) {
        const File file = with(unsound(type, data));
        expect_pixels(file, rgb, type);
        EXPECT_EQ(decode(file).description, Description{}) << type;
    }
    for (const auto& [type, data] :
         std::vector<std::pair<std::string, File>>{{"pHYs", File(8)},
                                                   {"pHYs", File(9)},
                                                   {"pHYs", join({be(8, 0x100000001), bytes({7})})},
                                                   {"gAMA", be(3, 1)},
                                                   {"gAMA", be(5, 1)},
                                                   {"gAMA", be(4, 0)},
                                                   {"cHRM", File(32)},
                                                   {"cHRM", File(5)},
                                                   {"cHRM", File(32, std::byte{255})},
                                                   {"sRGB", bytes({9})},
                                                   {"sRGB", {}},
                                                   {"cICP", bytes({1, 8, 1, 1})},
                                                   {"cICP", bytes({1, 8, 0, 2})},
                                                   {"cICP", bytes({1, 8, 0})},
                                                   {"eXIf", bytes_of("junk")},
                                                   {"eXIf", {}},
                                                   {"tIME", bytes({1})},
                                                   {"tEXt", {}},
                                                   {"zTXt", bytes({'x'})},
                                                   {"iTXt", bytes({'q'})},
                                                   {"sBIT", bytes({9, 9, 9})},
                                                   {"bKGD", {}},
                                                   {"hIST", be(2, 1)},
                                                   {"sPLT", bytes_of("abc")},
                                                   {"sPLT", join({bytes_of("abc"), bytes({0, 8}), File(6)})},
                                                   {"abCd", bytes({1})},
                                                   {"abcd", bytes({1})},
                                                   {"acTL", be(8, 0x100000000)},
                                                   {"fcTL", File(26)},
                                                   {"tRNS", bytes({0, 200})},
                                                   {"tRNS", {}},
                                                   {"PLTE", bytes({1, 2, 3, 4})},
                                                   {"PLTE", {}},
                                                   {"PLTE", File(257 * 3)}}) {
        const File file = with(png_chunk(type, data));
        expect_pixels(file, rgb, type + " of " + std::to_string(data.size()));
        EXPECT_EQ(decode(file).description, Description{}) << type;
    }
}

TEST(PngChunks, ProfilesThatCannotBeUnpackedAreLeftOut) {
    const File name = bytes({'n', 0, 0}), profile = deflated(File(3000, std::byte{7}));
    EXPECT_EQ(decode(with(png_chunk("iCCP", join({name, profile})))).description.icc,
              File(3000, std::byte{7}));
    const File cut(profile.begin(), profile.end() - 6);
    File wrong = profile;
    wrong.back() ^= std::byte{1};  // its Adler-32
    for (const File& data :
         {join({name, bytes_of("junk")}), join({name, cut}), join({name, wrong}), File{}, name, bytes({'n'}),
          join({bytes({'n', 0, 1}), profile}), join({bytes({0, 0}), profile}),
          join({File(80, std::byte{'n'}), bytes({0, 0}), profile}),
          join({name, deflated(File((4 << 20) + 1))})}) {
        const File file = with(png_chunk("iCCP", data));
        expect_pixels(file, rgb, "iCCP");
        EXPECT_TRUE(decode(file).description.icc.empty()) << data.size();
    }
    EXPECT_EQ(decode(with(png_chunk("iCCP", join({name, deflated(File(4 << 20))})))).description.icc.size(),
              std::size_t{4} << 20);
}

TEST(PngChunks, TheFirstOfTwoCounts) {
    const auto twice = [](std::string_view type, const File& first, const File& second) {
        return decode(with(join({png_chunk(type, first), png_chunk(type, second)}))).description;
    };
    EXPECT_EQ(twice("gAMA", be(4, 100000), be(4, 45455)).gamma, 100000u);
    EXPECT_EQ(twice("gAMA", be(4, 0), be(4, 45455)).gamma, 45455u) << "unless it is faulty";
    EXPECT_EQ(twice("sRGB", bytes({1}), bytes({2})).srgb_intent, std::uint8_t{1});
    EXPECT_EQ(twice("cICP", bytes({9, 16, 0, 1}), bytes({1, 1, 0, 1})).cicp,
              (std::array<std::uint8_t, 4>{9, 16, 0, 1}));
    const auto profile = [](const File& icc) { return join({bytes({'n', 0, 0}), deflated(icc)}); };
    EXPECT_EQ(twice("iCCP", profile(File(200, std::byte{7})), profile(File(300))).icc,
              File(200, std::byte{7}));
    // Unlike a number, a profile takes time to look at: the second is not, whatever is wrong with the first.
    EXPECT_EQ(twice("iCCP", profile(File((4 << 20) + 1)), profile(File(300))).icc, File{});
    EXPECT_EQ(twice("iCCP", bytes_of("junk"), profile(File(300))).icc, File{});
    const auto size = [](std::uint64_t x, std::uint64_t y, int unit) {
        return join({be(4, x), be(4, y), bytes({unit})});
    };
    const Description sizes = twice("pHYs", size(4, 2, 0), size(5, 5, 1));
    EXPECT_EQ(sizes.aspect, (Resolution{4, 2}));
    EXPECT_EQ(sizes.resolution, std::nullopt);
    expect_pixels(with(join({png_chunk("tRNS", key), png_chunk("tRNS", bytes({0, 0, 0, 0, 0, 255}))})), keyed,
                  "tRNS twice");
}

TEST(PngChunks, TransparencyMayStandBeforeThePalette) {
    expect_pixels(with(join({png_chunk("tRNS", key), plte})), keyed, "RGB");
    expect_pixels(with(join({plte, png_chunk("tRNS", key)})), keyed, "RGB, in order");
    const File alphas = png_chunk("tRNS", bytes({128, 64}));
    for (const File& chunks :
         {join({alphas, plte}), join({plte, alphas}),
          join({png_chunk("bKGD", bytes({0})), plte, png_chunk("hIST", File(2)), alphas})})
        expect_pixels(join({indexed_head, chunks, indexed_data, end_chunk}), indexed({128, 64}), "indexed");
    expect_pixels(join({rgb_head, rgb_data, png_chunk("tRNS", key), end_chunk}), rgb, "behind the pixels");
}

TEST(PngChunks, TransparencyOfOddLengths) {
    const auto file = [](const File& alphas) {
        return join({indexed_head, plte, png_chunk("tRNS", alphas), indexed_data, end_chunk});
    };
    expect_pixels(file({}), indexed({}), "empty");
    expect_pixels(file(bytes({1, 2, 3, 4, 5})), indexed({1, 2, 3, 4}), "of more colours than there are");
    // Of each sample only the bits that it has count.
    expect_pixels(with(png_chunk("tRNS", bytes({7, 200, 7, 10, 7, 20}))), keyed, "high bits");
    const File grey = join({png_signature, png_header(2, 1, 4, 0), png_chunk("tRNS", bytes({0, 0x35})),
                            png_chunk("IDAT", deflated(bytes({0, 0x52}))), end_chunk});
    expect_pixels(grey, {{85, 85, 85, 0}, {34, 34, 34, 255}}, "grey of 4 bits");
    const File rgba = join({png_signature, png_header(1, 1, 8, 6), png_chunk("tRNS", key),
                            png_chunk("IDAT", deflated(bytes({0, 1, 2, 3, 4}))), end_chunk});
    expect_pixels(rgba, {{1, 2, 3, 4}}, "beside an alpha");
    const File deep = join({png_signature, png_header(2, 1, 16, 0), png_chunk("tRNS", bytes({1, 2})),
                            png_chunk("IDAT", deflated(bytes({0, 1, 2, 2, 1}))), end_chunk});
    expect_pixels(deep, {{258, 258, 258, 0}, {513, 513, 513, 65535}}, "16 bits");
}

TEST(PngChunks, PalettesOfOddLengths) {
    const auto file = [](const File& chunk) { return join({indexed_head, chunk, indexed_data, end_chunk}); };
    // A colour that the palette does not have is black, as with libpng.
    expect_pixels(file(png_chunk("PLTE", bytes({10, 20, 30}))),
                  {{10, 20, 30, 255}, {0, 0, 0, 255}, {0, 0, 0, 255}, {0, 0, 0, 255}}, "too short");
    const File one_bit = join({png_signature, png_header(2, 1, 1, 3), plte,
                               png_chunk("IDAT", deflated(bytes({0, 0x40}))), end_chunk});
    expect_pixels(one_bit, {{10, 20, 30, 255}, {40, 50, 60, 255}}, "more colours than one bit can name");
    const File grey = join({png_signature, png_header(2, 1, 8, 0), plte,
                            png_chunk("IDAT", deflated(bytes({0, 7, 9}))), end_chunk});
    expect_pixels(grey, {{7, 7, 7, 255}, {9, 9, 9, 255}}, "of a grey picture");
    expect_refused(file({}), "a.png", "it has no palette");
    expect_refused(file(png_chunk("PLTE", {})), "a.png", "its palette has a wrong length");
    expect_refused(file(png_chunk("PLTE", File(4))), "a.png", "its palette has a wrong length");
    expect_refused(file(png_chunk("PLTE", File(257 * 3))), "a.png", "its palette has a wrong length");
    expect_refused(file(join({plte, plte})), "a.png", "it has two palettes");
}

TEST(PngChunks, CriticalOnesMustBeRight) {
    File header = rgb_head;
    header.back() ^= std::byte{1};
    expect_refused(join({header, rgb_data, end_chunk}), "a.png", "invalid chunk checksum");
    expect_refused(join({rgb_head, unsound("IDAT", deflated(rgb_raw)), end_chunk}), "a.png",
                   "invalid chunk checksum");
    expect_refused(join({indexed_head, unsound("PLTE", palette), indexed_data, end_chunk}), "a.png",
                   "invalid chunk checksum");
    expect_refused(with(unsound("PLTE", palette)), "a.png", "invalid chunk checksum");
    expect_refused(with(png_chunk("ABCD", {})), "a.png", "unknown critical chunk");
    expect_refused(join({rgb_head, rgb_data, png_chunk("ABCD", {}), end_chunk}), "a.png",
                   "unknown critical chunk");
    expect_refused(with(png_header(2, 2, 8, 2)), "a.png", "invalid chunk position");
    expect_refused(join({png_signature, png_chunk("tEXt", {}), png_header(2, 2, 8, 2), rgb_data}), "a.png",
                   "it does not start with IHDR");
    expect_refused(join({rgb_head, end_chunk}), "a.png", "it has no pixels");
    for (const int depth : {0, 3, 17, 247})
        expect_refused(join({png_signature, png_header(2, 2, depth, 2), png_chunk("tRNS", key), rgb_data}),
                       "a.png", "invalid bit depth");
}

TEST(PngChunks, WhatFollowsThePixelsMayBeMissingOrNonsense) {
    const File sound = join({rgb_head, rgb_data});
    for (const File& tail :
         {File{}, File(end_chunk.begin(), end_chunk.begin() + 5), join({end_chunk, bytes_of("garbage")}),
          bytes_of("garbage"), File(100), unsound("IEND", {}), png_chunk("IEND", bytes({1})),
          of_length(0x7FFFFFFF, png_chunk("tEXt", bytes({1}))), of_length(0xFFFFFFFF, png_chunk("tEXt", {})),
          unsound("tEXt", bytes({1})), join({plte, end_chunk}), join({end_chunk, sound})})
        expect_pixels(join({sound, tail}), rgb, "tail of " + std::to_string(tail.size()));
    for (const int missing : {1, 2, 4, 5})  // of the pixels' checksum, and of the pixels
        expect_refused(File(sound.begin(), sound.end() - missing), "a.png", "is truncated");
    expect_refused(join({rgb_head, of_length(0x7FFFFFFF, png_chunk("tEXt", {})), rgb_data, end_chunk}),
                   "a.png", "is truncated");
}

TEST(PngChunks, PixelsInOddPortions) {
    const File stream = deflated(rgb_raw);
    File singly;
    for (const std::byte b : stream) singly += png_chunk("IDAT", {b});
    const auto part = [&](std::size_t from, std::size_t to) {
        return png_chunk("IDAT",
                         File(stream.begin() + std::ptrdiff_t(from), stream.begin() + std::ptrdiff_t(to)));
    };
    const File nothing = png_chunk("IDAT", {}), text = png_chunk("tEXt", bytes({'a', 0, 'b'}));
    const std::size_t size = stream.size();
    File narrow = stream;
    narrow[0] = std::byte{0x08}, narrow[1] = std::byte{0x1D};  // a window of 256 bytes
    for (const File& data :
         {singly, join({nothing, part(0, 5), nothing, part(5, size), nothing}),
          join({part(0, 5), text, part(5, size)}), png_chunk("IDAT", join({stream, bytes_of("more")})),
          join({part(0, size), png_chunk("IDAT", bytes_of("more"))}),
          join({part(0, size), text, png_chunk("IDAT", bytes_of("more"))}),
          png_chunk("IDAT", deflated(join({rgb_raw, File(50)}))), png_chunk("IDAT", narrow)})
        expect_pixels(join({rgb_head, data, end_chunk}), rgb, "data of " + std::to_string(data.size()));
}

TEST(PngChunks, DescriptionsAreReadFromWhereverTheyStandBeforeThePixels) {
    const File gama = png_chunk("gAMA", be(4, 100000));
    const auto gamma = [](const File& file) { return decode(file).description.gamma; };
    EXPECT_EQ(gamma(join({indexed_head, plte, gama, indexed_data, end_chunk})), 100000u);
    EXPECT_EQ(gamma(join({rgb_head, rgb_data, gama, end_chunk})), std::nullopt);
    Chromaticities xy{31270, 32900, 68000, 32000, 26500, 69000, 15000, 6000};
    File chrm;
    for (const std::uint32_t v : xy) chrm += be(4, v);
    EXPECT_EQ(decode(with(png_chunk("cHRM", chrm))).description.chromaticities, xy);
}

// ---- EXIF ----

TEST(PngChunks, ExifTurnsThePictureUpright) {
    const ByteOrder order{true};
    for (const bool interlaced : {false, true})
        for (const int depth : {8, 16})
            for (int orientation = 1; orientation <= 8; ++orientation) {
                constexpr int width = 45, height = 70;  // more rows than are read at a time
                PngSpec spec{width, height, depth, 2, interlaced, {}, {}, {}, false};
                for (int i = 0; i < width * height * 3; ++i)
                    spec.samples.push_back(std::uint16_t(i * 7 % 251));
                const File file = make_png(spec);
                const Image stored = decode(file);
                const File chunk = png_chunk(
                    "eXIf", make_exif(order, {.main = {order.two(0x0112, std::uint64_t(orientation)),
                                                       text(0x8298, "me")}}));
                const Image upright = decode(join({File(file.begin(), file.end() - 12), chunk, end_chunk}));
                const bool mirrored_x =
                    orientation == 2 || orientation == 3 || orientation == 7 || orientation == 8;
                const bool mirrored_y =
                    orientation == 3 || orientation == 4 || orientation == 6 || orientation == 7;
                bool same = true;
                for (int y = 0; y < height; ++y)
                    for (int x = 0; x < width; ++x) {
                        const int u = mirrored_x ? width - 1 - x : x, v = mirrored_y ? height - 1 - y : y;
                        same &= pixel(stored, x, y) ==
                                (orientation >= 5 ? pixel(upright, v, u) : pixel(upright, u, v));
                    }
                EXPECT_TRUE(same) << orientation << (interlaced ? " interlaced" : "");
                EXPECT_EQ(tags_of(upright.description.exif).at("main").at(0x0112), be(2, 1));
            }
}

TEST(PngChunks, TheResolutionIsTheFilesElseExifs) {
    const ByteOrder order{false};
    const auto exif = [&](int orientation) {
        return png_chunk(
            "eXIf", make_exif(order, {.main = {order.two(0x0112, std::uint64_t(orientation)),
                                               order.rational(0x011A, 50, 1), order.rational(0x011B, 60, 1),
                                               order.two(0x0128, 3)}}));
    };
    const auto phys = [](int unit) { return png_chunk("pHYs", join({be(4, 7), be(4, 9), bytes({unit})})); };
    EXPECT_EQ(decode(with(exif(1))).description.resolution, (Resolution{5000, 6000}));
    EXPECT_EQ(decode(with(exif(6))).description.resolution, (Resolution{6000, 5000})) << "on its side";
    EXPECT_EQ(decode(with(join({exif(6), phys(1)}))).description.resolution, (Resolution{9, 7}));
    const Description ratio = decode(with(join({phys(0), exif(8)}))).description;
    EXPECT_EQ(ratio.resolution, std::nullopt);
    EXPECT_EQ(ratio.aspect, (Resolution{9, 7}));
}

}  // namespace
}  // namespace probewarp
