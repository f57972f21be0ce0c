// Weights that are harmonic within the shape: each probe is tied to the grid, and between them the heat of
// one held at 1 spreads among the others held at 0.
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>
#include <numbers>
#include <optional>
#include <set>

#include "model/shape_laplacian.h"

namespace probewarp {

/// From one table to the next, of one shape.
struct HarmonicCache {
    SparseMatrix laplacian;
    /// The Laplacian with 1 added at each island's first vertex (grounded), which makes it definite.
    std::optional<Cholesky> grounded;
    std::map<std::uint32_t, Eigen::VectorXd> columns;  ///< of the grounded one's inverse, by vertex
    Cholesky direct;                                   ///< with the probes of the moment
    bool direct_ordered = false;
};

namespace {

/// Where the update by columns would take more than this it is no longer the quick way.
constexpr std::size_t most_columns = 192, most_column_entries = std::size_t{1} << 24;

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
    /// How much of the pull on the tie's vertex is this tie's.
    double share(const Tie& tie) const {
        return tie.stiffness == fixed ? 1 : tie.stiffness / stiffness[tie.vertex];
    }
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

/// The columns of the grounded inverse at the tied vertices, and no others where they are many.
void find_columns(const WeightInput& input, HarmonicCache& cache, const Ties& ties) {
    if (!cache.grounded) {
        SparseMatrix grounded = cache.laplacian;
        for (const std::uint32_t v : first_vertices(input))
            grounded.coeffRef(Eigen::Index(v), Eigen::Index(v)) += 1;
        cache.grounded.emplace(grounded);
        check_factored(cache.grounded->info());
    }
    for (const std::uint32_t vertex : ties.vertices) {
        if (cache.columns.contains(vertex)) continue;
        check_given_up(input);
        cache.columns[vertex] =
            cache.grounded->solve(Eigen::VectorXd::Unit(cache.laplacian.rows(), Eigen::Index(vertex)));
    }
    if (cache.columns.size() * std::size_t(cache.laplacian.rows()) > most_column_entries)
        std::erase_if(cache.columns, [&](const auto& column) {
            return !std::binary_search(ties.vertices.begin(), ties.vertices.end(), column.first);
        });
}

/// x = Y s + c, with Y the columns, s the ties' pulls and c a constant on each island. The pulls on an island
/// cancel out, so that nothing flows to the ground and L x = s; and each is its tie's stiffness times
/// (target - x):
///     [ C + G   E ] [ s ]   [ targets ]      G: Y at the tied vertices; C: 1 / stiffness, 0 where fixed
///     [ E^T     0 ] [ c ] = [    0    ]      E: 1 for the tied vertex's island
/// (Woodbury's identity for the ties, with the ground taken out exactly.)
void solve_by_columns(const WeightInput& input, HarmonicCache& cache, std::span<const Place> places,
                      const Ties& ties, const TakeShares& take) {
    find_columns(input, cache, ties);
    const auto tied = Eigen::Index(ties.vertices.size()), across = Eigen::Index(places.size());
    std::vector<const Eigen::VectorXd*> columns;
    for (const std::uint32_t vertex : ties.vertices) columns.push_back(&cache.columns.at(vertex));

    std::vector<Eigen::Index> constants(std::size_t(input.islands.count), -1);
    Eigen::Index size = tied;
    for (const Place& place : places)
        if (auto& constant = constants[std::size_t(place.island)]; constant < 0) constant = size++;
    Eigen::MatrixXd bordered = Eigen::MatrixXd::Zero(size, size);
    for (Eigen::Index j = 0; j < tied; ++j) {
        const std::uint32_t vertex = ties.vertices[std::size_t(j)];
        for (Eigen::Index i = 0; i < tied; ++i) bordered(j, i) = (*columns[std::size_t(i)])[vertex];
        bordered(j, j) += 1 / ties.stiffness[std::size_t(j)];
        const Eigen::Index constant = constants[std::size_t(input.islands.of[vertex])];
        bordered(j, constant) = bordered(constant, j) = 1;
    }
    Eigen::MatrixXd targets = Eigen::MatrixXd::Zero(size, across);
    for (const auto& tie : ties.ties)
        targets(Eigen::Index(tie.vertex), Eigen::Index(tie.place)) += ties.share(tie);
    const Eigen::MatrixXd pulls = bordered.partialPivLu().solve(targets);

    // A few rows at a time, so that they stay near the processor.
    constexpr Eigen::Index step = 128;
    const Eigen::Index vertices = cache.laplacian.rows();
    Eigen::MatrixXd some(step, tied);
    Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> shares;
    for (Eigen::Index first = 0; first < vertices; first += step) {
        check_given_up(input);
        const Eigen::Index rows = std::min(step, vertices - first);
        for (Eigen::Index j = 0; j < tied; ++j)
            some.col(j).head(rows) = columns[std::size_t(j)]->segment(first, rows);
        shares.noalias() = some.topRows(rows) * pulls.topRows(tied);
        for (Eigen::Index row = 0; row < rows; ++row)
            if (const auto c = constants[std::size_t(input.islands.of[std::size_t(first + row)])]; c >= 0)
                shares.row(row) += pulls.row(c);
        take(std::size_t(first), 0, {shares.data(), std::size_t(shares.size())}, places.size());
    }
}

/// (L + ties) x = ties' pulls, the fixed vertices taken out of the equations.
void solve_directly(const WeightInput& input, HarmonicCache& cache, std::span<const Place> places,
                    const Ties& ties, const TakeShares& take) {
    const Eigen::Index vertices = cache.laplacian.rows();
    std::vector<Eigen::Index> place_of(std::size_t(vertices), -1);  // of the fixed vertices
    using Pull = std::pair<Eigen::Index, double>;                   // vertex and right-hand side
    std::vector<std::vector<Pull>> pulls(places.size());
    SparseMatrix matrix = cache.laplacian;
    for (const auto& tie : ties.ties) {
        const auto vertex = Eigen::Index(ties.vertices[tie.vertex]);
        const double pull = tie.stiffness == fixed ? 1 : tie.stiffness;
        if (tie.stiffness == fixed)
            place_of[std::size_t(vertex)] = Eigen::Index(tie.place);
        else
            matrix.coeffRef(vertex, vertex) += pull;
        pulls[tie.place].emplace_back(vertex, pull);
    }
    const auto with_places = inhabited(input, places);
    const auto first = first_vertices(input);
    for (std::size_t island = 0; island < first.size(); ++island)
        if (!with_places[island])
            matrix.coeffRef(Eigen::Index(first[island]), Eigen::Index(first[island])) += 1;
    // Zeros stay in the matrix, so that its pattern, and with it the order of elimination, is always the
    // same.
    for (Eigen::Index j = 0; j < vertices; ++j)
        for (SparseMatrix::InnerIterator at(matrix, j); at; ++at) {
            const Eigen::Index of_row = place_of[std::size_t(at.row())], of_column = place_of[std::size_t(j)];
            if (of_row < 0 && of_column < 0) continue;
            if (of_row < 0) pulls[std::size_t(of_column)].emplace_back(at.row(), -at.value());
            at.valueRef() = at.row() == j ? 1 : 0;
        }
    if (!cache.direct_ordered) cache.direct.analyzePattern(matrix);
    cache.direct_ordered = true;
    check_given_up(input);
    cache.direct.factorize(matrix);
    check_factored(cache.direct.info());

    const auto& order = cache.direct.permutationP().indices();
    Sides sides(vertices, side_by_side), shares(vertices, side_by_side);
    for (std::size_t from = 0; from < places.size(); from += side_by_side) {
        check_given_up(input);
        const std::size_t across = std::min<std::size_t>(side_by_side, places.size() - from);
        sides.setZero();
        for (std::size_t k = 0; k < across; ++k)
            for (const auto& [vertex, pull] : pulls[from + k]) sides(order[vertex], Eigen::Index(k)) += pull;
        solve_in_factor_order(cache.direct, sides);
        // Packed, for there may be fewer than a full row.
        for (Eigen::Index v = 0; v < vertices; ++v)
            for (std::size_t k = 0; k < across; ++k)
                shares.data()[std::size_t(v) * across + k] = sides(order[v], Eigen::Index(k));
        take(0, from, {shares.data(), std::size_t(vertices) * across}, across);
    }
}

}  // namespace

void harmonic_shares(const WeightInput& input, WeightCache& cache, std::span<const Place> places,
                     HarmonicWay way, const TakeShares& take) {
    if (!cache.harmonic) {
        cache.harmonic = std::make_shared<HarmonicCache>();
        cache.harmonic->laplacian = laplacian(cache.shape);
    }
    const Ties ties = tie_down(cache.shape, places);
    if (way == HarmonicWay::by_size) {
        const std::size_t columns = ties.vertices.size();
        way = columns > most_columns || columns * cache.shape.vertices > most_column_entries
                  ? HarmonicWay::directly
                  : HarmonicWay::by_columns;
    }
    (way == HarmonicWay::directly ? solve_directly : solve_by_columns)(input, *cache.harmonic, places, ties,
                                                                       take);
}

std::vector<float> harmonic_table(const WeightInput& input) {
    WeightCache& cache = cache_for(input);
    const std::vector<Place> places = places_of(input, cache.shape);
    std::vector<float> table(input.mesh.rest.size() * input.probes.size(), 0.0f);
    harmonic_shares(
        input, cache, places, HarmonicWay::by_size,
        [&](std::size_t vertex, std::size_t place, std::span<const double> shares, std::size_t across) {
            write_shares(places, input.probes.size(), vertex, place, shares, across, table);
        });
    settle_rows(input, places, table);
    return table;
}

}  // namespace probewarp
