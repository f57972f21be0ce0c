#include "model/weight_tiles.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>

namespace probewarp {

namespace {

std::size_t place_in(const WeightTiles& tiles, std::size_t vertex) {
    return vertex / tile_width * tiles.probes * tile_width + vertex % tile_width;
}

/// Takes over vertices of one tile: 16 sums side by side, since one alone would wait for itself.
void put_in_tile(WeightTiles& tiles, VertexRun run, const float* weights) {
    float* to = tiles.weights.data() + place_in(tiles, run.first);
    std::array<float, tile_width> sums{};
    for (std::size_t i = 0; i < tiles.probes; ++i, to += tile_width)
        for (std::size_t k = 0; k < run.count; ++k) {
            to[k] = weights[k * tiles.probes + i];
            sums[k] += std::abs(to[k]);
        }
    tiles.largest_sum = std::max(tiles.largest_sum, *std::max_element(sums.begin(), sums.end()));
}

}  // namespace

const float* column(const WeightTiles& tiles, std::size_t vertex) {
    return tiles.weights.data() + place_in(tiles, vertex);
}

WeightTiles make_tiles(std::span<const float> weights, std::size_t probes) {
    assert(probes > 0 && weights.size() % probes == 0);
    WeightTiles tiles{weights.size() / probes, probes, {}, 0};
    const std::size_t blocks = (tiles.vertices + tile_block - 1) / tile_block;
    tiles.weights.resize(blocks * tile_block * probes);
    put(tiles, {0, tiles.vertices}, weights);
    for (std::size_t v = tiles.vertices; v < blocks * tile_block; ++v)
        for (std::size_t i = 0; i < probes; ++i)
            tiles.weights[place_in(tiles, v) + i * tile_width] = i == 0 ? 1.0f : 0.0f;
    return tiles;
}

void put(WeightTiles& tiles, VertexRun run, std::span<const float> weights) {
    assert(run.first + run.count <= tiles.vertices && weights.size() == run.count * tiles.probes);
    for (std::size_t done = 0; done < run.count;) {
        const std::size_t v = run.first + done;
        const std::size_t count = std::min(tile_width - v % tile_width, run.count - done);
        put_in_tile(tiles, {v, count}, weights.data() + done * tiles.probes);
        done += count;
    }
}

}  // namespace probewarp
