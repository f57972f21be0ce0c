#include "model/weights_in_shape.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

namespace probewarp {

Shape shape_of(const Mesh& mesh) {
    Shape shape;
    shape.columns = mesh.columns;
    shape.rows = mesh.rows;
    shape.cell = mesh.size / glm::dvec2(mesh.columns, mesh.rows);
    shape.grid = mesh.grid;
    shape.vertices =
        mesh.grid.size() - std::size_t(std::count(mesh.grid.begin(), mesh.grid.end(), no_vertex));
    shape.kept.reserve(mesh.first_triangle.size());
    for (std::size_t cell = 0; cell + 1 < mesh.first_triangle.size(); ++cell)
        shape.kept.push_back(mesh.first_triangle[cell + 1] > mesh.first_triangle[cell]);
    return shape;
}

namespace {

Place place_on_vertex(const WeightInput& input, const Shape& shape, std::uint32_t vertex) {
    Place place;
    // The grid's own coordinates, not their floats: the same place is found again whatever the rounding.
    const glm::dvec2 rest = input.mesh.rest[vertex];
    place.column = int(std::lround(rest.x / shape.cell.x));
    place.row = int(std::lround(rest.y / shape.cell.y));
    place.at = glm::dvec2(place.column, place.row) * shape.cell;
    place.on_vertex = true;
    place.corners = {vertex, vertex, vertex};
    place.share = {1, 0, 0};
    place.island = input.islands.of[vertex];
    return place;
}

/// The kept cell that holds a point given in cells, or on whose edge it lies; requires one.
glm::ivec2 kept_cell(const Shape& shape, glm::dvec2 at) {
    constexpr double hair = 1e-3;  // more than the mesh's own, so that what it found is found
    for (const double y : {at.y, at.y - hair, at.y + hair})
        for (const double x : {at.x, at.x - hair, at.x + hair}) {
            const glm::ivec2 cell(std::clamp(int(std::floor(x)), 0, shape.columns - 1),
                                  std::clamp(int(std::floor(y)), 0, shape.rows - 1));
            if (shape.has_cell(cell.x, cell.y)) return cell;
        }
    assert(false);
    return {0, 0};
}

/// Requires a point in a kept cell or on its edge.
Place place_in_cell(const WeightInput& input, const Shape& shape, glm::dvec2 at) {
    const glm::dvec2 scaled = at / input.mesh.size * glm::dvec2(shape.columns, shape.rows);
    const glm::ivec2 cell = kept_cell(shape, scaled);
    const int column = cell.x, row = cell.y;
    const double x = std::clamp(scaled.x - column, 0.0, 1.0), y = std::clamp(scaled.y - row, 0.0, 1.0);
    Place place;
    place.at = at;
    place.column = column;
    place.row = row;
    place.below = y > x;
    place.corners = {
        shape.grid[shape.crossing(column, row)], shape.grid[shape.crossing(column + 1, row + 1)],
        shape.grid[place.below ? shape.crossing(column, row + 1) : shape.crossing(column + 1, row)]};
    place.share = {1 - std::max(x, y), std::min(x, y), std::abs(x - y)};
    place.island = input.islands.of[place.corners[0]];
    return place;
}

/// Of the grid vertices that `may` lets through; no_vertex where it lets none.
template <class May>
std::uint32_t nearest_vertex(const WeightInput& input, const Shape& shape, glm::dvec2 point, May may) {
    std::uint32_t nearest = no_vertex;
    double least = std::numeric_limits<double>::infinity();
    for (std::uint32_t v = 0; v < shape.vertices; ++v) {
        const glm::dvec2 away = glm::dvec2(input.mesh.rest[v]) - point;
        if (const double d = glm::dot(away, away); d < least && may(v)) least = d, nearest = v;
    }
    return nearest;
}

}  // namespace

std::vector<Place> places_of(const WeightInput& input, const Shape& shape) {
    assert(input.mesh.anchors.size() == input.probes.size());
    std::vector<std::uint8_t> anchored(input.mesh.rest.size(), 0);
    for (const std::uint32_t v : input.mesh.anchors)
        if (v != no_vertex) anchored[v] = 1;
    std::vector<Place> places;
    std::map<std::uint32_t, std::size_t> by_vertex;
    for (std::size_t i = 0; i < input.probes.size(); ++i) {
        const glm::dvec2 rest = input.probes[i].rest;
        std::uint32_t vertex = input.mesh.anchors[i];
        if (vertex == no_vertex)
            vertex = nearest_vertex(input, shape, rest, [&](std::uint32_t v) { return !anchored[v]; });
        if (vertex == no_vertex) vertex = nearest_vertex(input, shape, rest, [](auto) { return true; });
        const auto [found, is_new] = by_vertex.try_emplace(vertex, places.size());
        if (is_new)
            places.push_back(vertex < shape.vertices ? place_on_vertex(input, shape, vertex)
                                                     : place_in_cell(input, shape, rest));
        places[found->second].probes.push_back(i);
        places[found->second].core = std::max(places[found->second].core, input.probes[i].radius / 6);
    }
    for (Place& place : places)
        for (const Place& other : places)
            if (&other != &place) place.core = std::min(place.core, 0.4 * glm::distance(place.at, other.at));
    return places;
}

WeightCache& cache_for(const WeightInput& input) {
    Shape shape = shape_of(input.mesh);
    if (!input.cache || input.cache->shape != shape) {
        input.cache = std::make_shared<WeightCache>();
        input.cache->shape = std::move(shape);
    }
    return *input.cache;
}

namespace {

std::vector<std::uint32_t> followed(const WeightInput& input, const Shape& shape,
                                    std::span<const Place> places) {
    constexpr std::uint32_t unknown = no_vertex - 1;
    std::vector<std::uint32_t> probes(std::size_t(input.islands.count), unknown);
    for (const Place& place : places) probes[std::size_t(place.island)] = no_vertex;
    std::vector<double> least(probes.size(), std::numeric_limits<double>::infinity());
    // Probes outside, so that the first of equals wins.
    if (std::find(probes.begin(), probes.end(), unknown) == probes.end()) return probes;
    std::vector<std::uint32_t> lonely;
    for (std::uint32_t v = 0; v < shape.vertices; ++v)
        if (probes[std::size_t(input.islands.of[v])] == unknown) lonely.push_back(v);
    for (std::size_t i = 0; i < input.probes.size(); ++i)
        for (const std::uint32_t v : lonely) {
            const glm::dvec2 away = glm::dvec2(input.mesh.rest[v]) - input.probes[i].rest;
            const auto island = std::size_t(input.islands.of[v]);
            if (const double d = glm::dot(away, away); d < least[island])
                least[island] = d, probes[island] = std::uint32_t(i);
        }
    return probes;
}

/// Gives the row to the probes of the place nearest to the vertex.
void take_nearest(const WeightInput& input, std::span<const Place> places, std::size_t vertex,
                  std::span<float> row) {
    const Place* nearest = nullptr;
    const auto away = [&](const Place& place) {
        return glm::distance(place.at, glm::dvec2(input.mesh.rest[vertex]));
    };
    for (const Place& place : places)
        if (place.island == input.islands.of[vertex] && (!nearest || away(place) < away(*nearest)))
            nearest = &place;
    if (nearest)
        for (const std::size_t i : nearest->probes) row[i] = 1;
}

}  // namespace

std::vector<std::uint32_t> followed_probes(const WeightInput& input) {
    const Shape shape = shape_of(input.mesh);
    return followed(input, shape, places_of(input, shape));
}

void write_shares(std::span<const Place> places, std::span<const double> shares, std::span<float> row) {
    for (std::size_t p = 0; p < places.size(); ++p)  // rounding leaves some a hair below 0
        for (const std::size_t i : places[p].probes)
            row[i] = float(std::max(0.0, shares[p]) / double(places[p].probes.size()));
}

void settle_rows(const WeightInput& input, std::span<const Place> places, std::span<float> table) {
    const std::size_t probes = input.probes.size();
    const auto row = [&](std::size_t v) { return table.subspan(v * probes, probes); };
    const Shape& shape = input.cache->shape;
    const std::vector<std::uint32_t> follows = followed(input, shape, places);
    for (std::size_t v = 0; v < shape.vertices; ++v) {
        if (const auto probe = follows[std::size_t(input.islands.of[v])]; probe != no_vertex) {
            std::fill(row(v).begin(), row(v).end(), 0.0f);
            row(v)[probe] = 1;
            continue;
        }
        const float largest = *std::max_element(row(v).begin(), row(v).end());
        // Below this the quotients would lose their digits, or overflow.
        if (largest < std::numeric_limits<float>::min())
            take_nearest(input, places, v, row(v));
        else
            for (float& w : row(v)) w /= largest;
    }
    for (const std::uint32_t v : input.mesh.anchors)
        if (v != no_vertex) std::fill(row(v).begin(), row(v).end(), 0.0f);
    for (std::size_t i = 0; i < probes; ++i)
        if (const std::uint32_t v = input.mesh.anchors[i]; v != no_vertex) row(v)[i] = 1;
}

}  // namespace probewarp
