// Paint and weights as 16-bit grey PNGs: in projects, and for other programs.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "model/error.h"
#include "model/paint.h"

namespace probewarp {

/// The map as a PNG of its size: grey is the value, alpha the coverage.
std::vector<std::byte> encode_paint(const PaintMap& map);

/// Texels that a PNG's header promises. Throws Error where the bytes are no 16-bit PNG, as projects have
/// them.
std::size_t paint_texels(std::span<const std::byte> bytes);

/// A map of the PNG's size over `extent` (see PaintMap): the value is the mean of red, green and blue, the
/// coverage is alpha, or 1 without. Tiles that are the same throughout are shared. Throws Error: a clause, no
/// file name.
PaintMap decode_paint(std::span<const std::byte> bytes, glm::dvec2 extent);

/// What all paint of a project takes: limited, so that a small file cannot ask for all memory or time.
struct PaintBudget {
    std::size_t texels = 0;   ///< of the maps, at most 2^28
    std::size_t painted = 0;  ///< as painted_texels counts them, at most 2^27: 512 MiB of tiles
    /// Throws Error where either is more.
    void check() const;
};

/// Reads a 16-bit PNG as paint, counted in `budget`. Throws Error where it is none or the budget does not
/// suffice.
PaintMap decode_paint(std::span<const std::byte> bytes, glm::dvec2 extent, PaintBudget& budget);

/// A 16-bit grey PNG. grey: height x width, row-major
std::vector<std::byte> encode_grey_png(int width, int height, std::span<const std::uint16_t> grey);

/// Texels in the tiles of `map` that are not null; a tile that stands in several places counts once.
std::size_t painted_texels(const PaintMap& map);

}  // namespace probewarp
