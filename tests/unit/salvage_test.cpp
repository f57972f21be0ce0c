// PNG and JPEG files that end too soon or are damaged: refused, and where one asks for what is there, opened
// with the rows that came.
#include <gtest/gtest.h>

#include "exif_files.h"
#include "image_checks.h"
#include "io/bytes.h"

namespace probewarp {
namespace {

using namespace testing;
using ::testing::HasSubstr;

constexpr DecodeOptions salvage{.salvage = true};

Image salvaged(const File& file) { return decode_picture(file, "a", Pixels::whole, salvage).image; }

/// What became of the file without being asked to salvage.
enum class Fate { opened, incomplete, refused };

Fate fate(const File& file) {
    try {
        decode_picture(file, "a");
        return Fate::opened;
    } catch (const IncompleteFile&) {
        return Fate::incomplete;
    } catch (const Error&) {
        return Fate::refused;
    }
}

/// The same for salvaging: whether it opened, and with all that belongs to it.
Fate salvaged_fate(const File& file) {
    try {
        return salvaged(file).incomplete ? Fate::incomplete : Fate::opened;
    } catch (const IncompleteFile&) {
        ADD_FAILURE() << "salvaging says that salvaging would do";
        return Fate::refused;
    } catch (const Error&) {
        return Fate::refused;
    }
}

File first(const File& file, std::size_t size) { return {file.begin(), file.begin() + std::ptrdiff_t(size)}; }

/// Every row is as in the whole picture, up to some row, and clear from there on. How many came.
int rows_that_came(const Image& part, const Image& whole) {
    EXPECT_EQ(part.width, whole.width);
    EXPECT_EQ(part.height, whole.height);
    const auto same = [&](int y) {
        for (int x = 0; x < whole.width; ++x)
            if (pixel(part, x, y) != pixel(whole, x, y)) return false;
        return true;
    };
    int rows = 0;
    while (rows < whole.height && same(rows)) ++rows;
    for (int y = rows; y < whole.height; ++y)
        for (int x = 0; x < whole.width; ++x)
            EXPECT_EQ(pixel(part, x, y), (Rgba{0, 0, 0, 0})) << x << ", " << y;
    return rows;
}

/// Noise, of which each byte of the file counts.
Image noise(int width, int height) {
    std::vector<std::uint8_t> rgba;
    for (unsigned i = 0, v = 1; i < unsigned(width * height * 4); ++i) {
        v = v * 1664525 + 1013904223;
        rgba.push_back(i % 4 == 3 ? 255 : std::uint8_t(v >> 24));
    }
    return {width, height, std::move(rgba), {}, {}};
}

// ---- PNG ----

TEST(Salvage, OfAPngThatEndsTooSoonIsItsRows) {
    const Image image = noise(40, 60);
    const File file = encode(image, "png");
    int last = 0;
    for (std::size_t size = 0; size < file.size(); size += size < 240 || size + 60 > file.size() ? 1 : 41) {
        const File cut = first(file, size);
        const Fate expected = fate(cut);
        ASSERT_EQ(salvaged_fate(cut), expected) << size;
        if (expected != Fate::incomplete) continue;
        const Image part = salvaged(cut);
        EXPECT_FALSE(part.opaque);
        const int rows = rows_that_came(part, image);
        EXPECT_GE(rows, std::max(1, last)) << size;
        last = rows;
    }
    EXPECT_GE(last, 59);
    EXPECT_EQ(rows_that_came(salvaged(first(file, file.size() / 2)), image), 29);
}

TEST(Salvage, OfAPngWithAWrongChecksumIsWhatComesBeforeIt) {
    // Each IDAT chunk holds some rows.
    const Image image = noise(40, 60);
    File stream;
    const File whole = encode(image, "png");
    const std::size_t head = 8 + 25, length = be32(whole, head);
    stream.assign(whole.begin() + std::ptrdiff_t(head + 8),
                  whole.begin() + std::ptrdiff_t(head + 8 + length));
    const auto file_with_damage_in = [&](std::size_t damaged) {
        File file = first(whole, head);
        for (std::size_t i = 0; i < 6; ++i) {
            File chunk =
                png_chunk("IDAT", File(stream.begin() + std::ptrdiff_t(stream.size() * i / 6),
                                       stream.begin() + std::ptrdiff_t(stream.size() * (i + 1) / 6)));
            if (i == damaged) chunk.back() ^= std::byte{1};
            file += chunk;
        }
        return join({file, png_chunk("IEND", {})});
    };
    ASSERT_EQ(fate(file_with_damage_in(6)), Fate::opened);
    for (std::size_t damaged = 0; damaged < 6; ++damaged) {
        const File file = file_with_damage_in(damaged);
        EXPECT_EQ(fate(file), Fate::incomplete);
        EXPECT_THAT(error_of(file, "a.png"), HasSubstr("is damaged (invalid chunk checksum)"));
        EXPECT_NEAR(rows_that_came(salvaged(file), image), 10 * int(damaged + 1), 1);
    }
}

TEST(Salvage, OfAPngWhoseStreamBreaksIsWhatComesBeforeThat) {
    File raw;
    for (int y = 0; y < 50; ++y) {
        raw.push_back(std::byte(y == 30 ? 9 : 0));  // there is no filter 9
        for (int x = 0; x < 20; ++x) raw.push_back(std::byte(x * y));
    }
    const auto file = [&](const File& stream) {
        return join(
            {png_signature, png_header(20, 50, 8, 0), png_chunk("IDAT", stream), png_chunk("IEND", {})});
    };
    EXPECT_EQ(fate(file(deflated(raw))), Fate::incomplete);
    const Image part = salvaged(file(deflated(raw)));
    EXPECT_TRUE(part.incomplete);
    EXPECT_EQ(pixel(part, 19, 28)[0], 19 * 28 % 256);
    EXPECT_EQ(pixel(part, 19, 28)[3], 255);
    EXPECT_EQ(pixel(part, 0, 31), (Rgba{0, 0, 0, 0}));
    // Rows are missing though the file goes on to its end.
    const File few = file(deflated(first(raw, 21 * 20)));
    EXPECT_THAT(error_of(few, "a.png"), HasSubstr("is damaged (IDAT stream too short)"));
    EXPECT_EQ(fate(few), Fate::incomplete);
    EXPECT_EQ(pixel(salvaged(few), 19, 18)[3], 255);
    EXPECT_EQ(pixel(salvaged(few), 19, 20)[3], 0);
    const File none = file(bytes_of("junk"));
    EXPECT_EQ(fate(none), Fate::refused);
    EXPECT_EQ(salvaged_fate(none), Fate::refused);
}

TEST(Salvage, OfAnInterlacedPngShowsEachPixelInItsNeighboursPlaces) {
    PngSpec spec{64, 64, 8, 0, true, {}, {}, {}, false};
    const Image grain = noise(64, 64);  // so that it does not pack too well
    for (int i = 0; i < 64 * 64; ++i)
        spec.samples.push_back(
            std::uint16_t((i / 64 + i % 64) * 3 / 2 + pixel(grain, i % 64, i / 64)[0] / 16));
    const File file = make_png(spec);
    const Image whole = decode(file);
    EXPECT_EQ(salvaged(file).rgba, whole.rgba) << "nothing is missing";
    int error_before = 1 << 30;
    for (const std::size_t percent : {40u, 60u, 80u, 95u}) {
        const File cut = first(file, file.size() * percent / 100);
        ASSERT_EQ(fate(cut), Fate::incomplete);
        const Image part = salvaged(cut);
        int error = 0, clear = 0;
        for (int y = 0; y < 64; ++y)
            for (int x = 0; x < 64; ++x) {
                clear += pixel(part, x, y)[3] == 0;
                error += std::abs(pixel(part, x, y)[0] - pixel(whole, x, y)[0]);
            }
        EXPECT_LE(error, error_before) << "finer and finer";
        error_before = error;
        if (percent >= 60) {
            EXPECT_EQ(clear, 0) << "every place has a pixel near by";
        }
    }
}

TEST(Salvage, OfATurnedPngIsTurned) {
    const ByteOrder order{true};
    const File file = encode(noise(40, 60), "png");
    const File exif = png_chunk("eXIf", make_exif(order, {.main = {order.two(0x0112, 6)}}));
    const File turned = join({first(file, 33), exif, File(file.begin() + 33, file.end())});
    const Image part = salvaged(first(turned, turned.size() / 2));
    ASSERT_EQ(part.width, 60);
    EXPECT_TRUE(part.incomplete);
    // Stored rows are columns now, from the right.
    EXPECT_EQ(pixel(part, 59, 7), pixel(decode(file), 7, 0));
    EXPECT_EQ(pixel(part, 0, 7), (Rgba{0, 0, 0, 0}));
}

// ---- JPEG ----

File noisy_jpeg(int width, int height, const std::function<void(jpeg_compress_struct&)>& adjust = {}) {
    const Image image = noise(width, height);
    std::vector<std::uint8_t> samples;
    for (std::size_t i = 0; i < std::get<0>(image.rgba).size(); ++i)
        if (i % 4 != 3) samples.push_back(std::get<0>(image.rgba)[i]);
    return make_jpeg(width, height, 3, JCS_RGB, samples, adjust);
}

TEST(Salvage, OfAJpegThatEndsTooSoonIsItsRows) {
    const File file = noisy_jpeg(80, 160);
    const Image whole = decode(file);
    int last = 0;
    for (std::size_t size = 0; size < file.size(); size += 97) {
        const File cut = first(file, size);
        const Fate expected = fate(cut);
        ASSERT_EQ(salvaged_fate(cut), expected) << size;
        if (expected != Fate::incomplete) continue;
        const Image part = salvaged(cut);
        int rows = 0;
        while (rows < 160 && pixel(part, 40, rows)[3] == 255) ++rows;
        EXPECT_EQ(part.opaque, rows == 160);
        EXPECT_GE(rows, last);
        last = rows;
        // 4:2:0, blocks of 16 rows: the last one that came may be so in part, and its colours reach one row
        // up.
        for (int y = 0; y < rows - 17; ++y)
            for (int x = 0; x < 80; ++x) ASSERT_EQ(pixel(part, x, y), pixel(whole, x, y)) << x << ", " << y;
        for (int y = rows; y < 160; ++y) ASSERT_EQ(pixel(part, 79, y), (Rgba{0, 0, 0, 0}));
    }
    EXPECT_GE(last, 144);
}

TEST(Salvage, OfAProgressiveJpegIsItsScans) {
    const File file = noisy_jpeg(80, 160, [](jpeg_compress_struct& j) { jpeg_simple_progression(&j); });
    const Image whole = decode(file);
    const auto error = [&](const Image& part) {
        long sum = 0;
        for (int y = 0; y < 160; ++y)
            for (int x = 0; x < 80; ++x) sum += std::abs(pixel(part, x, y)[1] - pixel(whole, x, y)[1]);
        return sum;
    };
    long before = std::numeric_limits<long>::max();
    for (std::size_t percent = 10; percent < 100; percent += 10) {
        const Image part = salvaged(first(file, file.size() * percent / 100));
        EXPECT_TRUE(part.incomplete);
        EXPECT_LE(error(part), before) << percent;
        before = error(part);
    }
    EXPECT_LT(before, 80 * 160 * 16);
    // Wherever it is cut, also within a segment between two scans.
    for (std::size_t size = 0; size < file.size(); ++size)
        if (size < 700 || size % 64 == 0 || file[size] == std::byte{0xFF}) {
            ASSERT_EQ(salvaged_fate(first(file, size)), fate(first(file, size))) << size;
        }
}

TEST(Salvage, OfAJpegDamagedAmidIsWhatLibjpegMakesOfIt) {
    const File sound = noisy_jpeg(80, 160, [](jpeg_compress_struct& j) { j.restart_interval = 5; });
    const Image whole = decode(sound);
    // Ones without end, which no code is; the zero behind a 255 says that it is no marker. And markers of
    // which nobody knows how long their segments would be.
    const File ones = bytes({0xFF, 0, 0xFF, 0, 0xFF, 0, 0xFF, 0});
    for (const File& damage : {ones, join({ones, bytes({0xFF, 0x3F, 0xFF, 0x3F})})}) {
        File file = sound;
        std::ranges::copy(damage, file.begin() + std::ptrdiff_t(file.size() / 2));
        ASSERT_EQ(fate(file), Fate::incomplete);
        const Image part = salvaged(file);
        EXPECT_TRUE(part.incomplete);
        EXPECT_TRUE(part.opaque);
        EXPECT_EQ(pixel(part, 40, 20), pixel(whole, 40, 20));
        EXPECT_EQ(pixel(part, 40, 150), pixel(whole, 40, 150)) << "it finds its way again";
    }
}

TEST(Salvage, OfAJpegWithoutItsEndMarkerHasAllPixels) {
    const File file = noisy_jpeg(40, 40);
    for (const std::size_t missing : {1u, 2u}) {
        const File cut = first(file, file.size() - missing);
        ASSERT_EQ(fate(cut), Fate::incomplete);
        EXPECT_EQ(salvaged(cut).rgba, decode(file).rgba);
        EXPECT_TRUE(salvaged(cut).opaque);
    }
}

TEST(Salvage, OfAJpegThatStopsWithAnEndMarkerIsItsRows) {
    const File file = noisy_jpeg(80, 160);
    const File cut = join({first(file, file.size() / 2), bytes({0, 0xFF, 0xD9})});
    ASSERT_EQ(fate(cut), Fate::incomplete);
    EXPECT_EQ(pixel(salvaged(cut), 40, 20), pixel(decode(file), 40, 20));
    EXPECT_EQ(pixel(salvaged(cut), 40, 159), (Rgba{0, 0, 0, 0}));
}

TEST(Salvage, OfATurnedJpegIsTurned) {
    const File file = with_marker(noisy_jpeg(80, 160), exif_marker(6));
    const Image part = salvaged(first(file, file.size() / 2)), whole = decode(file);
    ASSERT_EQ(part.width, 160);
    EXPECT_EQ(pixel(part, 150, 20), pixel(whole, 150, 20));
    EXPECT_EQ(pixel(part, 0, 20), (Rgba{0, 0, 0, 0}));
}

TEST(Salvage, OfAJpegInInksIsClearWhereRowsAreMissing) {
    std::vector<std::uint8_t> samples(80 * 160 * 4);
    for (std::size_t i = 0; i < samples.size(); ++i) samples[i] = std::uint8_t(i * i / 7);
    const File file = make_jpeg(80, 160, 4, JCS_CMYK, samples);
    const Image part = salvaged(first(file, file.size() / 2));
    EXPECT_EQ(pixel(part, 40, 20), pixel(decode(file), 40, 20));
    EXPECT_EQ(pixel(part, 40, 159), (Rgba{0, 0, 0, 0}));
}

// ---- both ----

TEST(Salvage, OfASoundFileIsAsWithoutIt) {
    for (const char* format : {"png", "jpeg"}) {
        const File file = encode(noise(50, 70), format);
        const Picture picture = decode_picture(file, "a", Pixels::arriving, salvage);
        EXPECT_FALSE(picture.image.incomplete);
        EXPECT_EQ(picture.image.rgba, decode(file).rgba);
        EXPECT_EQ(picture.image.opaque, true);
        EXPECT_EQ(picture.original, file);
    }
}

TEST(Salvage, TheOriginalBecomesAFileThatOpensAgain) {
    for (const char* format : {"png", "jpeg"}) {
        const File file = encode(noise(50, 70), format);
        const Picture picture = decode_picture(first(file, file.size() / 2), "a", Pixels::whole, salvage);
        EXPECT_EQ(picture.format, "png");
        EXPECT_EQ(decode(picture.original).rgba, picture.image.rgba);
    }
}

}  // namespace
}  // namespace probewarp
