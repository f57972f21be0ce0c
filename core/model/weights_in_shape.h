// What the weight schemes within the shape share: the kept cells as a lattice, where the probes sit on it,
// and what is kept from one table to the next. Private to those schemes and their tests.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <glm/vec2.hpp>
#include <map>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "model/weights.h"

namespace probewarp {

/// The cells that a mesh has. Its grid vertices are the unknowns of every scheme: they stay the same while
/// probes move. Each other vertex of a mesh is some probe's own, and its row is known.
struct Shape {
    int columns = 0;           ///< cells along x
    int rows = 0;              ///< cells along y
    glm::dvec2 cell{0};        ///< a cell's sides, image pixels
    std::size_t vertices = 0;  ///< of the grid
    std::vector<std::uint32_t>
        grid;  ///< (rows + 1) x (columns + 1): the vertex at each crossing, or no_vertex
    std::vector<std::uint8_t> kept;  ///< rows x columns: 1 for a cell of the mesh
    friend bool operator==(const Shape&, const Shape&) = default;

    /// False beside the grid, too.
    bool has_cell(int column, int row) const {
        return column >= 0 && row >= 0 && column < columns && row < rows &&
               kept[std::size_t(row) * std::size_t(columns) + std::size_t(column)] != 0;
    }
    std::size_t crossing(int column, int row) const {
        return std::size_t(row) * (std::size_t(columns) + 1) + std::size_t(column);
    }
};
Shape shape_of(const Mesh& mesh);

/// Where one or more probes sit on the grid.
struct Place {
    glm::dvec2 at{0};         ///< image pixels
    bool on_vertex = false;   ///< of the grid: corners[0], whose share is 1
    int column = 0, row = 0;  ///< of its cell, or of the crossing it is on
    /// Of the grid's triangle: top-left, bottom-right, and top-right, or bottom-left where `below`.
    std::array<std::uint32_t, 3> corners{};
    std::array<double, 3> share{};  ///< barycentric, of the corners; >= 0, sums to 1
    bool below = false;
    int island = 0;
    std::vector<std::size_t> probes;  ///< that sit here
    /// Image pixels: within it, along the shape, the harmonic weights are the place's own. A sixth of the
    /// widest reach of its probes, and at most two fifths of the way to the nearest other place.
    double core = 0;
};

/// A probe that is not on the mesh sits on the nearest vertex of the grid that is no probe's anchor (where
/// all are, on the nearest). Probes with the same vertex share one place; the places come in the order of
/// their first probes.
std::vector<Place> places_of(const WeightInput& input, const Shape& shape);

struct HarmonicCache;
struct BiharmonicCache;

/// One mesh's; not to be used by two threads at once.
struct WeightCache {
    Shape shape;
    /// By Place::at: #grid vertices; the geodesic distance from there, image pixels, infinite where there is
    /// no way.
    std::map<std::pair<double, double>, std::vector<float>> distances;
    std::shared_ptr<HarmonicCache> harmonic;
    std::shared_ptr<BiharmonicCache> biharmonic;
};

/// The input's cache; a new one where it is null or another shape's.
WeightCache& cache_for(const WeightInput& input);

/// #grid vertices: the length of the shortest way within the shape from the place, image pixels; infinity
/// where there is none.
std::vector<float> geodesic_distances(const Shape& shape, const Place& place);

/// Takes the shares of some places, from `place` on, in a grid vertex. May be called by several threads at
/// once.
using TakeShares = std::function<void(std::size_t vertex, std::size_t place, std::span<const double> shares)>;

/// The share of each place in each grid vertex: harmonic between the places, in [0, 1] and summing to 1 but
/// for rounding. Unspecified on islands without a place. The same, bit for bit, whatever the cache holds.
void harmonic_shares(const WeightInput& input, WeightCache& cache, std::span<const Place> places,
                     const TakeShares& take);

/// Writes a vertex's shares of some places into its row (#probes), each divided among its place's probes.
void write_shares(std::span<const Place> places, std::span<const double> shares, std::span<float> row);

/// Divides each row by its largest, then sets the rows that are known: at a probe's anchor, and on an island
/// without a probe. A row without any weight takes the place nearest as the crow flies.
void settle_rows(const WeightInput& input, std::span<const Place> places, std::span<float> table);

}  // namespace probewarp
