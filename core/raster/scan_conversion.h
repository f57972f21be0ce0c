// From triangles to rows of pixels: which pixels of a target each of the mesh's triangles covers, and which
// place of the picture at rest they show.
#pragma once

#include <vector>

#include "raster/triangles.h"

namespace probewarp {

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
std::vector<std::vector<Span>> scan_convert(const DeformedMesh& mesh, TriangleRun triangles, const View& view,
                                            const Rows& rows, int last_level);

}  // namespace probewarp
