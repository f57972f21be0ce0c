// A picture in memory: straight-alpha RGBA of 8 or 16 bits, with what the file said about its colours and
// size.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

namespace probewarp {

/// No side longer than this, and no picture whose RGBA takes more than this many bytes: readers refuse it.
inline constexpr int max_image_side = 32768;
inline constexpr std::size_t max_image_bytes = std::size_t{384} << 20;
/// Nor one that would take more than this together with the file it is read from.
inline constexpr std::size_t max_decoding_bytes = std::size_t{448} << 20;

/// Pixels per metre, as PNG's pHYs has it.
struct Resolution {
    std::uint32_t x = 0;
    std::uint32_t y = 0;
    friend bool operator==(const Resolution&, const Resolution&) = default;
};

/// CIE x and y of white, red, green and blue, times 100,000, as PNG's cHRM has them.
using Chromaticities = std::array<std::uint32_t, 8>;

/// What a file says about how its pixels are meant to be seen, and about itself. Nothing of it changes a
/// pixel here: what is written carries on what its format can hold. Where several members speak of the
/// colours, the first of cicp, icc, srgb_intent, gamma with chromaticities is meant (PNG, third edition,
/// section 4.3); none: sRGB.
struct Description {
    std::vector<std::byte> icc{};  ///< an ICC profile for RGB; empty: none
    /// ITU-T H.273: colour primaries, transfer function, matrix coefficients (0), full range (1).
    std::optional<std::array<std::uint8_t, 4>> cicp{};
    std::optional<std::uint8_t> srgb_intent{};  ///< the colours are said to be sRGB; rendering intent, 0 to 3
    std::optional<std::uint32_t> gamma{};       ///< as PNG's gAMA: 100,000 over the exponent to linear light
    std::optional<Chromaticities> chromaticities{};
    std::optional<Resolution> resolution{};
    std::optional<Resolution> aspect{};  ///< where there is no resolution: pixels per the same unknown unit
    /// EXIF as a TIFF block, from its byte order on: upright, and without a thumbnail. Empty: none.
    std::vector<std::byte> exif{};
    /// Where the top-left corner lies on a larger canvas: x right, y down, pixels. As PNG's oFFs.
    std::optional<std::array<std::int32_t, 2>> offset{};
    friend bool operator==(const Description&, const Description&) = default;
};

struct Image {
    int width = 0;   ///< pixels, >= 1
    int height = 0;  ///< pixels, >= 1
    /// height x width x 4 (RGBA, straight alpha), row-major from the top-left corner.
    std::variant<std::vector<std::uint8_t>, std::vector<std::uint16_t>> rgba;
    Description description;
    bool opaque = false;  ///< every alpha is sure to be full; else one has to look
    /// The file ended too soon and was salvaged: what was missing is clear or black.
    bool incomplete = false;

    int bits() const { return rgba.index() == 0 ? 8 : 16; }
};

/// The RGBA bytes as they lie in memory (16-bit samples in the machine's order).
std::span<const std::byte> pixel_bytes(const Image& image);

/// The four samples of pixel (x, y), in the image's own depth. Requires a pixel inside.
std::array<int, 4> pixel(const Image& image, int x, int y);

/// Whether the alpha of RGBA samples is full everywhere.
bool is_opaque(std::span<const std::uint8_t> rgba);
bool is_opaque(std::span<const std::uint16_t> rgba);

/// Whether any pixel is not fully opaque.
bool has_alpha(const Image& image);

/// The rows of a picture that another thread is still decoding, from the top.
class ArrivingRows {
  public:
    virtual ~ArrivingRows() = default;
    /// Comes back when so many are there. Throws Error where they never will be.
    virtual void wait(int rows) const = 0;

    struct Times {
        double decoding, waiting;  ///< seconds
    };
    /// How long decoding has taken, and others have waited for it, so far.
    virtual Times times() const = 0;
};

/// A picture as it was opened: what a project stores, and what the renderer shows.
struct Picture {
    Image image;
    std::string name;                 ///< the file's name without its folder
    std::string format;               ///< the reader's row: "png", "jpeg", ...
    std::vector<std::byte> original;  ///< the file's bytes, for the project
    /// Null: all pixels are there. Else image.opaque holds, and no row may be looked at before it is there.
    std::shared_ptr<const ArrivingRows> arriving;
};

/// Comes back when so many rows, from the top, are there. Throws Error where they never will be.
inline void wait_for_rows(const Picture& picture, int rows) {
    if (picture.arriving) picture.arriving->wait(rows);
}

using PicturePtr = std::shared_ptr<const Picture>;

}  // namespace probewarp
