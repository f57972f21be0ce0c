// DLB by vector units: what deform_dlb does, from weights in tiles. One program holds the code for every
// instruction set and takes the best that the machine has.
#pragma once

#include <cstddef>
#include <glm/vec2.hpp>
#include <span>

#include "model/deform.h"
#include "model/weight_tiles.h"

namespace probewarp {

/// deform_dlb as a DeformTilesFunction.
std::size_t deform_dlb(const WeightTiles& tiles, std::span<const glm::vec2> rest, const Pose& pose,
                       VertexRun run, std::span<glm::vec2> now);

/// The instruction set that this machine's deformation uses, as Highway calls it: "AVX2".
const char* deform_target();

}  // namespace probewarp
