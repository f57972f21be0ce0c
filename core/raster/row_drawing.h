// A row of pixels drawn from its spans by vector units, as shaders/mesh.frag and shaders/resolve.frag draw.
// One program holds the code for every instruction set and takes the best that the machine has.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "raster/scan_conversion.h"

namespace probewarp {

/// The picture, or one of its mipmaps, which follow it in their order.
struct Level {
    const void* samples;  ///< RGBA, as deep as the picture
    int width, height;    ///< >= 2
};

/// RGBA, straight. Sample: std::uint8_t or std::uint16_t, the picture's
template <class Sample>
using Pixel = std::array<Sample, 4>;

/// By how much the arrays below are longer than the row: vectors reach beyond it.
inline constexpr std::size_t beyond_row = 16;

/// What the pixels of a row show, one after the other: noted for all of them before any is looked up, so that
/// each is looked up once however many triangles lie over it.
struct RowLookups {
    std::vector<float> x, y;   ///< pixels of the picture at rest
    std::vector<float> level;  ///< of its mipmaps, 0 being the picture, mixed of two; or nothing_there

    static constexpr float nothing_there = -1;

    explicit RowLookups(std::size_t width) : x(width + beyond_row), y(x.size()), level(x.size()) {}
};

/// Draws an opaque picture. pixels: #width, each of which is written; beside: what is where no span is
template <class Sample>
void draw_row(std::span<const Level> levels, std::span<const PixelSpan> spans, RowLookups& room,
              const Pixel<Sample>& beside, std::span<Pixel<Sample>> pixels);

/// Weighted colours: colour times weight, in the samples' steps, and weight.
struct LayerRow {
    std::vector<float> r, g, b, a;

    explicit LayerRow(std::size_t width) : r(width + beyond_row), g(r.size()), b(r.size()), a(r.size()) {}
    std::size_t width() const { return r.size() - beyond_row; }
};

/// Draws an opaque picture into a layer, all of which is written; nothing is where no span is.
template <class Sample>
void layer_row(std::span<const Level> levels, std::span<const PixelSpan> spans, RowLookups& room,
               LayerRow& layer);

/// Lays one span after the other over what is in the layer, whatever the picture.
template <class Sample>
void blend_row(std::span<const Level> levels, std::span<const PixelSpan> spans, LayerRow& layer);

/// Straight pixels of weighted ones, of which `samples` were added up for each. background: what they lie on,
/// or null, where they stay as transparent as they are; pixels: #width
template <class Sample>
void resolve_row(const LayerRow& sum, int samples, const Pixel<Sample>* background,
                 std::span<Pixel<Sample>> pixels);

}  // namespace probewarp
