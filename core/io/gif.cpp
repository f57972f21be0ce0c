// GIF's first frame, by hand: stb_image spends minutes on a stream that names strings beyond the frame
// (lzw.h).
#include <algorithm>
#include <array>

#include "io/formats.h"
#include "io/lzw.h"

namespace probewarp {

namespace {

struct GifFrame {
    std::size_t at = 0;  // its image descriptor in the file; 0: none was found
    int transparent = -1;
};

/// From a block's first sub-block to what follows its last one.
std::size_t skip_sub_blocks(Bytes bytes, std::size_t at) {
    for (;;) {
        if (at >= bytes.size()) throw truncated("GIF");
        const std::size_t size = u8(bytes, at);
        at += 1 + size;
        if (size == 0) return at;
    }
}

std::size_t gif_palette_bytes(std::uint32_t flags) {
    return flags & 0x80 ? std::size_t{6} << (flags & 7) : 0;
}

/// Walks the blocks up to the trailer, through all frames, and returns the first. Throws where the file ends
/// before.
GifFrame survey_gif(Bytes bytes) {
    if (bytes.size() < 13) throw truncated("GIF");
    GifFrame first;
    int transparent = -1;
    for (std::size_t at = 13 + gif_palette_bytes(u8(bytes, 10));;) {
        if (at >= bytes.size()) throw truncated("GIF");
        const std::uint32_t tag = u8(bytes, at);
        if (tag == 0x3B) return first;
        if (tag == 0x21) {
            // A graphic control extension: size 4, flags, delay, transparent colour.
            if (bytes.size() - at > 7 && u8(bytes, at + 1) == 0xF9 && u8(bytes, at + 2) == 4)
                transparent = u8(bytes, at + 3) & 1 ? int(u8(bytes, at + 6)) : -1;
            at = skip_sub_blocks(bytes, at + 2);
        } else if (tag == 0x2C) {
            if (first.at == 0) first = {at, transparent};
            transparent = -1;
            if (bytes.size() - at < 10) throw truncated("GIF");
            at = skip_sub_blocks(bytes, at + 11 + gif_palette_bytes(u8(bytes, at + 9)));
        } else {
            throw damaged("GIF", "it has a block of an unknown kind");
        }
    }
}

/// The frame's colour numbers, in the order in which they are stored. `at`: the LZW stream's first byte.
std::vector<std::uint8_t> gif_indices(Bytes bytes, std::size_t at, std::size_t count) {
    const int literal_bits = int(u8(bytes, at++));
    if (literal_bits < 1 || literal_bits > 8) throw damaged("GIF", "its codes have an impossible length");
    std::size_t left = 0;  // in this sub-block
    const auto next_byte = [&]() -> int {
        if (left == 0) left = u8(bytes, at++);
        if (left == 0) return --at, -1;
        return --left, int(u8(bytes, at++));
    };
    std::vector<std::uint8_t> indices(count);
    const std::ptrdiff_t got = decode_lzw(next_byte, literal_bits, indices);
    if (got != std::ptrdiff_t(count))
        throw damaged("GIF", got < 0 ? "its codes make no sense" : "pixels are missing");
    return indices;
}

/// Which row of the frame the `n`th stored one of an interlaced frame is.
std::vector<int> gif_row_order(int height, bool interlaced) {
    constexpr std::array<std::array<int, 2>, 4> passes{{{0, 8}, {4, 8}, {2, 4}, {1, 2}}};  // first row, step
    std::vector<int> rows;
    for (const auto& [first, step] : passes)
        for (int y = first; interlaced && y < height; y += step) rows.push_back(y);
    for (int y = 0; !interlaced && y < height; ++y) rows.push_back(y);
    return rows;
}

}  // namespace

Image decode_gif(Bytes bytes, const DecodeOptions&) {
    const GifFrame frame = survey_gif(bytes);
    check_image_size(le16(bytes, 6), le16(bytes, 8), 8);
    if (frame.at == 0) throw damaged("GIF", "there is no picture in it");
    const std::size_t left = le16(bytes, frame.at + 1), top = le16(bytes, frame.at + 3);
    const std::size_t width = le16(bytes, frame.at + 5), height = le16(bytes, frame.at + 7);
    if (left + width > le16(bytes, 6) || top + height > le16(bytes, 8) || width == 0 || height == 0)
        throw damaged("GIF", "its first frame does not lie on its canvas");
    const std::uint32_t flags = u8(bytes, frame.at + 9);
    const std::size_t local = gif_palette_bytes(flags), global = gif_palette_bytes(u8(bytes, 10));
    const Bytes palette = local ? bytes.subspan(frame.at + 10, local) : bytes.subspan(13, global);

    const std::vector<std::uint8_t> indices = gif_indices(bytes, frame.at + 10 + local, width * height);
    Image image = blank_image(le16(bytes, 6), le16(bytes, 8), 8);
    auto from = indices.begin();
    // What the frame does not cover, and colours that the palette does not have, stay transparent.
    for (const int row : gif_row_order(int(height), flags & 0x40)) {
        std::size_t to = ((top + std::size_t(row)) * std::size_t(image.width) + left) * 4;
        for (std::size_t x = 0; x < width; ++x, ++from, to += 4) {
            const std::size_t colour = std::size_t{*from} * 3;
            if (colour >= palette.size()) continue;
            for (std::size_t c = 0; c < 3; ++c) samples_8(image)[to + c] = std::uint8_t(palette[colour + c]);
            samples_8(image)[to + 3] = int(*from) == frame.transparent ? 0 : 255;
        }
    }
    return image;
}

}  // namespace probewarp
