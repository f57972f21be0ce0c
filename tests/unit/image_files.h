// Picture files made for the tests: by the libraries' encoders where those can write the kind, else byte by
// byte. The readers under test have no part in it.
#pragma once

#include <cstdint>
#include <cstdio>  // jpeglib.h needs it and does not say so
#include <cstdlib>

#include <jpeglib.h>
#include <spng.h>
#include <zlib.h>

#include <algorithm>
#include <functional>
#include <initializer_list>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace probewarp::testing {

using File = std::vector<std::byte>;

inline File& operator+=(File& file, const File& more) {
    file.insert(file.end(), more.begin(), more.end());
    return file;
}

inline File bytes_of(std::string_view text) {
    const auto* first = reinterpret_cast<const std::byte*>(text.data());
    return {first, first + text.size()};
}

inline File bytes(std::initializer_list<int> values) {
    File file;
    for (const int v : values) file.push_back(std::byte(v));
    return file;
}

/// `count` bytes of `value`, the low ones first or last.
inline File le(std::size_t count, std::uint64_t value) {
    File file;
    for (std::size_t i = 0; i < count; ++i) file.push_back(std::byte(value >> (8 * i) & 255));
    return file;
}
inline File be(std::size_t count, std::uint64_t value) {
    const File little = le(count, value);
    return {little.rbegin(), little.rend()};
}

inline File join(std::initializer_list<File> parts) {
    File file;
    for (const File& part : parts) file += part;
    return file;
}

// ---- PNG ----

inline File png_chunk(std::string_view type, const File& data) {
    const File body = join({bytes_of(type), data});
    const auto crc = crc32(0, reinterpret_cast<const Bytef*>(body.data()), uInt(body.size()));
    return join({be(4, data.size()), body, be(4, crc)});
}

inline const File png_signature = bytes_of("\x89PNG\r\n\x1a\n");

inline File png_header(std::uint32_t width, std::uint32_t height, int depth, int type, int interlace = 0) {
    return png_chunk("IHDR", join({be(4, width), be(4, height), bytes({depth, type, 0, 0, interlace})}));
}

inline File deflated(const File& data) {
    uLongf size = compressBound(uLong(data.size()));
    File out(size);
    compress2(reinterpret_cast<Bytef*>(out.data()), &size, reinterpret_cast<const Bytef*>(data.data()),
              uLong(data.size()), 9);
    out.resize(size);
    return out;
}

/// A zlib stream of `mebibytes` MiB of zeros, quickly: the same flushed block again and again.
inline File deflate_bomb(std::size_t mebibytes) {
    z_stream stream{};
    deflateInit2(&stream, 9, Z_DEFLATED, -15, 8, Z_DEFAULT_STRATEGY);
    std::vector<Bytef> zeros(1 << 20), block(1 << 14);
    stream.next_in = zeros.data();
    stream.avail_in = uInt(zeros.size());
    stream.next_out = block.data();
    stream.avail_out = uInt(block.size());
    deflate(&stream, Z_FULL_FLUSH);
    block.erase(block.end() - stream.avail_out, block.end());
    deflateEnd(&stream);

    File file = bytes({0x78, 0xDA});
    for (std::size_t i = 0; i < mebibytes; ++i)
        file += File(as_bytes(std::span(block)).begin(), as_bytes(std::span(block)).end());
    return join({file, bytes({3, 0}), be(4, 1)});  // an empty last block, a checksum
}

struct PngSpec {
    std::uint32_t width = 0, height = 0;
    int depth = 8, type = SPNG_COLOR_TYPE_TRUECOLOR;
    bool interlaced = false;
    std::vector<std::uint16_t> samples;  // height x width x channels
    spng_plte palette{};
    spng_trns transparency{};
    bool transparent = false;
};

/// The rows as libspng wants them: below 8 bits packed, from the high bit on.
inline File packed_rows(const PngSpec& spec) {
    const std::size_t per_row = spec.samples.size() / spec.height;
    File rows;
    for (std::uint32_t y = 0; y < spec.height; ++y) {
        unsigned byte = 0;
        int bits = 0;
        for (std::size_t i = 0; i < per_row; ++i) {
            const std::uint16_t sample = spec.samples[y * per_row + i];
            if (spec.depth == 16) {
                rows += File(reinterpret_cast<const std::byte*>(&sample),
                             reinterpret_cast<const std::byte*>(&sample) + 2);
                continue;
            }
            byte = byte << spec.depth | sample;
            bits += spec.depth;
            if (i + 1 == per_row) byte <<= 8 - bits, bits = 8;
            if (bits == 8) rows.push_back(std::byte(byte & 255)), bits = 0, byte = 0;
        }
    }
    return rows;
}

inline File make_png(PngSpec spec) {
    spng_ctx* context = spng_ctx_new(SPNG_CTX_ENCODER);
    spng_set_option(context, SPNG_ENCODE_TO_BUFFER, 1);
    spng_ihdr ihdr{spec.width, spec.height, std::uint8_t(spec.depth), std::uint8_t(spec.type),
                   0,          0,           spec.interlaced};
    spng_set_ihdr(context, &ihdr);
    if (spec.palette.n_entries > 0) spng_set_plte(context, &spec.palette);
    if (spec.transparent) spng_set_trns(context, &spec.transparency);
    const File rows = packed_rows(spec);
    int error = spng_encode_image(context, rows.data(), rows.size(), SPNG_FMT_PNG, SPNG_ENCODE_FINALIZE);
    std::size_t size = 0;
    auto* buffer = error ? nullptr : static_cast<std::byte*>(spng_get_png_buffer(context, &size, &error));
    const File file = buffer ? File(buffer, buffer + size) : File{};
    std::free(buffer);
    spng_ctx_free(context);
    return file;
}

// ---- JPEG ----

/// `samples`: height x width x components. `adjust` may change parameters before the first row.
inline File make_jpeg(int width, int height, int components, J_COLOR_SPACE space,
                      std::vector<std::uint8_t> samples,
                      const std::function<void(jpeg_compress_struct&)>& adjust = {}) {
    jpeg_compress_struct jpeg{};
    jpeg_error_mgr errors{};
    jpeg.err = jpeg_std_error(&errors);
    jpeg_create_compress(&jpeg);
    unsigned char* out = nullptr;
    unsigned long size = 0;
    jpeg_mem_dest(&jpeg, &out, &size);
    jpeg.image_width = JDIMENSION(width);
    jpeg.image_height = JDIMENSION(height);
    jpeg.input_components = components;
    jpeg.in_color_space = space;
    jpeg_set_defaults(&jpeg);
    jpeg_set_quality(&jpeg, 100, TRUE);
    if (adjust) adjust(jpeg);
    jpeg_start_compress(&jpeg, TRUE);
    for (int y = 0; y < height; ++y) {
        JSAMPROW row = samples.data() + std::size_t(y) * samples.size() / std::size_t(height);
        jpeg_write_scanlines(&jpeg, &row, 1);
    }
    jpeg_finish_compress(&jpeg);
    jpeg_destroy_compress(&jpeg);
    const File file(reinterpret_cast<std::byte*>(out), reinterpret_cast<std::byte*>(out) + size);
    std::free(out);
    return file;
}

/// An APP1 marker with EXIF's orientation, and a resolution where `dots_per_centimetre` is not 0.
inline File exif_marker(int orientation, int dots_per_centimetre = 0) {
    const auto entry = [](int tag, int type, int value) {
        return join({le(2, unsigned(tag)), le(2, unsigned(type)), le(4, 1), le(4, unsigned(value))});
    };
    const int count = dots_per_centimetre ? 4 : 1, rational = 8 + 2 + count * 12 + 4;
    File tiff =
        join({bytes_of("II*"), bytes({0}), le(4, 8), le(2, unsigned(count)), entry(0x112, 3, orientation)});
    if (dots_per_centimetre)
        tiff += join({entry(0x11A, 5, rational), entry(0x11B, 5, rational), entry(0x128, 3, 3)});
    tiff += le(4, 0);
    if (dots_per_centimetre) tiff += join({le(4, unsigned(dots_per_centimetre)), le(4, 1)});
    return join({bytes({0xFF, 0xE1}), be(2, tiff.size() + 8), bytes_of("Exif"), bytes({0, 0}), tiff});
}

/// The file with `marker` right behind its first two bytes.
inline File with_marker(const File& jpeg, const File& marker) {
    return join({File(jpeg.begin(), jpeg.begin() + 2), marker, File(jpeg.begin() + 2, jpeg.end())});
}

// ---- BMP, TGA, GIF ----

/// With a 40-byte header unless `core`. `between`: masks or a palette. `height` < 0: from the top down.
inline File make_bmp(int width, int height, int bits, int compression, const File& between,
                     const File& pixels, bool core = false) {
    const std::size_t header = core ? 12 : 40, offset = 14 + header + between.size();
    const std::size_t wide = core ? 2 : 4;
    const auto number = [](int v) { return std::uint64_t(std::uint32_t(v)); };
    File file = join({bytes_of("BM"), le(4, offset + pixels.size()), le(4, 0), le(4, offset), le(4, header),
                      le(wide, number(width)), le(wide, number(height)), le(2, 1), le(2, number(bits))});
    if (!core)
        file += join({le(4, number(compression)), le(4, 0), le(4, 2000), le(4, 3000), le(4, 0), le(4, 0)});
    return join({file, between, pixels});
}

inline File make_tga(int width, int height, int type, int bits, int descriptor, const File& data) {
    return join({bytes({0, 0, type, 0, 0, 0, 0, 0, 0, 0, 0, 0}), le(2, std::uint64_t(width)),
                 le(2, std::uint64_t(height)), bytes({bits, descriptor}), data});
}

/// LZW data with 8-bit literals and a clear code before each 200 of them, so that the codes stay 9 bits long.
inline File lzw(const std::vector<int>& indices) {
    File data;
    std::uint32_t bits = 0;
    int count = 0;
    const auto put = [&](std::uint32_t code) {
        bits |= code << count;
        for (count += 9; count >= 8; count -= 8, bits >>= 8) data.push_back(std::byte(bits & 255));
    };
    for (std::size_t i = 0; i < indices.size(); ++i) {
        if (i % 200 == 0) put(256);
        put(std::uint32_t(indices[i]));
    }
    put(257);
    if (count > 0) data.push_back(std::byte(bits & 255));
    return data;
}

/// LZW as GIF's writers do it, 8-bit literals, codes of 9 to 12 bits. Once the table is full it stays as it
/// is.
inline File lzw_compressed(const std::vector<int>& indices) {
    File data;
    std::uint32_t bits = 0;
    int count = 0, width = 9, next = 258;
    const auto put = [&](int code) {
        bits |= std::uint32_t(code) << count;
        for (count += width; count >= 8; count -= 8, bits >>= 8) data.push_back(std::byte(bits & 255));
    };
    std::map<std::pair<int, int>, int> table;  // a string's code and one more index: the code of both
    put(256);
    int string = indices[0];
    for (std::size_t i = 1; i < indices.size(); ++i) {
        const auto longer = table.find({string, indices[i]});
        if (longer != table.end()) {
            string = longer->second;
            continue;
        }
        put(string);
        if (next < 4096) {
            if (next == 1 << width) ++width;
            table[{string, indices[i]}] = next++;
        }
        string = indices[i];
    }
    put(string);
    if (next < 4096 && next == 1 << width) ++width;
    put(257);
    data.push_back(std::byte(bits & 255));
    return data;
}

inline File sub_blocks(const File& data) {
    File file;
    for (std::size_t at = 0; at < data.size(); at += 255) {
        const std::size_t size = std::min<std::size_t>(255, data.size() - at);
        file.push_back(std::byte(size));
        file += File(data.begin() + std::ptrdiff_t(at), data.begin() + std::ptrdiff_t(at + size));
    }
    return join({file, bytes({0})});
}

/// One frame on a canvas with the palette black, red, green, blue, and `before` it (extensions).
inline File make_gif(int width, int height, int left, int top, int frame_width, int frame_height,
                     bool interlaced, const File& before, const File& lzw_data) {
    const auto two = [](int v) { return le(2, std::uint64_t(v)); };
    return join({bytes_of("GIF89a"), two(width), two(height), bytes({0x81, 0, 0}),
                 bytes({0, 0, 0, 255, 0, 0, 0, 255, 0, 0, 0, 255}), before, bytes({0x2C}), two(left),
                 two(top), two(frame_width), two(frame_height), bytes({interlaced ? 0x40 : 0, 8}),
                 sub_blocks(lzw_data), bytes({0x3B})});
}

}  // namespace probewarp::testing
