// Bounded biharmonic weights (Jacobson, Baran, Popovic & Sorkine 2011): as smooth as can be within the shape,
// and never beside [0, 1].
#include <fmt/format.h>
#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "model/error.h"
#include "model/panel_cholesky.h"

namespace probewarp {

/// What depends on the shape and, coarsely, on how many places there are: it stays as probes move. All but
/// `order` itself is in the order of elimination.
struct BiharmonicCache {
    Eigen::VectorXi order;  ///< #vertices: each one's row
    Eigen::VectorXd areas;  ///< M, lumped
    SparseMatrix energy;    ///< L M^-1 L
    PanelCholesky pattern;  ///< of every rung's factor; nothing is factored in it
    struct Rung {
        double rho;
        std::vector<float> factor;  ///< of energy + rho M
    };
    std::vector<Rung> rungs;  ///< empty before the first table
};

namespace {

/// So many take 1.3 GB while they are factored, and most of a minute.
constexpr std::size_t most_vertices = 330'000;

/// The search goes up a ladder: with a small weight rho of the distance between its two halves, the shares
/// find their place at large; with a larger one, near each place; with the last one the two halves meet.
/// rho is in units of spacing^-4, as the energy of shares that change from place to place; the rungs are wide
/// apart, and the figures of rho matter little.
/// Against the least energy's, at 100 x 100 cells and 20 places at random, a share (they sum to 1) is 0.005
/// off at its end (root mean square) and 0.05 at worst, in a figure with limbs 0.005 and 0.09; where many
/// places crowd together 0.02 and 0.12. Along narrow limbs the energy hardly tells shares apart, and there
/// they may be farther off.
struct Rounds {
    double rho;
    int rounds;
};
constexpr Rounds ladder[] = {{8, 20}, {200, 15}, {10'000, 10}};
constexpr double stiffest = 1;  // of rho; the energy's own diagonal is 20
constexpr float over_relaxation = 1.8f;

/// Of a place on its triangle's corners, by the squares of their shares; the energy's own diagonal is 20.
/// Each corner is held by itself: bounded shares can only be 1 inside a triangle where all its corners are,
/// and a hold on the point alone would fight the bounds. Squares, because a slight hold is felt already: so
/// it comes gently as a probe crosses an edge.
double hold(double share) { return 300 * share * share; }

BiharmonicCache& prepared(WeightCache& cache) {
    if (!cache.biharmonic) {
        auto made = std::make_shared<BiharmonicCache>();
        const Eigen::VectorXd areas = lumped_areas(cache.shape);
        const SparseMatrix stiffness = laplacian(cache.shape);
        const SparseMatrix energy = stiffness * areas.cwiseInverse().asDiagonal() * stiffness;
        const auto order = elimination_order(energy);
        made->order = order.indices();
        made->areas = order * areas;
        made->energy = energy.twistedBy(order);
        made->pattern = prepare_cholesky(made->energy);
        cache.biharmonic = std::move(made);
    }
    return *cache.biharmonic;
}

/// Cells between one place and the next, spread over the shape or strung along it, whichever is more: it is
/// a strip as long as half its outline, which is what it has more vertices than cells. As a power of 2, so
/// that one more probe seldom needs other factors.
double spacing(const BiharmonicCache& cache, std::size_t places) {
    const double cells = cache.areas.sum(), along = double(cache.areas.size()) - cells;
    const double cells_between = std::max(std::sqrt(cells / double(places)), along / double(places));
    return std::exp2(std::round(std::log2(cells_between)));
}

/// Makes the rungs for so many places, where they are not there already.
void factor_rungs(const WeightInput& input, BiharmonicCache& cache, std::size_t places) {
    const double unit = std::pow(spacing(cache, places), -4);
    std::vector<BiharmonicCache::Rung> rungs;
    for (const Rounds& rung : ladder) rungs.push_back({std::min(rung.rho * unit, stiffest), {}});
    const auto same = [](const auto& a, const auto& b) { return a.rho == b.rho; };
    if (std::equal(rungs.begin(), rungs.end(), cache.rungs.begin(), cache.rungs.end(), same)) return;
    oneapi::tbb::parallel_for(std::size_t{0}, rungs.size(), [&](std::size_t i) {
        SparseMatrix matrix = cache.energy;
        matrix.diagonal() += rungs[i].rho * cache.areas;
        PanelCholesky cholesky = cache.pattern;
        update_cholesky(cholesky, matrix, [&] { check_given_up(input); });
        rungs[i].factor.assign(cholesky.values.begin(), cholesky.values.end());
    });
    cache.rungs = std::move(rungs);
}

/// #rungs: the kept factors with the places' holds added. From the kept ones each time, not from the last
/// table's: so a table is the same, bit for bit, however its probes came to where they are.
std::vector<std::vector<float>> held_factors(const WeightInput& input, const BiharmonicCache& cache,
                                             std::span<const Place> places) {
    std::vector<std::vector<float>> factors(cache.rungs.size());
    oneapi::tbb::parallel_for(std::size_t{0}, factors.size(), [&](std::size_t i) {
        factors[i] = cache.rungs[i].factor;
        DiagonalRaiser raiser(cache.pattern.panels);
        for (const Place& place : places) {
            check_given_up(input);
            std::array<Raise, 3> raises;
            for (std::size_t k = 0; k < 3; ++k)
                raises[k] = {cache.order[Eigen::Index(place.corners[k])], float(hold(place.share[k]))};
            raiser.raise(raises, factors[i]);
        }
    });
    return factors;
}

/// A place's hold in the column of its own shares.
struct Pull {
    Eigen::Index row, column;
    float by;
};

/// Minimises 1/2 w^T (energy + holds) w - w^T pulls within 0 <= w <= 1 for several w at once, by the
/// alternating direction method of multipliers (Boyd et al. 2011, section 5.2, over-relaxed). `state`, in and
/// out, is what has to be cut off at the bounds: cut off it is the bounded half of the search, and what is
/// cut off is the disagreement that has added up (their scaled dual variable). All in the factor's order.
void search(const WeightInput& input, const Panels& panels, std::span<const float> factor,
            const Eigen::ArrayXf& rho_areas, std::span<const Pull> pulls, int rounds, Sides<float>& state) {
    Sides<float> smooth(state.rows(), side_by_side<float>);
    for (int round = 0; round < rounds; ++round) {
        check_given_up(input);
        for (Eigen::Index v = 0; v < state.rows(); ++v)
            smooth.row(v) = rho_areas[v] * (2 * state.row(v).max(0.0f).min(1.0f) - state.row(v));
        for (const Pull& pull : pulls) smooth(pull.row, pull.column) += pull.by;
        solve_by_panels<float>(panels, factor, smooth);
        for (Eigen::Index v = 0; v < state.rows(); ++v)
            state.row(v) += over_relaxation * (smooth.row(v) - state.row(v).max(0.0f).min(1.0f));
    }
}

/// The shares of `side_by_side<float>` places from `first` on, or of those that are left: #vertices, in the
/// factor's order; a place alone on its island has all from the start.
Sides<float> shares_of(const WeightInput& input, const BiharmonicCache& cache,
                       std::span<const std::vector<float>> factors, std::span<const Place> places,
                       std::size_t first) {
    const std::size_t columns = std::min<std::size_t>(side_by_side<float>, places.size() - first);
    std::vector<float> start(std::size_t(input.islands.count), 0.0f);  // 1 / the island's places
    for (const Place& place : places) ++start[std::size_t(place.island)];
    for (float& count : start) count = 1 / count;
    Sides<float> state = Sides<float>::Zero(cache.order.size(), side_by_side<float>);
    std::vector<Pull> pulls;
    for (std::size_t k = 0; k < columns; ++k) {
        const Place& place = places[first + k];
        for (Eigen::Index v = 0; v < cache.order.size(); ++v)
            if (input.islands.of[std::size_t(v)] == place.island)
                state(cache.order[v], Eigen::Index(k)) = start[std::size_t(place.island)];
        for (std::size_t i = 0; i < 3; ++i)
            pulls.push_back(
                {cache.order[Eigen::Index(place.corners[i])], Eigen::Index(k), float(hold(place.share[i]))});
    }
    double rho = 0;
    for (std::size_t rung = 0; rung < factors.size(); ++rung) {
        const double next = cache.rungs[rung].rho;
        // The disagreement is in units of 1 / rho.
        const Sides<float> bounded = state.max(0.0f).min(1.0f);
        state = bounded + float(rho / next) * (state - bounded);
        rho = next;
        const Eigen::ArrayXf rho_areas = (rho * cache.areas).cast<float>();
        search(input, cache.pattern.panels, factors[rung], rho_areas, pulls, ladder[rung].rounds, state);
    }
    return state.max(0.0f).min(1.0f);
}

}  // namespace

std::vector<float> biharmonic_table(const WeightInput& input) {
    WeightCache& cache = cache_for(input);
    const Shape& shape = cache.shape;
    if (shape.vertices > most_vertices)
        throw Error(
            fmt::format("biharmonic weights take at most {} vertices, and the mesh has {}: choose a "
                        "coarser mesh or the harmonic weights",
                        most_vertices, shape.vertices));
    const std::vector<Place> places = places_of(input, shape);
    check_given_up(input);
    BiharmonicCache& biharmonic = prepared(cache);
    factor_rungs(input, biharmonic, places.size());
    const auto factors = held_factors(input, biharmonic, places);

    const std::size_t probes = input.probes.size();
    std::vector<float> table(input.mesh.rest.size() * probes, 0.0f);
    oneapi::tbb::parallel_for(
        std::size_t{0}, (places.size() + side_by_side<float> - 1) / side_by_side<float>,
        [&](std::size_t block) {
            const std::size_t first = block * side_by_side<float>;
            const Sides<float> shares = shares_of(input, biharmonic, factors, places, first);
            for (std::size_t v = 0; v < shape.vertices; ++v)
                for (std::size_t p = first; p < std::min(first + side_by_side<float>, places.size()); ++p)
                    for (const std::size_t i : places[p].probes)
                        table[v * probes + i] =
                            shares(biharmonic.order[Eigen::Index(v)], Eigen::Index(p - first)) /
                            float(places[p].probes.size());
        });
    settle_rows(input, places, table);
    return table;
}

}  // namespace probewarp
