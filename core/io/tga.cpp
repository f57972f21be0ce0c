// TGA in, by hand: stb_image takes the fourth byte for alpha whatever the descriptor says, and stops at a
// palette that is not used. TGA has no signature, so its header is looked at closely.
#include <algorithm>
#include <array>
#include <limits>
#include <optional>
#include <vector>

#include "io/formats.h"
#include "io/tga_extension.h"

namespace probewarp {

namespace {

using Rgba = std::array<std::uint8_t, 4>;

constexpr std::size_t header_bytes = 18;
constexpr std::size_t entry_bytes(std::uint32_t bits) { return (bits + 7) / 8; }

struct TgaHeader {
    std::uint32_t id_bytes, palette_type, type;
    std::uint32_t first_colour, colours, colour_bits;  // of the palette, which may be there without a use
    std::uint32_t width, height, bits, descriptor;

    bool run_length() const { return type >= 9; }
    bool indexed() const { return (type & 7) == 1; }
    bool grey() const { return (type & 7) == 3; }
    std::uint32_t attribute_bits() const { return descriptor & 15; }
    std::size_t pixel_bytes() const { return entry_bytes(bits); }
    std::size_t pixels() const { return std::size_t(width) * height; }
    std::size_t palette_bytes() const {
        return palette_type == 1 ? std::size_t(colours) * entry_bytes(colour_bits) : 0;
    }
    /// Where the pixels start in the file.
    std::size_t pixels_at() const { return header_bytes + id_bytes + palette_bytes(); }
};

/// Requires header_bytes.
TgaHeader read_header(Bytes bytes) {
    return {u8(bytes, 0), u8(bytes, 1),    u8(bytes, 2),    le16(bytes, 3), le16(bytes, 5),
            u8(bytes, 7), le16(bytes, 12), le16(bytes, 14), u8(bytes, 16),  u8(bytes, 17)};
}

bool is_colour_depth(std::uint32_t bits) { return bits == 15 || bits == 16 || bits == 24 || bits == 32; }

bool makes_sense(const TgaHeader& header) {
    if (header.width == 0 || header.height == 0 || header.palette_type > 1) return false;
    if (header.type == 0 || (header.type & ~8u) > 3 || (header.type & 7) == 0) return false;
    if (header.indexed())
        return header.palette_type == 1 && is_colour_depth(header.colour_bits) &&
               (header.bits == 8 || header.bits == 16);
    if (header.palette_type == 1 && header.colours > 0 && !is_colour_depth(header.colour_bits)) return false;
    return header.grey() ? header.bits == 8 || header.bits == 16 : is_colour_depth(header.bits);
}

/// How many pixels the data hold, at most those of the picture, and in how many bytes.
struct Extent {
    std::size_t pixels = 0, bytes = 0;
};

/// Calls put_run(number of pixels, their bytes, whether they are one pixel that is repeated) for each packet.
template <class PutRun>
Extent walk_packets(const TgaHeader& header, Bytes data, const PutRun& put_run) {
    const std::size_t total = header.pixels(), size = header.pixel_bytes();
    Extent done;
    while (done.pixels < total && done.bytes < data.size()) {
        const std::uint32_t packet = u8(data, done.bytes);
        const bool repeated = (packet & 0x80u) != 0;
        const std::size_t count = std::min<std::size_t>((packet & 0x7Fu) + 1, total - done.pixels);
        const Bytes rest = data.subspan(done.bytes + 1);
        const std::size_t there =
            repeated ? (rest.size() >= size ? count : 0) : std::min(count, rest.size() / size);
        put_run(there, rest, repeated);
        done.pixels += there;
        done.bytes += 1 + (repeated ? size : there * size);
    }
    return done;
}

template <class PutRun>
Extent walk(const TgaHeader& header, Bytes data, const PutRun& put_run) {
    if (header.run_length()) return walk_packets(header, data, put_run);
    const std::size_t there = std::min(header.pixels(), data.size() / header.pixel_bytes());
    put_run(there, data, false);
    return {there, there * header.pixel_bytes()};
}

Extent measure(const TgaHeader& header, Bytes data) {
    return walk(header, data, [](std::size_t, Bytes, bool) {});
}

// ---- colours ----

std::uint8_t from_five_bits(std::uint32_t v) { return std::uint8_t(((v & 31) * 255 + 15) / 31); }

/// A colour of 15 to 32 bits. attributes: whether its last bits are alpha.
Rgba colour_at(Bytes bytes, std::uint32_t bits, bool attributes) {
    if (bits <= 16) {
        const std::uint32_t v = le16(bytes, 0);
        const bool clear = bits == 16 && attributes && (v & 0x8000u) == 0;
        return {from_five_bits(v >> 10), from_five_bits(v >> 5), from_five_bits(v),
                std::uint8_t(clear ? 0 : 255)};
    }
    return {std::uint8_t(u8(bytes, 2)), std::uint8_t(u8(bytes, 1)), std::uint8_t(u8(bytes, 0)),
            std::uint8_t(bits == 32 && attributes ? u8(bytes, 3) : 255)};
}

/// Turns a pixel's bytes into its colour.
class Colours {
  public:
    Colours(const TgaHeader& header, Bytes palette, bool attributes)
        : header_(header), attributes_(attributes) {
        if (!header.indexed()) return;
        const std::size_t size = entry_bytes(header.colour_bits);
        for (std::size_t i = 0; i < header.colours; ++i)
            palette_.push_back(colour_at(palette.subspan(i * size), header.colour_bits, attributes));
    }

    Rgba operator()(Bytes pixel) const {
        if (header_.indexed()) {
            const std::size_t number = header_.bits == 8 ? u8(pixel, 0) : le16(pixel, 0);
            const std::size_t index = number - header_.first_colour;  // wraps around below the first
            return index < palette_.size() ? palette_[index] : Rgba{0, 0, 0, 255};
        }
        if (header_.grey()) {
            const auto v = std::uint8_t(u8(pixel, 0));
            return {v, v, v, std::uint8_t(header_.bits == 16 && attributes_ ? u8(pixel, 1) : 255)};
        }
        return colour_at(pixel, header_.bits, attributes_);
    }

  private:
    const TgaHeader& header_;
    bool attributes_;
    std::vector<Rgba> palette_;
};

/// Puts pixels into their places in the order in which they are stored, which may start in any corner.
class Canvas {
  public:
    Canvas(const TgaHeader& header, std::vector<std::uint8_t>& rgba)
        : width_(header.width),
          height_(header.height),
          leftward_((header.descriptor & 0x10u) != 0),
          downward_((header.descriptor & 0x20u) != 0),
          rgba_(rgba) {}

    void put(const Rgba& colour) {
        const std::size_t row = downward_ ? y_ : height_ - 1 - y_, column = leftward_ ? width_ - 1 - x_ : x_;
        std::copy_n(colour.begin(), 4, rgba_.begin() + std::ptrdiff_t((row * width_ + column) * 4));
        if (++x_ == width_) x_ = 0, ++y_;
    }

  private:
    std::size_t width_, height_, x_ = 0, y_ = 0;
    bool leftward_, downward_;
    std::vector<std::uint8_t>& rgba_;
};

void read_pixels(const TgaHeader& header, Bytes data, const Colours& colours, Canvas canvas) {
    const std::size_t size = header.pixel_bytes();
    walk(header, data, [&](std::size_t count, Bytes pixels, bool repeated) {
        if (count == 0) return;
        Rgba colour = colours(pixels);
        for (std::size_t i = 0; i < count; ++i) {
            if (!repeated) colour = colours(pixels.subspan(i * size));
            canvas.put(colour);
        }
    });
}

/// Colours that were multiplied by their alpha become straight ones.
void divide_by_alpha(std::vector<std::uint8_t>& rgba) {
    for (std::size_t i = 0; i < rgba.size(); i += 4) {
        const std::uint32_t alpha = rgba[i + 3];
        for (std::size_t c = 0; c < 3 && alpha > 0; ++c)
            rgba[i + c] = std::uint8_t(std::min((rgba[i + c] * 255u + alpha / 2) / alpha, 255u));
    }
}

}  // namespace

bool looks_like_tga(Bytes bytes) { return bytes.size() >= header_bytes && makes_sense(read_header(bytes)); }

bool is_surely_tga(Bytes bytes) {
    if (!looks_like_tga(bytes)) return false;
    if (has_tga_footer(bytes)) return true;
    const TgaHeader header = read_header(bytes);
    const bool no_palette = header.first_colour == 0 && header.colours == 0 && header.colour_bits == 0;
    if (header.palette_type == 0 && !no_palette) return false;
    if (header.attribute_bits() > 8 || header.descriptor > 0x3F) return false;
    if (header.pixels_at() > bytes.size()) return false;
    const Bytes data = bytes.subspan(header.pixels_at());
    const Extent extent = measure(header, data);
    return extent.pixels == header.pixels() && extent.bytes == data.size();
}

Image decode_tga(Bytes bytes, const DecodeOptions& options) {
    if (!looks_like_tga(bytes)) throw damaged("TGA", "its header makes no sense");
    const TgaHeader header = read_header(bytes);
    check_image_size(header.width, header.height, 8);
    if (bytes.size() < header.pixels_at()) throw truncated("TGA");
    const TgaExtension extension = read_tga_extension(bytes);
    const Bytes palette = bytes.subspan(header_bytes + header.id_bytes, header.palette_bytes());
    const Bytes data = bytes.subspan(header.pixels_at());
    const std::size_t there = measure(header, data).pixels;
    const bool whole = there == header.pixels();
    if (there == 0) throw truncated("TGA");
    if (!whole && !options.salvage) throw incomplete("TGA");

    Image image = blank_image(header.width, header.height, 8);
    const bool attributes =
        extension.alpha == TgaAlpha::unsaid ? header.attribute_bits() > 0 : extension.alpha != TgaAlpha::none;
    read_pixels(header, data, Colours(header, palette, attributes), Canvas(header, samples_8(image)));
    if (attributes && extension.alpha == TgaAlpha::premultiplied) divide_by_alpha(samples_8(image));
    image.incomplete = !whole;
    image.description = extension.description;
    return image;
}

}  // namespace probewarp
