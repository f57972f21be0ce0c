// How much smaller a deformed mesh draws the picture than it is, so that what does not shrink goes without
// mipmaps, which cost a software rasteriser more than all else.
#pragma once

#include <glm/vec2.hpp>
#include <vector>

#include "model/deformation.h"
#include "raster/picture_drawer.h"

namespace probewarp {

class Footprints {
  public:
    /// view: of the whole export, within which all others lie
    Footprints(const Deformation& deformation, const View& view);

    /// The mipmaps that drawing can touch: 0 where there are none.
    int wanted_levels() const;

    /// The triangles that touch the view, and perhaps some between them, in the mesh's order; one run of
    /// everything where the mesh has not moved.
    std::vector<TriangleRun> runs_within(const View& view) const;

  private:
    struct Triangle {
        glm::vec2 least, most;  ///< the box around it, image pixels
        bool shrunk;            ///< whether shaders/mesh.frag may draw of it from a mipmap
    };

    std::vector<Triangle> triangles_;  ///< of the mesh; one for the whole picture where it has not moved
    double largest_ = 1;               ///< pixels of the picture that a target pixel spans at most
};

}  // namespace probewarp
