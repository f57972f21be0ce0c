#include "model/weight_tiles.h"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace probewarp {

namespace {

std::size_t place_in(const WeightTiles& tiles, std::size_t vertex) {
    return vertex / tile_width * tiles.probes * tile_width + vertex % tile_width;
}

float* values(WeightTiles& tiles) { return tiles.rows.front().weights.data(); }

}  // namespace

const float* column(const WeightTiles& tiles, std::size_t vertex) {
    return tiles.rows.front().weights.data() + place_in(tiles, vertex);
}

WeightTiles make_tiles(std::span<const float> weights, std::size_t probes) {
    assert(probes > 0 && weights.size() % probes == 0);
    WeightTiles tiles{weights.size() / probes, probes, {}, 0};
    const std::size_t blocks = (tiles.vertices + tile_block - 1) / tile_block;
    if (blocks == 0) return tiles;
    tiles.rows.resize(blocks * (tile_block / tile_width) * probes);
    put(tiles, {0, tiles.vertices}, weights);
    for (std::size_t v = tiles.vertices; v < blocks * tile_block; ++v) values(tiles)[place_in(tiles, v)] = 1;
    return tiles;
}

void put(WeightTiles& tiles, VertexRun run, std::span<const float> weights) {
    assert(run.first + run.count <= tiles.vertices && weights.size() == run.count * tiles.probes);
    for (std::size_t k = 0; k < run.count; ++k) {
        const auto row = weights.subspan(k * tiles.probes, tiles.probes);
        float* to = values(tiles) + place_in(tiles, run.first + k);
        float sum = 0;
        for (std::size_t i = 0; i < row.size(); ++i) {
            to[i * tile_width] = row[i];
            sum += std::abs(row[i]);
        }
        tiles.largest_sum = std::max(tiles.largest_sum, sum);
    }
}

}  // namespace probewarp
