// Weights by the length of the shortest way within the shape, found by fast marching.
#include <algorithm>
#include <cmath>
#include <limits>
#include <queue>
#include <set>

#include "model/weights_in_shape.h"

namespace probewarp {

namespace {

constexpr double far_away = std::numeric_limits<double>::infinity();

/// The distance at a cell's corner, where it is `near` one `leg` away and `far` at the cell's opposite
/// corner, an `edge` further at a right angle: the least of the ways that cross this edge, along which the
/// distance is taken to be linear (Kimmel & Sethian 1998, section 4, for the right triangle).
double across_edge(double near, double far, double leg, double edge) {
    const double diagonal = std::hypot(leg, edge);
    if (near == far_away) return far + diagonal;
    const double slope = (near - far) / edge;  // the sine of the angle between the way and the leg
    if (!(slope > 0)) return near + leg;
    if (slope >= edge / diagonal) return far + diagonal;
    return near + leg * std::sqrt(1 - slope * slope);
}

/// Cells [column, column_end) x [row, row_end).
struct Block {
    int column, row, column_end, row_end;
};

bool all_kept(const Shape& shape, const Block& block) {
    for (int row = block.row; row < block.row_end; ++row)
        for (int column = block.column; column < block.column_end; ++column)
            if (!shape.has_cell(column, row)) return false;
    return true;
}

/// Grows the block on each side where kept cells are. From the place, everything in it is in sight.
Block grown(const Shape& shape, Block block) {
    // The first rings are where marching errs most, for the front is bent most there.
    constexpr int rings = 6;
    for (int ring = 0; ring < rings; ++ring) {
        if (all_kept(shape, {block.column - 1, block.row, block.column, block.row_end})) --block.column;
        if (all_kept(shape, {block.column_end, block.row, block.column_end + 1, block.row_end}))
            ++block.column_end;
        if (all_kept(shape, {block.column, block.row - 1, block.column_end, block.row})) --block.row;
        if (all_kept(shape, {block.column, block.row_end, block.column_end, block.row_end + 1}))
            ++block.row_end;
    }
    return block;
}

/// Blocks of kept cells with the place in each.
std::vector<Block> blocks_around(const Shape& shape, const Place& place) {
    if (!place.on_vertex) return {grown(shape, {place.column, place.row, place.column + 1, place.row + 1})};
    std::vector<Block> blocks;
    for (const int r : {place.row - 1, place.row})
        for (const int c : {place.column - 1, place.column})
            if (shape.has_cell(c, r)) blocks.push_back(grown(shape, {c, r, c + 1, r + 1}));
    return blocks;
}

}  // namespace

std::vector<float> geodesic_distances(const Shape& shape, const Place& place) {
    const int across = shape.columns + 1;
    std::vector<double> distance(shape.grid.size(), far_away);
    std::vector<std::uint8_t> settled(shape.grid.size(), 0);
    using Reached = std::pair<double, std::uint32_t>;  // by distance, the crossing
    std::priority_queue<Reached, std::vector<Reached>, std::greater<>> front;
    const auto reach = [&](std::size_t crossing, double d) {
        if (settled[crossing] || !(d < distance[crossing])) return;
        distance[crossing] = d;
        front.emplace(d, std::uint32_t(crossing));
    };
    for (const Block& block : blocks_around(shape, place))
        for (int row = block.row; row <= block.row_end; ++row)
            for (int column = block.column; column <= block.column_end; ++column)
                reach(shape.crossing(column, row),
                      std::hypot(column * shape.cell.x - place.at.x, row * shape.cell.y - place.at.y));
    const auto known = [&](std::size_t crossing) {
        return settled[crossing] ? distance[crossing] : far_away;
    };
    while (!front.empty()) {
        const std::size_t at = front.top().second;
        front.pop();
        if (settled[at]) continue;
        settled[at] = 1;
        const int column = int(at) % across, row = int(at) / across;
        const double here = distance[at];
        for (const int down : {-1, 1})
            for (const int right : {-1, 1}) {
                if (!shape.has_cell(column + (right - 1) / 2, row + (down - 1) / 2)) continue;
                // Its corners: this one, one beside it, one above or below it, and the opposite one. A cell's
                // corner is reached across either of the two edges that do not end there.
                const std::size_t beside = shape.crossing(column + right, row);
                const std::size_t below = shape.crossing(column, row + down);
                const std::size_t opposite = shape.crossing(column + right, row + down);
                const auto [dx, dy] = std::pair{shape.cell.x, shape.cell.y};
                if (!settled[beside]) reach(beside, across_edge(here, known(below), dx, dy));
                if (!settled[below]) reach(below, across_edge(here, known(beside), dy, dx));
                if (settled[opposite]) continue;
                reach(opposite, across_edge(known(beside), here, dy, dx));
                reach(opposite, across_edge(known(below), here, dx, dy));
            }
    }
    std::vector<float> of_vertices(shape.vertices);
    for (std::size_t at = 0; at < shape.grid.size(); ++at)
        if (shape.grid[at] != no_vertex) of_vertices[shape.grid[at]] = float(distance[at]);
    return of_vertices;
}

namespace {

/// (radius / distance)^exponent of each probe, the largest 1; where some have no distance, 1 for them alone.
/// distances: #probes; shares: #probes, to work in.
void weights_by_distance(std::span<const Probe> probes, double exponent, std::span<const double> distances,
                         std::span<double> shares, std::span<float> row) {
    const bool on_some = std::find(distances.begin(), distances.end(), 0.0) != distances.end();
    double largest = 0;
    for (std::size_t i = 0; i < probes.size(); ++i) {
        const double nearness = probes[i].radius / distances[i];
        shares[i] = on_some ? double(distances[i] == 0)
                            : (exponent == 2 ? nearness * nearness : std::pow(nearness, exponent));
        largest = std::max(largest, shares[i]);
    }
    for (std::size_t i = 0; i < probes.size(); ++i) row[i] = largest > 0 ? float(shares[i] / largest) : 0.0f;
}

}  // namespace

std::vector<float> geodesic_table(const WeightInput& input) {
    WeightCache& cache = cache_for(input);
    const std::vector<Place> places = places_of(input, cache.shape);
    const auto key = [](const Place& place) { return std::pair{place.at.x, place.at.y}; };
    std::set<std::pair<double, double>> used;
    for (const Place& place : places) {
        check_given_up(input);
        used.insert(key(place));
        if (!cache.distances.contains(key(place)))
            cache.distances[key(place)] = geodesic_distances(cache.shape, place);
    }
    std::erase_if(cache.distances, [&](const auto& kept) { return !used.contains(kept.first); });

    const std::size_t probes = input.probes.size();
    std::vector<const float*> from(probes);  // each probe's distances
    for (const Place& place : places)
        for (const std::size_t i : place.probes) from[i] = cache.distances[key(place)].data();
    std::vector<float> table(input.mesh.rest.size() * probes, 0.0f);
    std::vector<double> here(probes), shares(probes);
    for (std::size_t v = 0; v < cache.shape.vertices; ++v) {
        for (std::size_t i = 0; i < probes; ++i) here[i] = double(from[i][v]);
        weights_by_distance(input.probes, input.exponent, here, shares,
                            std::span(table).subspan(v * probes, probes));
    }
    settle_rows(input, places, table);
    return table;
}

}  // namespace probewarp
