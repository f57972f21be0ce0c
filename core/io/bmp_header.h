// BMP's headers, in all their versions, read and then written as the one that stb_image reads best. Private
// to io; inline, for stb_formats.cpp alone needs it.
#pragma once

#include <algorithm>
#include <array>
#include <cstdlib>
#include <string>
#include <vector>

#include "io/formats.h"

namespace probewarp {

struct BmpHeader {
    std::size_t size = 0;    // of the information header, which starts at byte 14
    std::size_t pixels = 0;  // where they start in the file
    std::int32_t width = 0;
    std::int64_t height = 0;  // negative: rows from the top down
    std::uint32_t bits = 0;   // a pixel
    bool masked = false;
    std::array<std::uint32_t, 4> masks{};  // red, green, blue, alpha
    std::uint32_t colours = 0;
    Resolution resolution;
};

inline void read_bmp_compression(Bytes bytes, BmpHeader& header) {
    const std::uint32_t compression = le32(bytes, 30);
    const bool with_alpha = compression == 6;
    header.masked = compression == 3 || with_alpha;
    if (compression == 1 || compression == 2)
        throw Error("is run-length encoded; expected an uncompressed BMP file");
    if ((compression != 0 && !header.masked) || (header.masked && (header.bits < 16 || header.size == 64)))
        throw Error("is packed in an unusual way; expected an uncompressed BMP file");
    if (!header.masked) return;
    // Either the header is long enough for the masks, or they follow it: in both cases they stand here.
    const std::size_t count = with_alpha || header.size >= 56 ? 4 : 3;
    if (bytes.size() < 54 + 4 * count) throw truncated("BMP");
    for (std::size_t i = 0; i < count; ++i) {
        const std::uint32_t mask = header.masks[i] = le32(bytes, 54 + 4 * i);
        const std::uint32_t lowest = mask & (~mask + 1);
        if (((mask + lowest) & mask) != 0) throw damaged("BMP", "the bits of a colour do not stand together");
    }
}

inline BmpHeader read_bmp_header(Bytes bytes) {
    if (bytes.size() < 26) throw truncated("BMP");
    BmpHeader header;
    header.pixels = le32(bytes, 10);
    header.size = le32(bytes, 14);
    constexpr std::array<std::size_t, 7> sizes{12, 40, 52, 56, 64, 108, 124};
    if (std::find(sizes.begin(), sizes.end(), header.size) == sizes.end())
        throw damaged("BMP", "its header has an unknown length");
    if (bytes.size() < 14 + header.size) throw truncated("BMP");
    if (header.size == 12) {
        header.width = std::int32_t(le16(bytes, 18));
        header.height = le16(bytes, 20);
        header.bits = le16(bytes, 24);
    } else {
        header.width = std::int32_t(le32(bytes, 18));
        header.height = std::int32_t(le32(bytes, 22));
        header.bits = le16(bytes, 28);
        header.resolution = {le32(bytes, 38), le32(bytes, 42)};
        header.colours = le32(bytes, 46);
        read_bmp_compression(bytes, header);
    }
    constexpr std::array<std::uint32_t, 6> depths{1, 4, 8, 16, 24, 32};
    if (std::find(depths.begin(), depths.end(), header.bits) == depths.end())
        throw damaged("BMP", "it has " + std::to_string(header.bits) + " bits a pixel");
    check_image_size(header.width, std::abs(header.height), 8);
    return header;
}

inline void append_le(std::vector<std::byte>& out, std::size_t count, std::uint32_t value) {
    for (std::size_t i = 0; i < count; ++i, value >>= 8) out.push_back(std::byte(value & 255));
}

/// The palette, made as long as the pixels' bits can count: stb_image would look beyond a shorter one's end.
inline void append_palette(std::vector<std::byte>& out, Bytes bytes, const BmpHeader& header) {
    const std::size_t start = 14 + header.size, entry = header.size == 12 ? 3 : 4;
    const std::size_t full = std::size_t{1} << header.bits;
    std::size_t count = std::min(full, (header.pixels - start) / entry);
    if (header.colours > 0) count = std::min<std::size_t>(count, header.colours);
    if (count == 0) throw damaged("BMP", "it has no palette");
    for (std::size_t i = 0; i < full; ++i)
        for (std::size_t k = 0; k < 4; ++k)
            out.push_back(i < count && k < 3 ? bytes[start + i * entry + k] : std::byte{0});
}

/// The header once more, in the one shape that stb_image reads best: version 4, masks in it, nothing else.
inline std::vector<std::byte> plain_bmp_header(Bytes bytes, const BmpHeader& header) {
    const std::uint32_t palette_bytes = header.bits <= 8 ? 4u << header.bits : 0;
    std::vector<std::byte> out{std::byte{'B'}, std::byte{'M'}};
    append_le(out, 4, 0);
    append_le(out, 4, 0);
    append_le(out, 4, 14 + 108 + palette_bytes);
    append_le(out, 4, 108);
    append_le(out, 4, std::uint32_t(header.width));
    append_le(out, 4, std::uint32_t(header.height));
    append_le(out, 2, 1);
    append_le(out, 2, header.bits);
    append_le(out, 4, header.masked ? 3 : 0);
    for (int i = 0; i < 5; ++i) append_le(out, 4, 0);
    for (const std::uint32_t mask : header.masks) append_le(out, 4, mask);
    while (out.size() < 14 + 108) out.push_back(std::byte{0});
    if (header.bits <= 8) append_palette(out, bytes, header);
    return out;
}

}  // namespace probewarp
