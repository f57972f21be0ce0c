// What drawing a deformed mesh touches: which of the picture's mipmaps, and which triangles a part of the
// target.
#pragma once

#include <glm/vec2.hpp>
#include <vector>

#include "model/deformation.h"
#include "raster/picture_drawer.h"

namespace probewarp {

/// How many mipmaps can be wanted where the view is drawn: 0 where nothing in it shrinks.
int wanted_levels(const Deformation& deformation, const View& view);

/// Where a deformed mesh's triangles are.
class TriangleBoxes {
  public:
    explicit TriangleBoxes(const Deformation& deformation);

    /// The triangles that touch the view, and what is between them in the mesh's order. None where the mesh
    /// has not moved.
    TriangleRun within(const View& view) const;

  private:
    struct Box {
        glm::vec2 least, most;  ///< image pixels
    };

    std::vector<Box> boxes_;  ///< #triangles; none where the mesh has not moved
};

}  // namespace probewarp
