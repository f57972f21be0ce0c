// DLB by vector units: what deform_dlb does, from weights in tiles. One program holds the code for every
// instruction set and takes the best that the machine has.
#pragma once

#include <cstddef>
#include <glm/vec2.hpp>
#include <span>

#include "model/deform.h"
#include "model/weight_tiles.h"

namespace probewarp {

/// DLB.
DeformFunction deform_dlb;

/// What all probes but one add up to: worth keeping while that one is dragged.
struct OthersSum {
    std::size_t probe = 0;  ///< the one left out
    /// #tiles x 4 x 16: s0 and s1 of the others over the one's weight, as four real numbers: a blend does not
    /// see what all weights are divided by. Not a number where the one, turned, might cancel the others.
    /// Behind the last vertex they are those of a vertex that follows the first probe alone.
    AlignedFloats values;
};

OthersSum sum_others(const WeightTiles& tiles, const Pose& pose, std::size_t probe);

/// deform_dlb of the whole mesh, in time that does not depend on the number of probes: `others` as made by
/// sum_others from the same tiles and from a pose that differs in nothing but how `others.probe` moves. The
/// sum is always the others' and the one's, so that no error grows with the steps of a drag.
std::size_t deform_dlb_dragged(const WeightTiles& tiles, const OthersSum& others,
                               std::span<const glm::vec2> rest, const Pose& pose, std::span<glm::vec2> now);

/// The instruction set that this machine's deformation uses, as Highway calls it: "AVX2".
const char* deform_target();

}  // namespace probewarp
