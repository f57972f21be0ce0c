// BMP and TGA out through a private copy of stb_image_write, and what describes the colours besides.
#include <algorithm>
#include <array>
#include <span>
#include <string>

#include "io/colours.h"
#include "io/formats.h"
#include "io/tga_extension.h"

#define STBI_WRITE_NO_STDIO
#define STB_IMAGE_WRITE_STATIC
#define STB_IMAGE_WRITE_IMPLEMENTATION
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#pragma GCC diagnostic ignored "-Wconversion"
#include <stb/stb_image_write.h>
#pragma GCC diagnostic pop

namespace probewarp {

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

std::vector<std::byte> encode_stb(StbWriter write, const std::string& label, const Image& image, bool alpha) {
    const std::size_t channels = alpha ? 4 : 3;
    const std::vector<std::uint8_t> pixels = packed(image, channels);
    std::vector<std::byte> out;
    out.reserve(pixels.size() + 1024);
    if (!write(append_bytes, &out, image.width, image.height, int(channels), pixels.data()))
        throw Error("cannot be written as " + label +
                    "; expected a picture whose sides fit into that format");
    return out;
}

void append_le32(std::vector<std::byte>& out, std::size_t value) {
    for (std::size_t i = 0; i < 4; ++i, value >>= 8) out.push_back(std::byte(value & 255));
}

constexpr std::size_t embedded_profile = 0x4D424544, srgb = 0x73524742;  // BMP's kinds of colours

/// BMP's bit for each of ICC's rendering intents.
constexpr std::array<std::size_t, 4> intent_bits{4, 2, 1, 8};

/// A BMP with a header of the fifth version, which says what the colours are, in the place of its own.
/// intent: one of intent_bits; icc: stands behind the pixels; empty: none
std::vector<std::byte> with_colours(Bytes bmp, std::size_t kind, std::size_t intent, Bytes icc) {
    constexpr std::size_t file_header = 14, version_1 = 40, version_5 = 124;
    const std::size_t header = le32(bmp, file_header);
    const Bytes pixels = bmp.subspan(le32(bmp, 10));
    const std::size_t profile_at = version_5 + pixels.size();

    std::vector<std::byte> out(bmp.begin(), bmp.begin() + 2);
    const auto append = [&](Bytes more) { out.insert(out.end(), more.begin(), more.end()); };
    out.reserve(file_header + profile_at + icc.size());
    append_le32(out, file_header + profile_at + icc.size());
    append_le32(out, 0);
    append_le32(out, file_header + version_5);
    append_le32(out, version_5);
    append(bmp.subspan(file_header + 4, version_1 - 4));
    if (header > version_1) append(bmp.subspan(file_header + version_1, 16));  // masks
    out.resize(file_header + 56);
    append_le32(out, kind);
    out.resize(file_header + 108);  // no endpoints and no gamma: these colours need none
    append_le32(out, intent);
    append_le32(out, icc.empty() ? 0 : profile_at);
    append_le32(out, icc.size());
    append_le32(out, 0);
    append(pixels);
    append(icc);
    return out;
}

}  // namespace

std::vector<std::byte> encode_bmp(const Image& image, const EncodeOptions&) {
    std::vector<std::byte> out = encode_stb(stbi_write_bmp_to_func, "BMP", image, has_alpha(image));
    const Description& description = image.description;
    if (description.resolution && is_resolution(description.resolution->x, description.resolution->y))
        for (std::size_t i = 0; i < 4; ++i) {
            out[38 + i] = std::byte(description.resolution->x >> (8 * i) & 255);
            out[42 + i] = std::byte(description.resolution->y >> (8 * i) & 255);
        }
    const std::vector<std::byte> icc = profile_of(description);
    if (!icc.empty()) return with_colours(out, embedded_profile, intent_bits[0], icc);
    if (description.srgb_intent && *description.srgb_intent < intent_bits.size())
        return with_colours(out, srgb, intent_bits[*description.srgb_intent], {});
    return out;
}

std::vector<std::byte> encode_tga(const Image& image, const EncodeOptions&) {
    const bool alpha = has_alpha(image);
    std::vector<std::byte> out = encode_stb(stbi_write_tga_to_func, "TGA", image, alpha);
    append_tga_extension(out, image.description, alpha);
    return out;
}

}  // namespace probewarp
