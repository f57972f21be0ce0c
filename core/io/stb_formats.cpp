// BMP and TGA in and out through a private copy of stb_image, which gets files whose headers we have read and
// rewritten, memory up to a limit, and an exception where it would read past the end.
#include <algorithm>
#include <array>
#include <limits>

#include "io/bmp_header.h"
#include "io/budget.h"
#include "io/formats.h"

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

Image decode_bmp(Bytes bytes, const DecodeOptions&) {
    const BmpHeader header = read_bmp_header(bytes);
    if (header.pixels < 14 + header.size) throw damaged("BMP", "its pixels start inside its header");
    const std::size_t row_bytes = (std::size_t(header.width) * header.bits + 31) / 32 * 4;
    const std::size_t all_bytes = row_bytes * std::size_t(std::abs(header.height));
    if (bytes.size() < header.pixels || bytes.size() - header.pixels < all_bytes) throw truncated("BMP");

    const std::vector<std::byte> plain = plain_bmp_header(bytes, header);
    Image image = decode_stb("BMP", {plain, bytes.subspan(header.pixels, all_bytes)});
    if (is_resolution(header.resolution.x, header.resolution.y))
        image.description.resolution = header.resolution;
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

Image decode_tga(Bytes bytes, const DecodeOptions&) {
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
    if (image.description.resolution &&
        is_resolution(image.description.resolution->x, image.description.resolution->y))
        for (std::size_t i = 0; i < 4; ++i) {
            out[38 + i] = std::byte(image.description.resolution->x >> (8 * i) & 255);
            out[42 + i] = std::byte(image.description.resolution->y >> (8 * i) & 255);
        }
    return out;
}

std::vector<std::byte> encode_tga(const Image& image, const EncodeOptions&) {
    return encode_stb(stbi_write_tga_to_func, image);
}

}  // namespace probewarp
