// Weights that are harmonic within the shape: each probe is tied to the grid, and between them the heat of
// one held at 1 spreads among the others held at 0.
#include <oneapi/tbb/parallel_for.h>
#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>
#include <numbers>
#include <set>

#include "model/panel_cholesky.h"

namespace probewarp {

/// From one table to the next, of one shape. All but `order` itself is in the order of elimination.
struct HarmonicCache {
    Eigen::VectorXi order;  ///< #vertices: each one's row
    SparseMatrix laplacian;
    PanelCholesky cholesky;  ///< of the Laplacian with the ties of the last table
};

namespace {

constexpr double fixed = std::numeric_limits<double>::infinity();

/// Vertices of the grid that are tied to places.
struct Ties {
    struct Tie {
        std::size_t vertex;  ///< place in `vertices`
        std::size_t place;
        double stiffness;
    };
    std::vector<std::uint32_t> vertices;  ///< ascending
    std::vector<double> stiffness;        ///< as `vertices`: of all its ties; `fixed` on a place
    std::vector<Tie> ties;
};

/// The stiffness of the ties from a place to its triangle's corners. On an unbounded grid the potential
/// kernel a(u, v) is what a unit current into v lowers the potential of u below v's; with b the place's
/// barycentric shares and b_i / (a b)_i for its ties, currents b flow through the corners where the place is
/// held at a potential: seen from afar they are one at the place itself, and that potential is the same
/// wherever in the cell it lies. So a probe's hold does not change as it moves; it is `fixed` on a vertex,
/// and there is nothing to see as it crosses an edge. (The cotangent weights of the triangle cut at the place
/// would do neither: they have no bound along the edges.)
std::array<double, 3> tie_stiffness(const Shape& shape, const Place& place) {
    // Neighbours' kernels on a grid of conductances dy/dx, dx/dy (half the resistance between them).
    const double ratio = shape.cell.y / shape.cell.x;
    const double beside = std::atan(ratio) / (std::numbers::pi * ratio);
    const double below = std::atan(1 / ratio) / (std::numbers::pi / ratio);
    const double diagonal = 1 / std::numbers::pi;
    const double first = place.below ? below : beside, second = place.below ? beside : below;
    const auto [b0, b1, b2] = place.share;
    return {b0 / (diagonal * b1 + first * b2), b1 / (diagonal * b0 + second * b2),
            b2 / (first * b0 + second * b1)};
}

/// The grid vertices of the kept cells that hang together within `radius` pixels of the place, with their
/// distances.
std::vector<std::pair<std::uint32_t, double>> around(const Shape& shape, const Place& place, double radius) {
    std::vector<std::pair<std::uint32_t, double>> found;
    std::vector<glm::ivec2> front;
    std::set<std::pair<int, int>> seen;
    const auto visit = [&](int column, int row) {
        const glm::dvec2 least = glm::dvec2(column, row) * shape.cell;
        const glm::dvec2 nearest = glm::clamp(place.at, least, least + shape.cell);
        if (!shape.has_cell(column, row) || glm::distance(nearest, place.at) > radius) return;
        if (seen.emplace(column, row).second) front.emplace_back(column, row);
    };
    for (const int column : {place.column - int(place.on_vertex), place.column})
        for (const int row : {place.row - int(place.on_vertex), place.row}) visit(column, row);
    while (!front.empty()) {
        const glm::ivec2 cell = front.back();
        front.pop_back();
        for (const int x : {cell.x, cell.x + 1})
            for (const int y : {cell.y, cell.y + 1})
                if (const double d = glm::distance(glm::dvec2(x, y) * shape.cell, place.at); d < radius)
                    found.emplace_back(shape.grid[shape.crossing(x, y)], d);
        visit(cell.x - 1, cell.y), visit(cell.x + 1, cell.y);
        visit(cell.x, cell.y - 1), visit(cell.x, cell.y + 1);
    }
    std::sort(found.begin(), found.end());
    found.erase(std::unique(found.begin(), found.end()), found.end());
    return found;
}

Ties tie_down(const Shape& shape, std::span<const Place> places) {
    constexpr double too_loose = 1e-9;  // of the grid's own stiffness: no tie at all
    Ties ties;
    const auto add = [&](std::size_t place, std::uint32_t vertex, double stiffness) {
        ties.vertices.push_back(vertex);
        ties.ties.push_back({vertex, place, stiffness});
    };
    for (std::size_t p = 0; p < places.size(); ++p) {
        if (places[p].on_vertex) {
            add(p, places[p].corners[0], fixed);
            continue;
        }
        const auto stiffness = tie_stiffness(shape, places[p]);
        for (std::size_t k = 0; k < 3; ++k)
            if (stiffness[k] > too_loose) add(p, places[p].corners[k], stiffness[k]);
    }
    // A point alone would stand out of its surroundings like a thorn, the more so the finer the grid. So what
    // is in its core is held too, ever more loosely along the core's rim, a cell wide, so that nothing jumps
    // as it moves.
    const double rim = std::max(shape.cell.x, shape.cell.y);
    for (std::size_t p = 0; p < places.size(); ++p)
        for (const auto& [vertex, distance] : around(shape, places[p], places[p].core)) {
            const double part = (places[p].core - distance) / rim;  // 0 at the rim's outside, 1 at its inside
            const double stiffness = part >= 1 ? fixed : part / (1 - part);
            if (!(places[p].on_vertex && vertex == places[p].corners[0]) && stiffness > too_loose)
                add(p, vertex, stiffness);
        }
    std::sort(ties.vertices.begin(), ties.vertices.end());
    ties.vertices.erase(std::unique(ties.vertices.begin(), ties.vertices.end()), ties.vertices.end());
    ties.stiffness.assign(ties.vertices.size(), 0.0);
    for (auto& tie : ties.ties) {
        tie.vertex = std::size_t(std::lower_bound(ties.vertices.begin(), ties.vertices.end(), tie.vertex) -
                                 ties.vertices.begin());
        ties.stiffness[tie.vertex] += tie.stiffness;
    }
    // A tie to a vertex that a place is on pulls at nothing.
    std::erase_if(ties.ties, [&](const auto& tie) {
        return tie.stiffness != fixed && ties.stiffness[tie.vertex] == fixed;
    });
    return ties;
}

/// #islands: 1 where places are.
std::vector<std::uint8_t> inhabited(const WeightInput& input, std::span<const Place> places) {
    std::vector<std::uint8_t> with_places(std::size_t(input.islands.count), 0);
    for (const Place& place : places) with_places[std::size_t(place.island)] = 1;
    return with_places;
}

/// #islands: the first vertex of each.
std::vector<std::uint32_t> first_vertices(const WeightInput& input) {
    std::vector<std::uint32_t> first(std::size_t(input.islands.count), no_vertex);
    for (std::uint32_t v = 0; v < input.islands.of.size(); ++v)
        if (auto& of_island = first[std::size_t(input.islands.of[v])]; of_island == no_vertex) of_island = v;
    return first;
}

/// The equations (L + ties) x = ties' pulls, the fixed vertices taken out of them. In the order of
/// elimination.
struct Equations {
    SparseMatrix matrix;
    using Pull = std::pair<Eigen::Index, double>;  ///< row and right-hand side
    std::vector<std::vector<Pull>> pulls;          ///< #places
};

Equations equations_of(const WeightInput& input, const HarmonicCache& cache, std::span<const Place> places) {
    const Ties ties = tie_down(input.cache->shape, places);
    Equations equations{cache.laplacian, std::vector<std::vector<Equations::Pull>>(places.size())};
    SparseMatrix& matrix = equations.matrix;
    std::vector<Eigen::Index> place_of(std::size_t(matrix.rows()), -1);  // of the fixed vertices
    const auto row_of = [&](std::uint32_t vertex) { return Eigen::Index(cache.order[Eigen::Index(vertex)]); };
    for (const auto& tie : ties.ties) {
        const Eigen::Index row = row_of(ties.vertices[tie.vertex]);
        const double pull = tie.stiffness == fixed ? 1 : tie.stiffness;
        if (tie.stiffness == fixed)
            place_of[std::size_t(row)] = Eigen::Index(tie.place);
        else
            matrix.coeffRef(row, row) += pull;
        equations.pulls[tie.place].emplace_back(row, pull);
    }
    const auto with_places = inhabited(input, places);
    const auto first = first_vertices(input);
    for (std::size_t island = 0; island < first.size(); ++island)
        if (!with_places[island]) matrix.coeffRef(row_of(first[island]), row_of(first[island])) += 1;
    // Zeros stay in the matrix, so that its pattern, and with it the order of elimination, is always the
    // same.
    for (Eigen::Index j = 0; j < matrix.cols(); ++j)
        for (SparseMatrix::InnerIterator at(matrix, j); at; ++at) {
            const Eigen::Index of_row = place_of[std::size_t(at.row())], of_column = place_of[std::size_t(j)];
            if (of_row < 0 && of_column < 0) continue;
            if (of_row < 0) equations.pulls[std::size_t(of_column)].emplace_back(at.row(), -at.value());
            at.valueRef() = at.row() == j ? 1 : 0;
        }
    return equations;
}

HarmonicCache& prepared(WeightCache& cache) {
    if (!cache.harmonic) {
        auto made = std::make_shared<HarmonicCache>();
        const SparseMatrix matrix = laplacian(cache.shape);
        const auto order = elimination_order(matrix);
        made->order = order.indices();
        made->laplacian = matrix.twistedBy(order);
        made->cholesky = prepare_cholesky(made->laplacian);
        cache.harmonic = std::move(made);
    }
    return *cache.harmonic;
}

}  // namespace

void harmonic_shares(const WeightInput& input, WeightCache& cache, std::span<const Place> places,
                     const TakeShares& take) {
    HarmonicCache& harmonic = prepared(cache);
    const Equations equations = equations_of(input, harmonic, places);
    update_cholesky(harmonic.cholesky, equations.matrix, [&] { check_given_up(input); });

    constexpr std::size_t most = side_by_side<double>;
    oneapi::tbb::parallel_for(std::size_t{0}, (places.size() + most - 1) / most, [&](std::size_t batch) {
        check_given_up(input);
        const std::size_t first = batch * most, across = std::min(most, places.size() - first);
        const Eigen::Index vertices = harmonic.order.size();
        Sides<double> sides = Sides<double>::Zero(vertices, Eigen::Index(most));
        for (std::size_t k = 0; k < across; ++k)
            for (const auto& [row, pull] : equations.pulls[first + k]) sides(row, Eigen::Index(k)) += pull;
        solve_by_panels<double>(harmonic.cholesky.panels, harmonic.cholesky.values, sides);
        for (Eigen::Index v = 0; v < vertices; ++v)
            take(std::size_t(v), first, {&sides(harmonic.order[v], 0), across});
    });
}

std::vector<float> harmonic_table(const WeightInput& input) {
    WeightCache& cache = cache_for(input);
    const std::vector<Place> places = places_of(input, cache.shape);
    std::vector<float> table(input.mesh.rest.size() * input.probes.size(), 0.0f);
    const std::size_t probes = input.probes.size();
    harmonic_shares(input, cache, places,
                    [&](std::size_t vertex, std::size_t place, std::span<const double> shares) {
                        write_shares(std::span(places).subspan(place, shares.size()), shares,
                                     std::span(table).subspan(vertex * probes, probes));
                    });
    settle_rows(input, places, table);
    return table;
}

}  // namespace probewarp
