// The cells of the grid that the mesh leaves out although something faint is to be seen in them: they stay
// where they are and are drawn under the deformed mesh, so that no pixel vanishes because a probe moved.
#pragma once

#include <cstdint>
#include <glm/vec2.hpp>
#include <span>
#include <vector>

#include "model/image.h"
#include "model/mesh.h"

namespace probewarp {

/// Their rectangles, of which none overlaps another.
struct StillCells {
    std::vector<glm::vec2> corners;        ///< image pixels
    std::vector<std::uint32_t> triangles;  ///< #triangles x 3 places in `corners`
};

/// Cells side by side make one rectangle. Without any where the threshold is 0: what the mesh leaves out then
/// is clear. kept: rows x columns, as visible_cells gives it for the image and the settings
StillCells still_cells(const Image& image, const MeshSettings& settings, std::span<const std::uint8_t> kept);

}  // namespace probewarp
