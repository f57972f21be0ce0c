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

struct Image {
    int width = 0;   ///< pixels, >= 1
    int height = 0;  ///< pixels, >= 1
    /// height x width x 4 (RGBA, straight alpha), row-major from the top-left corner.
    std::variant<std::vector<std::uint8_t>, std::vector<std::uint16_t>> rgba;
    std::vector<std::byte> icc;            ///< the ICC profile of the colours; empty: sRGB
    std::optional<Resolution> resolution;  ///< where the file gave one
    bool opaque = false;                   ///< every alpha is sure to be full; else one has to look

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
    /// So far.
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
