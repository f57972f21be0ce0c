// BMP in: palettes, masks and run lengths, by hand, since stb_image reads neither run lengths nor masks of
// more than 8 bits.
#include <algorithm>
#include <array>
#include <bit>
#include <limits>

#include "io/bmp_header.h"
#include "io/formats.h"

namespace probewarp {

namespace {

using Rgba = std::array<std::uint8_t, 4>;

/// By the number that a pixel holds. Numbers that the palette does not have are black.
std::array<Rgba, 256> read_colours(const BmpHeader& header) {
    std::array<Rgba, 256> colours{};
    for (std::size_t i = 0; i < colours.size(); ++i) {
        colours[i][3] = 255;
        const std::size_t at = i * header.palette_entry;
        if (at >= header.palette.size()) continue;
        for (std::size_t c = 0; c < 3; ++c) colours[i][c] = std::uint8_t(u8(header.palette, at + 2 - c));
    }
    return colours;
}

/// The first sample of stored row `y`.
template <class Sample>
Sample* row_of(const BmpHeader& header, std::vector<Sample>& rgba, std::size_t y) {
    const std::size_t row = header.top_down ? y : std::size_t(header.height) - 1 - y;
    return rgba.data() + row * std::size_t(header.width) * 4;
}

// ---- run lengths ----

/// The bytes of one run-length encoded picture, and where its next pixel goes.
struct Runs {
    Bytes data;
    std::size_t width, height;
    bool nibbles;  // RLE4
    std::size_t x = 0, y = 0;

    std::uint32_t index(std::uint32_t byte, std::size_t i) const {
        return !nibbles ? byte : i % 2 == 0 ? byte >> 4 : byte & 15;
    }

    /// `count` pixels, a pair of which, or one, comes from each byte that byte_at() gives. What lies beyond
    /// the row is left out.
    template <class ByteAt, class Put>
    void put(std::size_t count, const ByteAt& byte_at, const Put& put_pixel) {
        const std::size_t inside = std::min(count, width - std::min(x, width));
        for (std::size_t i = 0; i < inside; ++i) put_pixel(x + i, y, index(byte_at(nibbles ? i / 2 : i), i));
        x += count;
    }
};

/// Calls put_pixel(x, stored row, index) for each pixel. False where the bytes end before the picture does;
/// a picture that its end mark cuts short is whole.
template <class Put>
bool walk(Runs runs, const Put& put_pixel) {
    Bytes& data = runs.data;
    while (runs.y < runs.height) {
        if (data.size() < 2) return runs.y + 1 == runs.height && runs.x >= runs.width;
        const std::uint32_t count = u8(data, 0), value = u8(data, 1);
        data = data.subspan(2);
        if (count > 0) {
            runs.put(
                count, [&](std::size_t) { return value; }, put_pixel);
        } else if (value == 0) {
            runs.x = 0;
            ++runs.y;
        } else if (value == 1) {
            return true;
        } else if (value == 2) {
            if (data.size() < 2) return false;
            runs.x += u8(data, 0);
            runs.y += u8(data, 1);
            data = data.subspan(2);
        } else {  // that many pixels one by one, in a whole number of 16-bit words
            const std::size_t bytes = runs.nibbles ? (value + 1) / 2 : value;
            const std::size_t there = std::min(bytes, data.size());
            const std::size_t pixels = there == bytes ? value : runs.nibbles ? there * 2 : there;
            runs.put(
                pixels, [&](std::size_t i) { return u8(data, i); }, put_pixel);
            if (there < bytes) return false;
            data = data.subspan(std::min(data.size(), bytes + bytes % 2));
        }
    }
    return true;
}

Image decode_runs(const BmpHeader& header, const DecodeOptions& options) {
    const Runs runs{header.pixels, std::size_t(header.width), std::size_t(header.height), header.bits == 4};
    // Before memory is spent.
    const bool whole = walk(runs, [](std::size_t, std::size_t, std::uint32_t) {});
    if (!whole && !options.salvage) throw incomplete("BMP");
    Image image = blank_image(header.width, header.height, 8);
    image.incomplete = !whole;
    const std::array<Rgba, 256> colours = read_colours(header);
    std::vector<std::uint8_t>& rgba = samples_8(image);
    walk(runs, [&](std::size_t x, std::size_t y, std::uint32_t index) {
        std::copy_n(colours[index].begin(), 4, row_of(header, rgba, y) + x * 4);
    });
    // The pixels that a whole picture passes over have the palette's first colour; all others are opaque.
    for (std::size_t i = 0; whole && i < rgba.size(); i += 4)
        if (rgba[i + 3] == 0) std::copy_n(colours[0].begin(), 4, rgba.begin() + std::ptrdiff_t(i));
    return image;
}

// ---- rows as they are ----

/// Where a colour stands in a pixel.
struct Channel {
    std::uint32_t shift = 0, highest = 0;  // highest: the value that means full intensity; 0: not there

    explicit Channel(std::uint32_t mask)
        : shift(mask ? std::uint32_t(std::countr_zero(mask)) : 0), highest(mask >> shift) {}

    /// Of a pixel, scaled to 0 .. `full`.
    std::uint32_t value(std::uint32_t pixel, std::uint32_t full, std::uint32_t otherwise) const {
        if (highest == 0) return otherwise;
        const std::uint32_t v = pixel >> shift & highest;
        if (highest == full) return v;
        return std::uint32_t((std::uint64_t(v) * full + highest / 2) / highest);
    }
};

/// The first `count` pixels of a row.
template <class Sample>
void read_masked(const BmpHeader& header, Bytes row, std::size_t count, Sample* out) {
    constexpr std::uint32_t full = std::numeric_limits<Sample>::max();
    const std::array<Channel, 4> channels{Channel(header.masks[0]), Channel(header.masks[1]),
                                          Channel(header.masks[2]), Channel(header.masks[3])};
    const std::size_t bytes = header.bits / 8;
    for (std::size_t x = 0; x < count; ++x, out += 4) {
        std::uint32_t pixel = 0;
        for (std::size_t i = bytes; i-- > 0;) pixel = pixel << 8 | u8(row, x * bytes + i);
        for (std::size_t c = 0; c < 4; ++c)
            out[c] = Sample(channels[c].value(pixel, full, c == 3 ? full : 0));
    }
}

void read_indexed(const BmpHeader& header, const std::array<Rgba, 256>& colours, Bytes row, std::size_t count,
                  std::uint8_t* out) {
    const std::size_t bits = header.bits, mask = (std::size_t{1} << bits) - 1;
    for (std::size_t x = 0; x < count; ++x, out += 4) {
        const std::size_t at = x * bits;
        std::copy_n(colours[u8(row, at / 8) >> (8 - bits - at % 8) & mask].begin(), 4, out);
    }
}

/// Hands read_row(bytes, pixels of them, stored row) each row that is there, the last perhaps in part.
template <class ReadRow>
void each_row(const BmpHeader& header, std::size_t row_bytes, const ReadRow& read_row) {
    for (std::size_t y = 0; y < std::size_t(header.height); ++y) {
        const std::size_t start = y * row_bytes;
        if (start >= header.pixels.size()) return;
        const Bytes row = header.pixels.subspan(start, std::min(row_bytes, header.pixels.size() - start));
        read_row(row, std::min(std::size_t(header.width), row.size() * 8 / header.bits), y);
    }
}

Image decode_rows(const BmpHeader& header, const DecodeOptions& options) {
    const std::size_t row_bytes = (std::size_t(header.width) * header.bits + 31) / 32 * 4;
    const bool whole = header.pixels.size() >= row_bytes * std::size_t(header.height);
    if (!whole && !options.salvage) throw incomplete("BMP");
    const bool deep = std::any_of(header.masks.begin(), header.masks.end(),
                                  [](std::uint32_t mask) { return std::popcount(mask) > 8; });
    Image image = blank_image(header.width, header.height, deep ? 16 : 8);
    image.incomplete = !whole;
    if (header.bits <= 8) {
        const std::array<Rgba, 256> colours = read_colours(header);
        each_row(header, row_bytes, [&](Bytes row, std::size_t count, std::size_t y) {
            read_indexed(header, colours, row, count, row_of(header, samples_8(image), y));
        });
    } else {
        std::visit(
            [&](auto& rgba) {
                each_row(header, row_bytes, [&](Bytes row, std::size_t count, std::size_t y) {
                    read_masked(header, row, count, row_of(header, rgba, y));
                });
            },
            image.rgba);
    }
    return image;
}

}  // namespace

Image decode_bmp(Bytes bytes, const DecodeOptions& options) {
    BmpHeader header = read_bmp_header(bytes);
    if (header.pixels.empty()) throw truncated("BMP");
    Image image = header.run_length ? decode_runs(header, options) : decode_rows(header, options);
    image.description = std::move(header.description);
    return image;
}

}  // namespace probewarp
