// Bounded biharmonic weights (Jacobson, Baran, Popovic & Sorkine 2011): as smooth as can be within the shape,
// and never beside [0, 1].
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <future>

#include "model/error.h"
#include "model/shape_laplacian.h"

namespace probewarp {

/// What depends on the shape alone.
struct BiharmonicCache {
    SparseMatrix laplacian;  ///< L
    SparseMatrix energy;     ///< L M^-1 L
    Eigen::VectorXd areas;   ///< M, lumped
    Cholesky factor;
    bool ordered = false;
};

namespace {

/// The factor of this many vertices takes about 1 GB.
constexpr std::size_t most_vertices = 330'000;

/// The search ends where its two halves are this near and still, or after so many rounds. By then a share is
/// 0.005 (root mean square) from where it would come to rest, and 0.08 at worst, near places close together.
constexpr double stop = 1e-3;
constexpr int most_rounds = 100;
constexpr double over_relaxation = 1.6;

/// Of a place on its triangle's corners, by the squares of their shares; the energy's own diagonal is 20.
/// Each corner is held by itself: bounded shares can only be 1 inside a triangle where all its corners are,
/// and a hold on the point alone would fight the bounds. Squares, because a slight hold is felt already: so
/// it comes gently as a probe crosses an edge.
double hold(double share) { return 300 * share * share; }

/// The weight of the distance between the two halves of the search. It goes quickest where that is about the
/// energy of what the shares look like: a wave with the harmonic shares' mean square slope. 0 where they have
/// none, each place being alone on its island (its shares are 1 from the start).
double balance(const BiharmonicCache& cache, std::span<const Sides> harmonic) {
    double slopes = 0, squares = 0;
    for (const Sides& shares : harmonic) {
        const Eigen::ArrayXd by_place =
            (shares * (cache.laplacian * shares.matrix()).array()).colwise().sum().transpose();
        for (Eigen::Index k = 0; k < side_by_side; ++k) {
            if (by_place[k] < 1e-9) continue;  // rounding: the place is alone
            slopes += by_place[k];
            squares += (shares.col(k).square() * cache.areas.array()).sum();
        }
    }
    const double wave_number_squared = squares > 0 ? slopes / squares : 0;  // cells^-2
    return 20 * wave_number_squared * wave_number_squared;
}

/// Factors energy + rho M + the places' holds.
void factor(BiharmonicCache& cache, double rho, std::span<const Place> places) {
    SparseMatrix matrix = cache.energy;
    for (Eigen::Index v = 0; v < matrix.rows(); ++v) matrix.coeffRef(v, v) += rho * cache.areas[v];
    for (const Place& place : places)
        for (std::size_t i = 0; i < 3; ++i) {
            const auto corner = Eigen::Index(place.corners[i]);
            matrix.coeffRef(corner, corner) += hold(place.share[i]);
        }
    if (!cache.ordered) cache.factor.analyzePattern(matrix);
    cache.ordered = true;
    cache.factor.factorize(matrix);
    check_factored(cache.factor);
}

/// Minimises 1/2 w^T (energy + holds) w - w^T pulls within 0 <= w <= 1 for several w at once, by the
/// alternating direction method of multipliers (Boyd et al. 2011, section 5.2, over-relaxed). `smooth` goes
/// for the least energy and `bounded` keeps to the bounds; `unbalanced` adds up by how much they disagreed.
/// All in the factor's order. bounded: from where to where the search goes.
void search(const WeightInput& input, const Cholesky& factor, const Eigen::ArrayXd& rho_areas,
            const Sides& pulls, Sides& bounded) {
    Sides smooth(pulls.rows(), side_by_side);
    Sides unbalanced = Sides::Zero(pulls.rows(), side_by_side);
    for (int round = 0; round < most_rounds; ++round) {
        check_given_up(input);
        smooth = pulls + (bounded - unbalanced).colwise() * rho_areas;
        solve_in_factor_order(factor, smooth);
        double apart = 0, moved = 0;
        for (Eigen::Index v = 0; v < smooth.rows(); ++v) {
            using Row = Eigen::Array<double, 1, side_by_side>;
            const Row before = bounded.row(v);
            const Row ahead = over_relaxation * smooth.row(v) + (1 - over_relaxation) * before;
            const Row now = (ahead + unbalanced.row(v)).max(0.0).min(1.0);
            apart = std::max(apart, (smooth.row(v) - now).abs().maxCoeff());
            moved = std::max(moved, (now - before).abs().maxCoeff());
            unbalanced.row(v) += ahead - now;
            bounded.row(v) = now;
        }
        if (apart <= stop && moved <= stop) break;
    }
}

/// The rows of `from` in the factor's order, or back in the vertices'.
Sides in_order(const Sides& from, const Eigen::VectorXi& order, bool back) {
    Sides to(from.rows(), side_by_side);
    for (Eigen::Index v = 0; v < from.rows(); ++v)
        if (back)
            to.row(v) = from.row(order[v]);
        else
            to.row(order[v]) = from.row(v);
    return to;
}

/// Where the search starts: the harmonic shares, which keep to the bounds already. Not where the last search
/// ended, so that a picture is the same however its probes came to where they are.
/// #blocks of `side_by_side` places, each #vertices rows in the vertices' order.
std::vector<Sides> harmonic_start(const WeightInput& input, WeightCache& cache,
                                  std::span<const Place> places) {
    std::vector<Sides> start((places.size() + side_by_side - 1) / side_by_side,
                             Sides::Zero(Eigen::Index(cache.shape.vertices), side_by_side));
    harmonic_shares(
        input, cache, places, HarmonicWay::by_size,
        [&](std::size_t vertex, std::size_t place, std::span<const double> shares, std::size_t across) {
            for (std::size_t k = 0; k < shares.size(); ++k) {
                const std::size_t column = place + k % across;
                start[column / side_by_side](Eigen::Index(vertex + k / across),
                                             Eigen::Index(column % side_by_side)) =
                    std::clamp(shares[k], 0.0, 1.0);
            }
        });
    return start;
}

BiharmonicCache& prepared(WeightCache& cache) {
    if (!cache.biharmonic) {
        auto made = std::make_shared<BiharmonicCache>();
        made->areas = lumped_areas(cache.shape);
        made->laplacian = laplacian(cache.shape);
        made->energy = made->laplacian * made->areas.cwiseInverse().asDiagonal() * made->laplacian;
        cache.biharmonic = std::move(made);
    }
    return *cache.biharmonic;
}

/// Takes the blocks of shares, as harmonic_start gives them, to the least energy.
void search_all(const WeightInput& input, BiharmonicCache& cache, std::span<const Place> places, double rho,
                std::span<Sides> shares) {
    check_given_up(input);
    factor(cache, rho, places);
    const Eigen::VectorXi order = cache.factor.permutationP().indices();
    Eigen::ArrayXd rho_areas(order.size());
    for (Eigen::Index v = 0; v < order.size(); ++v) rho_areas[order[v]] = rho * cache.areas[v];
    const auto search_every_other = [&](std::size_t from) {
        for (std::size_t block = from; block < shares.size(); block += 2) {
            Sides pulls = Sides::Zero(order.size(), side_by_side);
            const std::size_t first = block * side_by_side;
            for (std::size_t p = first; p < std::min(first + side_by_side, places.size()); ++p)
                for (std::size_t i = 0; i < 3; ++i)
                    pulls(order[Eigen::Index(places[p].corners[i])], Eigen::Index(p - first)) +=
                        hold(places[p].share[i]);
            Sides here = in_order(shares[block], order, false);
            search(input, cache.factor, rho_areas, pulls, here);
            shares[block] = in_order(here, order, true);
        }
    };
    // The blocks have nothing to do with each other. GivenUp comes through from either thread.
    auto others = std::async(std::launch::async, search_every_other, 1);
    search_every_other(0);
    others.get();
}

}  // namespace

std::vector<float> biharmonic_table(const WeightInput& input) {
    WeightCache& cache = cache_for(input);
    const Shape& shape = cache.shape;
    if (shape.vertices > most_vertices)
        throw Error(fmt::format(
            "biharmonic weights take at most {} vertices: choose a coarser mesh or the harmonic weights",
            most_vertices));
    const std::vector<Place> places = places_of(input, shape);
    std::vector<Sides> shares = harmonic_start(input, cache, places);
    BiharmonicCache& biharmonic = prepared(cache);
    if (const double rho = balance(biharmonic, shares); rho > 0)
        search_all(input, biharmonic, places, rho, shares);

    std::vector<float> table(input.mesh.rest.size() * input.probes.size(), 0.0f);
    for (std::size_t p = 0; p < places.size(); ++p) {
        const auto column = shares[p / side_by_side].col(Eigen::Index(p % side_by_side));
        for (std::size_t v = 0; v < shape.vertices; ++v)
            for (const std::size_t i : places[p].probes)
                table[v * input.probes.size() + i] =
                    float(column[Eigen::Index(v)] / double(places[p].probes.size()));
    }
    settle_rows(input, places, table);
    return table;
}

}  // namespace probewarp
