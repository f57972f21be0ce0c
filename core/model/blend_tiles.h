// The other blends by vector units, in double, from weights in tiles. As deform_tiles.h, one program holds
// the code for every instruction set.
#pragma once

#include <cstddef>
#include <glm/vec2.hpp>
#include <span>

#include "model/deform.h"
#include "model/weight_tiles.h"

namespace probewarp {

// Each is a DeformFunction: the blend of the same name in planar_blend.h up to a double's rounding. What
// is near to having no answer is decided by that function itself, vertex by vertex.

std::size_t deform_dlb_shortest(const WeightTiles& tiles, std::span<const glm::vec2> rest, const Pose& pose,
                                VertexRun run, std::span<glm::vec2> now);
std::size_t deform_dib(const WeightTiles& tiles, std::span<const glm::vec2> rest, const Pose& pose,
                       VertexRun run, std::span<glm::vec2> now);
std::size_t deform_log_linear(const WeightTiles& tiles, std::span<const glm::vec2> rest, const Pose& pose,
                              VertexRun run, std::span<glm::vec2> now);
std::size_t deform_spiral(const WeightTiles& tiles, std::span<const glm::vec2> rest, const Pose& pose,
                          VertexRun run, std::span<glm::vec2> now);
std::size_t deform_linear(const WeightTiles& tiles, std::span<const glm::vec2> rest, const Pose& pose,
                          VertexRun run, std::span<glm::vec2> now);
std::size_t deform_mls_rigid(const WeightTiles& tiles, std::span<const glm::vec2> rest, const Pose& pose,
                             VertexRun run, std::span<glm::vec2> now);
std::size_t deform_mls_similarity(const WeightTiles& tiles, std::span<const glm::vec2> rest, const Pose& pose,
                                  VertexRun run, std::span<glm::vec2> now);

}  // namespace probewarp
