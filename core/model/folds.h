// Where the deformed mesh is folded: triangles that lie turned over, so that the picture is drawn over
// itself.
#pragma once

#include <cstddef>
#include <glm/vec2.hpp>
#include <span>

#include "model/mesh.h"

namespace probewarp {

/// The mesh's triangles whose corners go round the other way than at rest, by more than the rounding of their
/// places may do. Shared between all cores. now: #vertices, image pixels
std::size_t folded_triangles(const Mesh& mesh, std::span<const glm::vec2> now);

}  // namespace probewarp
