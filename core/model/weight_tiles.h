// The weights once more, in the order in which vector units want them: tiles of 16 vertices, read from the
// first to the last as one stream.
#pragma once

#include <cstddef>
#include <span>

#include "model/aligned.h"
#include "model/mesh.h"

namespace probewarp {

inline constexpr std::size_t tile_width = 16;
/// What is deformed in one go: two vectors of the widest units there are.
inline constexpr std::size_t tile_block = 2 * tile_width;
/// How far ahead of the sums the weights are fetched: 8 KB. Less leaves a tenth of the memory's speed unused
/// on machines with much memory far away; more serves alike up to 16 KB.
inline constexpr std::size_t floats_ahead = 2048;

struct WeightTiles {
    std::size_t vertices = 0, probes = 0;
    /// #tiles x #probes x 16; the tiles fill whole blocks. A vertex that the mesh does not have follows the
    /// first probe alone, so that its blend has an answer.
    AlignedFloats weights;
    float largest_sum = 0;  ///< no vertex's weights have a larger sum of |w_i|
};

/// Weights of one vertex: #probes, `tile_width` apart.
const float* column(const WeightTiles& tiles, std::size_t vertex);

/// weights: #vertices x #probes, row-major, at least one probe; room: memory to use again, whatever it holds
WeightTiles make_tiles(std::span<const float> weights, std::size_t probes, AlignedFloats room = {});

/// Takes over one run of vertices. weights: run.count x #probes, row-major
void put(WeightTiles& tiles, VertexRun run, std::span<const float> weights);

}  // namespace probewarp
