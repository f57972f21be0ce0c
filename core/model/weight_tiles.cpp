#include "model/weight_tiles.h"

#include <oneapi/tbb/blocked_range.h>
#include <oneapi/tbb/parallel_reduce.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <utility>

#include "model/over_blocks.h"

namespace probewarp {

namespace {

std::size_t place_in(const WeightTiles& tiles, std::size_t vertex) {
    return vertex / tile_width * tiles.probes * tile_width + vertex % tile_width;
}

/// Takes over vertices of one tile: 16 sums side by side, since one alone would wait for itself. Returns the
/// largest.
float put_in_tile(WeightTiles& tiles, VertexRun run, const float* weights) {
    float* to = tiles.weights.data() + place_in(tiles, run.first);
    std::array<float, tile_width> sums{};
    for (std::size_t i = 0; i < tiles.probes; ++i, to += tile_width)
        for (std::size_t k = 0; k < run.count; ++k) {
            to[k] = weights[k * tiles.probes + i];
            sums[k] += std::abs(to[k]);
        }
    return *std::max_element(sums.begin(), sums.end());
}

/// Writes a run into the tiles; returns the largest of its vertices' sums. weights: as put's
float put_in_tiles(WeightTiles& tiles, VertexRun run, const float* weights) {
    using Range = oneapi::tbb::blocked_range<std::size_t>;
    const std::size_t grain = least_weights / (tile_width * tiles.probes) + 1, end = run.first + run.count;
    return oneapi::tbb::parallel_reduce(
        Range(run.first / tile_width, (end + tile_width - 1) / tile_width, grain), 0.0f,
        [&](const Range& range, float largest) {
            for (std::size_t tile = range.begin(); tile < range.end(); ++tile) {
                const std::size_t first = std::max(tile * tile_width, run.first);
                const VertexRun part{first, std::min((tile + 1) * tile_width, end) - first};
                const float* from = weights + (first - run.first) * tiles.probes;
                largest = std::max(largest, put_in_tile(tiles, part, from));
            }
            return largest;
        },
        [](float a, float b) { return std::max(a, b); });
}

}  // namespace

const float* column(const WeightTiles& tiles, std::size_t vertex) {
    return tiles.weights.data() + place_in(tiles, vertex);
}

WeightTiles make_tiles(std::span<const float> weights, std::size_t probes, AlignedFloats room) {
    assert(probes > 0 && weights.size() % probes == 0);
    const std::size_t vertices = weights.size() / probes, blocks = (vertices + tile_block - 1) / tile_block;
    if (room.size() != blocks * tile_block * probes) room = {};  // which it would copy as it grows
    room.resize(blocks * tile_block * probes);
    WeightTiles tiles{vertices, probes, std::move(room), 0};
    tiles.largest_sum = put_in_tiles(tiles, {0, vertices}, weights.data());
    for (std::size_t v = tiles.vertices; v < blocks * tile_block; ++v)
        for (std::size_t i = 0; i < probes; ++i)
            tiles.weights[place_in(tiles, v) + i * tile_width] = i == 0 ? 1.0f : 0.0f;
    return tiles;
}

void put(WeightTiles& tiles, VertexRun run, std::span<const float> weights) {
    assert(run.first + run.count <= tiles.vertices && weights.size() == run.count * tiles.probes);
    tiles.largest_sum = std::max(tiles.largest_sum, put_in_tiles(tiles, run, weights.data()));
}

}  // namespace probewarp
