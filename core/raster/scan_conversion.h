// From triangles to rows of pixels: which pixels of a target each of the mesh's triangles covers, and which
// place of the picture at rest they show.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "raster/picture_drawer.h"

namespace probewarp {

/// The mesh as it is drawn.
struct DrawnTriangles {
    std::span<const glm::vec2> rest, now;    ///< #vertices, image pixels
    std::span<const std::uint32_t> corners;  ///< #triangles x 3
    std::span<const TriangleRun> runs;       ///< what may show
};

/// Whole rows of a view.
struct Rows {
    int first = 0, end = 0;
};

/// Pixels of one row that a triangle covers.
struct Span {
    int first, end;
    glm::dvec2 at;      ///< what the first one's centre shows: pixels of the picture at rest
    glm::dvec2 across;  ///< and how far each next one goes on there
    float level;        ///< of the mipmaps, 0 being the picture: shaders/mesh.frag
};

/// #rows, each with its spans in the order of their triangles. A pixel is in a triangle where its centre is;
/// of triangles with a common side one has a pixel on it, never both and never none. last_level: the smallest
/// mipmap
std::vector<std::vector<Span>> scan_convert(const DrawnTriangles& triangles, const View& view,
                                            const Rows& rows, int last_level);

}  // namespace probewarp
