// From triangles to rows of pixels: which pixels of a target each of the mesh's triangles covers, and which
// place of the picture at rest they show.
#pragma once

#include <vector>

#include "raster/triangles.h"

namespace probewarp {

/// Whole rows of a view, from `first` to before `end`.
struct Rows {
    int first = 0, end = 0;
};

/// Pixels of one row that a triangle covers, from `first` to before `end`.
struct PixelSpan {
    int first, end;
    glm::dvec2 at;      ///< what the first one's centre shows: pixels of the picture at rest
    glm::dvec2 across;  ///< and how far each next one goes on there
    float level;        ///< of the mipmaps: mipmap_level, at most the last
};

/// #rows, each with its spans in the order of the triangles. A pixel is in a triangle where its centre is; of
/// triangles with a common side one has a pixel on it, never both and never none. triangles: indices;
/// last_level: the smallest mipmap there is
std::vector<std::vector<PixelSpan>> scan_convert(const DeformedMesh& mesh,
                                                 std::span<const std::uint32_t> triangles, const View& view,
                                                 const Rows& rows, int last_level);

/// How far down the picture at rest scan_convert's pixels look, mipmaps included: y, image pixels; 0 where
/// there are none. May be more, never less; infinite where a footprint is above `widest`.
double lowest_lookup(const DeformedMesh& mesh, std::span<const std::uint32_t> triangles, const View& view,
                     const Rows& rows, double widest);

}  // namespace probewarp
