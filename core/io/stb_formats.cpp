// BMP and TGA in and out through a private copy of stb_image, and GIF and PSD by hand. stb_image gets files
// whose headers we have read and rewritten, memory up to a limit, and an exception where it would read past
// the end.
#include <algorithm>
#include <array>
#include <limits>

#include "io/bmp_header.h"
#include "io/budget.h"
#include "io/formats.h"
#include "io/lzw.h"

namespace {

void* stb_allocate(std::size_t size) { return probewarp::Budget::current()->allocate(size); }
void stb_release(void* data) { probewarp::Budget::current()->release(data); }

struct StbAssertion {};

}  // namespace

#define STBI_MALLOC(size) stb_allocate(size)
#define STBI_REALLOC(data, size) nullptr  // neither BMP nor TGA asks for it
#define STBI_FREE(data) stb_release(data)
#define STBI_ASSERT(condition) ((condition) ? void() : throw StbAssertion{})
#define STBI_MAX_DIMENSIONS probewarp::max_image_side
#define STBI_ONLY_BMP
#define STBI_ONLY_TGA
#define STBI_NO_STDIO
#define STBI_NO_LINEAR
#define STB_IMAGE_STATIC
#define STB_IMAGE_IMPLEMENTATION
#define STBI_WRITE_NO_STDIO
#define STB_IMAGE_WRITE_STATIC
#define STB_IMAGE_WRITE_IMPLEMENTATION
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#pragma GCC diagnostic ignored "-Wconversion"
#include <stb/stb_image.h>
#include <stb/stb_image_write.h>
#pragma GCC diagnostic pop

namespace probewarp {

namespace {

// ---- stb_image ----

/// Copies `count` pixels of 1 to 4 channels (grey, grey and alpha, RGB, RGBA) to RGBA.
void expand(const std::uint8_t* from, std::size_t channels, std::vector<std::uint8_t>& rgba) {
    for (std::size_t i = 0; i < rgba.size(); i += 4, from += channels) {
        rgba[i] = from[0];
        rgba[i + 1] = from[channels < 3 ? 0 : 1];
        rgba[i + 2] = from[channels < 3 ? 0 : 2];
        rgba[i + 3] = channels % 2 == 0 ? from[channels - 1] : std::uint8_t(255);
    }
}

/// Has stb_image decode the parts. Their size was checked by the caller.
Image decode_stb(std::string_view label, std::vector<Bytes> parts) {
    Source source(label, std::move(parts));
    const stbi_io_callbacks callbacks{
        [](void* user, char* to, int size) { return static_cast<Source*>(user)->read(to, size); },
        [](void* user, int size) { static_cast<Source*>(user)->skip(size); },
        [](void* user) { return int(static_cast<Source*>(user)->at_end()); }};
    // One block of pixels, and something for palettes.
    const Budget budget(max_image_bytes + (std::size_t{1} << 20));
    int width = 0, height = 0, channels = 0;
    try {
        const stbi_uc* pixels = stbi_load_from_callbacks(&callbacks, &source, &width, &height, &channels, 0);
        if (!pixels) throw damaged(label, stbi_failure_reason());
        Image image = blank_image(width, height, 8);
        expand(pixels, std::size_t(channels), samples_8(image));
        return image;
    } catch (const StbAssertion&) {
        throw damaged(label, "its header contradicts itself");
    }
}

}  // namespace

// ---- BMP ----

Image decode_bmp(Bytes bytes) {
    const BmpHeader header = read_bmp_header(bytes);
    if (header.pixels < 14 + header.size) throw damaged("BMP", "its pixels start inside its header");
    const std::size_t row_bytes = (std::size_t(header.width) * header.bits + 31) / 32 * 4;
    const std::size_t all_bytes = row_bytes * std::size_t(std::abs(header.height));
    if (bytes.size() < header.pixels || bytes.size() - header.pixels < all_bytes) throw truncated("BMP");

    const std::vector<std::byte> plain = plain_bmp_header(bytes, header);
    Image image = decode_stb("BMP", {plain, bytes.subspan(header.pixels, all_bytes)});
    if (is_resolution(header.resolution.x, header.resolution.y)) image.resolution = header.resolution;
    return image;
}

// ---- TGA ----

namespace {

constexpr std::size_t tga_header = 18;

bool is_tga_depth(std::uint32_t bits) {
    return bits == 8 || bits == 15 || bits == 16 || bits == 24 || bits == 32;
}

/// Pixels stored from right to left, which stb_image overlooks.
void mirror(Image& image) {
    std::vector<std::uint8_t>& rgba = samples_8(image);
    const std::size_t row = std::size_t(image.width) * 4;
    for (std::size_t start = 0; start < rgba.size(); start += row)
        for (std::size_t a = start, b = start + row - 4; a < b; a += 4, b -= 4)
            std::swap_ranges(rgba.begin() + std::ptrdiff_t(a), rgba.begin() + std::ptrdiff_t(a + 4),
                             rgba.begin() + std::ptrdiff_t(b));
}

}  // namespace

bool looks_like_tga(Bytes bytes) {
    if (bytes.size() < tga_header) return false;
    const std::uint32_t type = u8(bytes, 2), bits = u8(bytes, 16);
    if (le16(bytes, 12) == 0 || le16(bytes, 14) == 0) return false;
    if (u8(bytes, 1) == 1)
        return (type == 1 || type == 9) && is_tga_depth(u8(bytes, 7)) && (bits == 8 || bits == 16);
    return u8(bytes, 1) == 0 && (type == 2 || type == 3 || type == 10 || type == 11) && is_tga_depth(bits);
}

Image decode_tga(Bytes bytes) {
    if (!looks_like_tga(bytes)) throw damaged("TGA", "its header makes no sense");
    check_image_size(le16(bytes, 12), le16(bytes, 14), 8);
    std::vector<std::byte> header(bytes.begin(), bytes.begin() + tga_header);
    const std::size_t id_bytes = u8(bytes, 0);
    if (bytes.size() - tga_header < id_bytes) throw truncated("TGA");

    // A palette may leave out its first colours. stb_image takes their number for a number of bytes to pass
    // over, so it gets a palette with those colours in it, black.
    std::vector<std::byte> left_out;
    if (u8(bytes, 1) == 1) {
        const std::uint32_t first = le16(bytes, 3), count = le16(bytes, 5) + first;
        if (count > 65535) throw damaged("TGA", "its palette is too long");
        left_out.resize(std::size_t{first} * ((u8(bytes, 7) + 7) / 8));
        header[3] = header[4] = std::byte{0};
        header[5] = std::byte(count & 255);
        header[6] = std::byte(count >> 8);
    }
    header[0] = std::byte{0};
    Image image = decode_stb("TGA", {header, left_out, bytes.subspan(tga_header + id_bytes)});
    if (u8(bytes, 17) & 0x10u) mirror(image);
    return image;
}

// ---- BMP and TGA, writing ----

namespace {

/// The pixels as 8-bit RGB or RGBA.
std::vector<std::uint8_t> packed(const Image& image, std::size_t channels) {
    std::vector<std::uint8_t> out;
    out.reserve(std::size_t(image.width) * std::size_t(image.height) * channels);
    std::visit(
        [&](const auto& rgba) {
            for (std::size_t i = 0; i < rgba.size(); i += 4)
                for (std::size_t c = 0; c < channels; ++c)
                    if constexpr (sizeof rgba[0] == 2)
                        out.push_back(to_8_bits(rgba[i + c]));
                    else
                        out.push_back(rgba[i + c]);
        },
        image.rgba);
    return out;
}

void append_bytes(void* out, void* data, int size) {
    const auto* first = static_cast<const std::byte*>(data);
    auto& bytes = *static_cast<std::vector<std::byte>*>(out);
    bytes.insert(bytes.end(), first, first + size);
}

using StbWriter = int (*)(stbi_write_func*, void*, int, int, int, const void*);

/// With alpha only where some pixel is not opaque.
std::vector<std::byte> encode_stb(StbWriter write, const Image& image) {
    const std::size_t channels = has_alpha(image) ? 4 : 3;
    const std::vector<std::uint8_t> pixels = packed(image, channels);
    std::vector<std::byte> out;
    out.reserve(pixels.size() + 1024);
    if (!write(append_bytes, &out, image.width, image.height, int(channels), pixels.data()))
        throw Error("cannot be written in this format");
    return out;
}

}  // namespace

std::vector<std::byte> encode_bmp(const Image& image, const EncodeOptions&) {
    std::vector<std::byte> out = encode_stb(stbi_write_bmp_to_func, image);
    if (image.resolution && is_resolution(image.resolution->x, image.resolution->y))
        for (std::size_t i = 0; i < 4; ++i) {
            out[38 + i] = std::byte(image.resolution->x >> (8 * i) & 255);
            out[42 + i] = std::byte(image.resolution->y >> (8 * i) & 255);
        }
    return out;
}

std::vector<std::byte> encode_tga(const Image& image, const EncodeOptions&) {
    return encode_stb(stbi_write_tga_to_func, image);
}

// ---- GIF ----

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

Image decode_gif(Bytes bytes) {
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

// ---- PSD ----

// By hand, because stb_image reads 16-bit run-length encoded files wrongly and computes beyond what its
// numbers can hold where colours and alpha contradict each other.

namespace {

struct Psd {
    std::size_t channels = 0, width = 0, height = 0;
    std::size_t sample_bytes = 1;
    std::size_t colours = 3;  // 1: grey
    bool packed = false;      // each row by PackBits
    Bytes lengths;            // of the packed rows: channels x height, 16-bit big-endian each
    Bytes data;               // rows, channel by channel

    std::size_t row_bytes() const { return width * sample_bytes; }
};

/// Past the three sections before the merged picture, to the two bytes that say how it is packed.
std::size_t skip_psd_sections(Bytes bytes) {
    std::size_t at = 26;
    for (int section = 0; section < 3; ++section) {
        if (bytes.size() - at < 4) throw truncated("PSD");
        const std::size_t length = be32(bytes, at);
        if (length > bytes.size() - at - 4) throw truncated("PSD");
        at += 4 + length;
    }
    if (bytes.size() - at < 2) throw truncated("PSD");
    return at;
}

Psd read_psd_header(Bytes bytes) {
    if (bytes.size() < 26) throw truncated("PSD");
    if (be16(bytes, 4) != 1) throw Error("is a PSD of a version that cannot be read; expected version 1");
    Psd psd;
    psd.channels = be16(bytes, 12);
    psd.height = be32(bytes, 14);
    psd.width = be32(bytes, 18);
    const std::uint32_t bits = be16(bytes, 22), mode = be16(bytes, 24);
    if (bits != 8 && bits != 16)
        throw Error("has " + std::to_string(bits) + " bits a channel; expected a PSD with 8 or 16");
    if (mode != 1 && mode != 3) throw Error("is neither RGB nor grey; expected a PSD in one of these modes");
    check_image_size((long long)(psd.width), (long long)(psd.height), int(bits));
    psd.sample_bytes = bits / 8;
    psd.colours = mode == 1 ? 1 : 3;
    if (psd.channels < psd.colours || psd.channels > 56)
        throw damaged("PSD", "it has too few or too many channels");
    return psd;
}

/// Where the rows are, after a check that all of them are there.
void find_psd_rows(Psd& psd, Bytes bytes) {
    const std::size_t at = skip_psd_sections(bytes), rows = psd.channels * psd.height;
    const std::uint32_t compression = be16(bytes, at);
    if (compression > 1)
        throw Error("is packed in an unusual way; expected a PSD whose merged picture is RLE or raw");
    psd.packed = compression == 1;
    psd.data = bytes.subspan(at + 2);
    std::size_t needed = rows * psd.row_bytes();
    if (psd.packed) {
        if (psd.data.size() < rows * 2) throw truncated("PSD");
        psd.lengths = psd.data.first(rows * 2);
        psd.data = psd.data.subspan(rows * 2);
        needed = 0;
        for (std::size_t row = 0; row < rows; ++row) needed += be16(psd.lengths, row * 2);
    }
    if (psd.data.size() < needed) throw truncated("PSD");
}

/// PackBits: 0 to 127: that many bytes and one more follow; 129 to 255: the next byte 257 minus that many
/// times.
void unpack_bits(Bytes from, std::span<std::byte> to) {
    while (!to.empty()) {
        if (from.size() < 2) throw damaged("PSD", "a row is too short");
        const std::size_t code = u8(from, 0);
        if (code == 128) {
            from = from.subspan(1);
            continue;
        }
        const std::size_t count = code < 128 ? code + 1 : 257 - code, stored = code < 128 ? count : 1;
        if (count > to.size() || stored > from.size() - 1) throw damaged("PSD", "a row has the wrong length");
        for (std::size_t i = 0; i < count; ++i) to[i] = from[stored == 1 ? 1 : 1 + i];
        from = from.subspan(1 + stored);
        to = to.subspan(count);
    }
}

/// One channel into the samples from `out` on, four apart.
template <class Sample>
void read_psd_channel(Psd& psd, std::size_t channel, Sample* out) {
    std::vector<std::byte> row(psd.row_bytes());
    for (std::size_t y = 0; y < psd.height; ++y) {
        const std::size_t stored =
            psd.packed ? be16(psd.lengths, (channel * psd.height + y) * 2) : row.size();
        if (psd.packed)
            unpack_bits(psd.data.first(stored), row);
        else
            std::copy_n(psd.data.begin(), stored, row.begin());
        psd.data = psd.data.subspan(stored);
        for (std::size_t x = 0; x < psd.width; ++x, out += 4)
            *out = Sample(sizeof(Sample) == 2 ? be16(row, x * 2) : u8(row, x));
    }
}

/// Whether the colours can have been merged onto white, as Photoshop does with what is partly transparent:
/// then none is darker than its alpha lets white shine through. Other programs write them unmixed, and
/// nothing in the file says so.
template <class Sample>
bool on_white(const std::vector<Sample>& rgba) {
    constexpr int full = std::numeric_limits<Sample>::max(), rounding = full / 128;
    for (std::size_t i = 0; i < rgba.size(); ++i)
        if (i % 4 != 3 && rgba[i - i % 4 + 3] != 0 && rgba[i] + rgba[i - i % 4 + 3] < full - rounding)
            return false;
    return true;
}

/// Takes the white out again.
template <class Sample>
void remove_white(std::vector<Sample>& rgba) {
    constexpr std::int64_t full = std::numeric_limits<Sample>::max();
    for (std::size_t i = 0; i < rgba.size(); i += 4) {
        const std::int64_t alpha = rgba[i + 3];
        if (alpha == 0 || alpha == full) continue;
        for (std::size_t c = 0; c < 3; ++c) {
            const std::int64_t above = std::max<std::int64_t>(rgba[i + c] - (full - alpha), 0);
            rgba[i + c] = Sample((above * full + alpha / 2) / alpha);
        }
    }
}

template <class Sample>
void read_psd_pixels(Psd& psd, std::vector<Sample>& rgba) {
    for (std::size_t c = 0; c < psd.colours; ++c) read_psd_channel(psd, c, rgba.data() + c);
    for (std::size_t i = 0; psd.colours == 1 && i < rgba.size(); i += 4) rgba[i + 1] = rgba[i + 2] = rgba[i];
    if (psd.channels > psd.colours) {
        read_psd_channel(psd, psd.colours, rgba.data() + 3);
        if (on_white(rgba)) remove_white(rgba);
    } else {
        for (std::size_t i = 3; i < rgba.size(); i += 4) rgba[i] = std::numeric_limits<Sample>::max();
    }
}

}  // namespace

Image decode_psd(Bytes bytes) {
    Psd psd = read_psd_header(bytes);
    find_psd_rows(psd, bytes);
    Image image = blank_image((long long)(psd.width), (long long)(psd.height), int(psd.sample_bytes * 8));
    std::visit([&](auto& rgba) { read_psd_pixels(psd, rgba); }, image.rgba);
    return image;
}

}  // namespace probewarp
