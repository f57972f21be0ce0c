// PNG out: every size, depth and compression comes back byte for byte, through strips and whole, and what is
// made does not depend on how rows come.
#include <gtest/gtest.h>
#include <libdeflate.h>
#include <zlib.h>

#include <limits>
#include <random>

#include "image_checks.h"
#include "io/deflate_strip.h"
#include "io/formats.h"
#include "io/image_encoding.h"
#include "io/png_filter.h"
#include "support/every_instruction_set.h"

namespace probewarp {
namespace {

using namespace testing;

constexpr std::uint32_t seed = 20240611;

enum class Kind { noise, gradient, flat };

/// Samples of every kind of picture; the alpha is full where `opaque`.
template <class Sample>
Image picture_of(Kind kind, int width, int height, bool opaque) {
    std::mt19937 random(seed);
    std::vector<Sample> rgba;
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            for (int c = 0; c < 4; ++c) {
                const int value = kind == Kind::noise      ? int(random())
                                  : kind == Kind::gradient ? x + 3 * y + c
                                                           : c;
                rgba.push_back(c == 3 && opaque ? std::numeric_limits<Sample>::max() : Sample(value));
            }
    return {width, height, std::move(rgba), {}, {}};
}

std::string name(const Image& image, Compression compression) {
    return std::to_string(image.width) + " x " + std::to_string(image.height) + ", " +
           std::to_string(image.bits()) + " bits, compression " + std::to_string(int(compression));
}

void expect_round_trip(const Image& image) {
    for (const auto& row : compressions()) {
        const Image back = decode(encode(image, "png", {.compression = row.compression}));
        EXPECT_EQ(back.rgba, image.rgba) << name(image, row.compression);
    }
}

TEST(Png, EverySizeComesBack) {
    // 1 and its neighbours, and both sides of the 16 and 32 bytes of vectors.
    for (const int width : {1, 2, 3, 4, 5, 6, 7, 10, 11, 16, 17, 33})
        for (const int height : {1, 2, 3, 7})
            for (const bool opaque : {true, false}) {
                expect_round_trip(picture_of<std::uint8_t>(Kind::noise, width, height, opaque));
                expect_round_trip(picture_of<std::uint16_t>(Kind::gradient, width, height, opaque));
            }
}

TEST(Png, PicturesOfManyStripsComeBack) {
    // A strip is about a mebibyte, or eight: these take several, the last ones shorter than the others.
    for (const bool opaque : {true, false})
        for (const Kind kind : {Kind::noise, Kind::flat})
            expect_round_trip(picture_of<std::uint8_t>(kind, 1500, 1101, opaque));
    expect_round_trip(picture_of<std::uint16_t>(Kind::gradient, 700, 1801, true));
    expect_round_trip(picture_of<std::uint8_t>(Kind::flat, 32768, 81, false));
    expect_round_trip(picture_of<std::uint8_t>(Kind::flat, 31, 32768, false));
}

TEST(Png, BothSidesOfAStripsEnd) {
    // 1023 x 4 + 1 bytes, the row of a mebibyte's 256: one strip, two with one row in the second, three.
    constexpr int width = 1023, strip_rows = (1 << 20) / (width * 4 + 1);
    for (const int rows : {strip_rows - 1, strip_rows, strip_rows + 1, 2 * strip_rows, 2 * strip_rows + 1})
        expect_round_trip(picture_of<std::uint8_t>(Kind::gradient, width, rows, false));
}

TEST(Png, GreyOfSixteenBitsComesBack) {
    for (const int channels : {1, 2}) {
        const int width = 1201, height = 700;  // of one channel two strips, of two four
        std::vector<std::uint16_t> samples(std::size_t(width * height * channels));
        std::mt19937 random(seed);
        for (std::size_t i = 0; i < samples.size(); ++i) samples[i] = std::uint16_t(i / 7 + random() % 5);
        const Image back = decode(encode_png_samples(width, height, channels, samples));
        ASSERT_EQ(back.bits(), 16);
        const auto& rgba = std::get<1>(back.rgba);
        for (std::size_t i = 0; i < std::size_t(width * height); ++i) {
            const std::size_t at = i * std::size_t(channels);
            ASSERT_EQ(rgba[i * 4], samples[at]);
            ASSERT_EQ(rgba[i * 4 + 3], channels == 2 ? samples[at + 1] : 65535);
        }
    }
}

/// The zlib stream of a PNG, out of its IDAT chunks.
File idat_of(const File& png, int* chunks = nullptr) {
    File all;
    for (std::size_t at = 8; at < png.size();) {
        const std::size_t length = be32(png, at);
        if (begins_with(Bytes(png).subspan(at + 4), "IDAT")) {
            const auto data = Bytes(png).subspan(at + 8, length);
            all.insert(all.end(), data.begin(), data.end());
            if (chunks) ++*chunks;
        }
        at += length + 12;
    }
    return all;
}

TEST(Png, TheStripsAreOneZlibStreamForOtherReadersToo) {
    // Other inflaters than the reader's, and with the Adler-32, which libspng does not look at.
    constexpr int height = 1501;
    const Image image = picture_of<std::uint8_t>(Kind::gradient, 1500, height, false);
    for (const auto& row : compressions()) {
        int chunks = 0;
        const File stream = idat_of(encode(image, "png", {.compression = row.compression}), &chunks);
        EXPECT_GT(chunks, 1);
        uLongf length = height * (1500 * 4 + 1);
        const uLongf expected = length;
        std::vector<std::uint8_t> first(length), second(length);
        ASSERT_EQ(
            uncompress(first.data(), &length, reinterpret_cast<const Bytef*>(stream.data()), stream.size()),
            Z_OK);
        EXPECT_EQ(length, expected);
        libdeflate_decompressor* decompressor = libdeflate_alloc_decompressor();
        EXPECT_EQ(libdeflate_zlib_decompress(decompressor, stream.data(), stream.size(), second.data(),
                                             second.size(), nullptr),
                  LIBDEFLATE_SUCCESS);
        libdeflate_free_decompressor(decompressor);
        EXPECT_EQ(first, second);
    }
}

/// The file's bytes, out of portions of `rows` rows each, taken as they are done.
File in_portions(const char* format, const Image& image, const EncodeOptions& options, int rows) {
    Image like = image;
    std::visit([](auto& rgba) { rgba.clear(); }, like.rgba);
    ImageEncoding encoding(*find_image_format(format), like, options, has_alpha(image));
    File all;
    const auto append = [&all](const FileParts& parts) {
        for (const auto& part : parts) all.insert(all.end(), part.begin(), part.end());
    };
    for (int top = 0; top < image.height; top += rows) {
        Image band = like;
        band.height = std::min(rows, image.height - top);
        std::visit(
            [&](const auto& rgba) {
                const auto first = rgba.begin() + std::ptrdiff_t(top) * image.width * 4;
                band.rgba = std::remove_cvref_t<decltype(rgba)>(
                    first, first + std::ptrdiff_t(band.height) * image.width * 4);
            },
            image.rgba);
        encoding.add(std::move(band));
        append(encoding.take());
    }
    EXPECT_TRUE(encoding.fits());
    append(encoding.finish());
    return all;
}

TEST(Png, RowsMayComeInAnyPortions) {
    Image picture = picture_of<std::uint8_t>(Kind::gradient, 1500, 1101, true);
    picture.description.icc = std::vector<std::byte>(200, std::byte{7});
    picture.description.resolution = Resolution{4000, 5000};
    for (const bool opaque : {true, false}) {
        if (!opaque) std::get<0>(picture.rgba)[(1000 * 1500 + 7) * 4 + 3] = 254;
        for (const auto& row : compressions()) {
            const EncodeOptions options{.compression = row.compression};
            const File whole = encode(picture, "png", options);
            for (const int rows : {1, 97, 256, 1100, 1101})
                EXPECT_EQ(in_portions("png", picture, options, rows), whole) << rows << ", " << row.name;
        }
    }
    const Image deep = picture_of<std::uint16_t>(Kind::noise, 300, 700, false);
    EXPECT_EQ(in_portions("png", deep, {}, 60), encode(deep, "png"));
}

TEST(Png, OtherFormatsRowsMayComeInPortionsToo) {
    for (const char* format : {"jpeg", "bmp", "tga"}) {
        const Image picture = picture_of<std::uint8_t>(Kind::gradient, 90, 61, false);
        const Image deep = picture_of<std::uint16_t>(Kind::gradient, 90, 61, true);
        for (const int rows : {1, 8, 60, 61}) {
            EXPECT_EQ(in_portions(format, picture, {}, rows), encode(picture, format)) << format;
            EXPECT_EQ(in_portions(format, deep, {}, rows), encode(deep, format)) << format;
        }
    }
}

TEST(Png, AWrongGuessAtTransparencyIsFound) {
    const ImageFormat& png = *find_image_format("png");
    const Image opaque = picture_of<std::uint8_t>(Kind::noise, 40, 30, true);
    Image clear = opaque;
    std::get<0>(clear.rgba).back() = 254;
    const auto fits = [&](const Image& image, bool transparent) {
        ImageEncoding encoding(png, image, {}, transparent);
        EXPECT_TRUE(encoding.fits()) << "nothing came yet";
        encoding.add(image);
        return encoding.fits();
    };
    EXPECT_TRUE(fits(opaque, false));
    EXPECT_FALSE(fits(opaque, true));
    EXPECT_TRUE(fits(clear, true));
    EXPECT_FALSE(fits(clear, false));
    ImageEncoding jpeg(*find_image_format("jpeg"), opaque, {}, true);
    jpeg.add(opaque);
    EXPECT_TRUE(jpeg.fits()) << "JPEG has no alpha to leave out";
}

TEST(Png, RowsThatNeverCameAreForgotten) {
    const Image image = picture_of<std::uint8_t>(Kind::noise, 1500, 1000, true);
    Image taller = image;
    taller.height = 1101;
    for (const char* format : {"png", "jpeg"}) {
        ImageEncoding encoding(*find_image_format(format), taller, {}, false);
        encoding.add(image);
    }
}

TEST(Png, SmallIsSmallerThanTheDefaultAndThatThanFast) {
    // Waves: what a filter and a longer search are for.
    Image image = picture_of<std::uint8_t>(Kind::flat, 900, 600, true);
    auto& rgba = std::get<0>(image.rgba);
    for (std::size_t i = 0; i < rgba.size(); ++i)
        if (i % 4 != 3)
            rgba[i] = std::uint8_t(128 + 100 * std::sin(double(i / 4 % 900) * double(i / 3600) / 9e3));
    std::size_t last = std::numeric_limits<std::size_t>::max();
    for (const auto& row : compressions()) {
        const std::size_t size = encode(image, "png", {.compression = row.compression}).size();
        EXPECT_LT(size, last) << row.name;
        last = size;
    }
}

// ---- filters ----

/// The bytes before the filter, by the specification's section 9 word for word.
std::vector<std::uint8_t> unfiltered(const std::vector<std::uint8_t>& filtered,
                                     const std::vector<std::uint8_t>& above, std::size_t step) {
    std::vector<std::uint8_t> row(above.size());
    for (std::size_t i = 0; i < row.size(); ++i) {
        const int a = i >= step ? row[i - step] : 0, b = above[i], c = i >= step ? above[i - step] : 0;
        const int p = a + b - c, pa = std::abs(p - a), pb = std::abs(p - b), pc = std::abs(p - c);
        const int nearest = pa <= pb && pa <= pc ? a : pb <= pc ? b : c;
        const std::array<int, 5> predicted{0, a, b, (a + b) / 2, nearest};
        row[i] = std::uint8_t(filtered[i + 1] + predicted[filtered[0]]);
    }
    return row;
}

void expect_each_filter_is_the_specifications() {
    std::mt19937 random(seed);
    for (const std::size_t step : {1u, 2u, 3u, 4u, 6u, 8u})
        for (std::size_t pixels = 1; pixels < 40; ++pixels) {
            std::vector<std::uint8_t> row(pixels * step), above(row.size());
            // Few values, so that Paeth's distances are often equal, and all of them by turns.
            const unsigned values = pixels % 2 == 0 ? 4 : 256;
            for (auto& v : row) v = std::uint8_t(random() % values * (255 / (values - 1)));
            for (auto& v : above) v = std::uint8_t(random() % values * (255 / (values - 1)));
            for (unsigned type = 0; type < 5; ++type) {
                std::vector<std::uint8_t> out(row.size() + 1);
                filter_row(row, above, step, 1u << type, out);
                ASSERT_EQ(out[0], type);
                ASSERT_EQ(unfiltered(out, above, step), row);
            }
        }
}

TEST(PngFilter, EachFilterIsTheSpecifications) {
    with_every_instruction_set(expect_each_filter_is_the_specifications);
}

void expect_that_the_least_sum_is_chosen() {
    std::vector<std::uint8_t> out(601), row(600), above(600);
    const auto chosen = [&](FilterSet filters) {
        filter_row(row, above, 3, filters, out);
        EXPECT_EQ(unfiltered(out, above, 3), row);
        return int(out[0]);
    };
    EXPECT_EQ(chosen(all_filters), 0) << "all are equal: the first";
    row.assign(600, 200);
    EXPECT_EQ(chosen(all_filters), 1) << "left says it, above does not";
    above = row;
    EXPECT_EQ(chosen(all_filters), 2) << "above says all, left not the first pixel";
    EXPECT_EQ(chosen(no_filter), 0);
    std::mt19937 random(seed);
    for (std::size_t i = 0; i < row.size(); ++i) above[i] = std::uint8_t(random());
    for (std::size_t i = 0; i < row.size(); ++i)
        row[i] = std::uint8_t((i < 3 ? 0 : row[i - 3]) / 2 + above[i] / 2);
    EXPECT_EQ(chosen(all_filters), 3);
    for (std::size_t i = 0; i < row.size(); ++i) {  // two slopes: across and down
        row[i] = std::uint8_t(i / 3 + 9);
        above[i] = std::uint8_t(i / 3);
    }
    EXPECT_EQ(chosen(all_filters), 1) << "1 a pixel against 9";
    for (std::size_t i = 0; i < row.size(); ++i)
        row[i] = std::uint8_t(i < 300 ? 40 : 90), above[i] = std::uint8_t(i < 300 ? 70 : 90);
    EXPECT_EQ(chosen(all_filters), 4) << "steps that left or above foresee by turns";
    // 513 magnitudes of 128 are 65664, more than 16 bits hold, and more than the 384 of the first pixel.
    row.assign(513, 128), above.assign(513, 0), out.assign(514, 0);
    EXPECT_EQ(chosen(sub_or_up), 1);
}

TEST(PngFilter, TheLeastSumIsChosen) { with_every_instruction_set(expect_that_the_least_sum_is_chosen); }

TEST(PngFilter, TheChoiceIsTheSameWithEveryInstructionSet) {
    std::mt19937 random(seed);
    for (std::size_t bytes = 3; bytes < 400; bytes += 3) {
        // So that all five do about equally well, and one sum that lacks a byte changes the choice.
        std::vector<std::uint8_t> row(bytes), above(bytes);
        for (std::size_t i = 0; i < bytes; ++i)
            row[i] = std::uint8_t(random()), above[i] = std::uint8_t(random());
        std::array<std::uint64_t, 5> sums{};
        for (unsigned type = 0; type < 5; ++type) {
            std::vector<std::uint8_t> out(bytes + 1);
            filter_row(row, above, 3, 1u << type, out);
            for (std::size_t i = 1; i < out.size(); ++i)
                sums[type] += std::uint64_t(std::abs(std::int8_t(out[i])));
        }
        const auto least = std::ranges::min_element(sums) - sums.begin();
        with_every_instruction_set([&] {
            std::vector<std::uint8_t> out(bytes + 1);
            filter_row(row, above, 3, all_filters, out);
            EXPECT_EQ(out[0], least) << bytes;
        });
    }
}

TEST(PngFilter, TheAlphaIsDroppedFromEveryPixel) {
    with_every_instruction_set([] {
        for (std::size_t pixels = 1; pixels < 200; ++pixels) {
            std::vector<std::uint8_t> rgba(pixels * 4), rgb(pixels * 3), expected;
            for (std::size_t i = 0; i < rgba.size(); ++i) {
                rgba[i] = std::uint8_t(i * 7);
                if (i % 4 != 3) expected.push_back(rgba[i]);
            }
            drop_alpha(rgba, rgb);
            ASSERT_EQ(rgb, expected) << pixels;
        }
    });
}

// ---- strips ----

std::vector<std::byte> inflated(Bytes stream, std::size_t size) {
    std::vector<std::byte> out(size + 1);
    z_stream z{};
    EXPECT_EQ(inflateInit2(&z, -MAX_WBITS), Z_OK);
    z.next_in = reinterpret_cast<Bytef*>(const_cast<std::byte*>(stream.data()));
    z.avail_in = uInt(stream.size());
    z.next_out = reinterpret_cast<Bytef*>(out.data());
    z.avail_out = uInt(out.size());
    EXPECT_EQ(inflate(&z, Z_FINISH), Z_STREAM_END) << z.total_out;
    EXPECT_EQ(z.avail_in, 0u) << "nothing behind the end";
    out.resize(z.total_out);
    inflateEnd(&z);
    return out;
}

/// Bytes of which all lengths, and so all eight bits at which a stream may end, come up.
std::vector<std::byte> strip_bytes(std::mt19937& random, std::size_t size, unsigned values) {
    std::vector<std::byte> raw(size);
    for (auto& byte : raw) byte = std::byte(random() % values);
    return raw;
}

TEST(DeflateStrip, StripsMakeOneStream) {
    std::mt19937 random(seed);
    std::array<int, 8> ends{};  // how many whole streams' last bytes hold so many bits, by their highest
    for (const int level : {1, 2, 4, 6, 9, 12})
        for (int run = 0; run < 60; ++run) {
            std::vector<std::byte> stream, all;
            for (int i = 0; i < 4; ++i) {
                // One value: matches alone; 256: stored blocks; the sizes reach over several blocks.
                const unsigned values = std::array{1u, 2u, 17u, 256u}[random() % 4];
                const auto raw = strip_bytes(random, 1 + random() % (run % 10 == 0 ? 400000 : 3000), values);
                auto strip = deflate_whole(raw, level);
                ++ends[std::size_t(std::bit_width(std::to_integer<unsigned>(strip.back()))) % 8];
                if (i < 3) open_end(strip, raw.size());
                stream.insert(stream.end(), strip.begin(), strip.end());
                all.insert(all.end(), raw.begin(), raw.end());
            }
            ASSERT_EQ(inflated(stream, all.size()), all) << "level " << level << ", run " << run;
        }
    for (const int count : ends) EXPECT_GT(count, 0);
}

TEST(DeflateStrip, StripsOfAllKindsMakeOneStream) {
    std::mt19937 random(seed);
    for (int run = 0; run < 200; ++run) {
        std::vector<std::byte> stream, all;
        for (int i = 0; i < 4; ++i) {
            const unsigned values = std::array{1u, 2u, 17u, 256u}[random() % 4];
            const auto raw = strip_bytes(random, 1 + random() % (run % 10 == 0 ? 200000 : 3000), values);
            const bool last = i == 3;
            const auto by = random() % 4;
            auto strip = by == 0   ? deflate_whole(raw, 1)
                         : by == 1 ? deflate_by_zlib(raw, last)
                                   : deflate_quickly(raw, last, int(1 + random() % 3));
            if (by == 0 && !last) open_end(strip, raw.size());
            stream.insert(stream.end(), strip.begin(), strip.end());
            all.insert(all.end(), raw.begin(), raw.end());
        }
        ASSERT_EQ(inflated(stream, all.size()), all) << "run " << run;
    }
}

}  // namespace
}  // namespace probewarp
