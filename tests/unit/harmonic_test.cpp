// The harmonic weights: known answers, the maximum principle, and that what is kept tells nothing.

#include "shape_scene.h"

namespace probewarp {
namespace {

using namespace testing;

/// The raw harmonic shares: #grid vertices x #places.
std::vector<double> raw_shares(Scene& scene) {
    const WeightInput input = scene.input();
    WeightCache& cache = cache_for(input);
    const auto places = places_of(input, cache.shape);
    std::vector<double> all(cache.shape.vertices * places.size(), -1);
    harmonic_shares(input, cache, places,
                    [&](std::size_t vertex, std::size_t place, std::span<const double> shares) {
                        std::ranges::copy(shares, &all[vertex * places.size() + place]);
                    });
    return all;
}

TEST(Harmonic, IsLinearAlongAStrip) {
    // A probe in the middle of either short edge pulls at both its corners alike, so nothing flows across:
    // each column of cells is a conductance of 1 (two edges of 1/2), and each probe's two ties are of 4 (on a
    // square grid, half the share divided by half the neighbour's potential kernel 1/4).
    constexpr int n = 20;
    Scene scene(whole_grid(n, 1), {{0, 5}, {n * cell, 5}});
    const Table table = harmonic_table(scene.input());
    for (int column = 0; column <= n; ++column)
        for (const int row : {0, 1})
            // A few roundings of a float.
            EXPECT_NEAR(share(table, 2, scene.at(column, row), 0), 1 - (column + 0.125) / (n + 0.25), 5e-7);
}

TEST(Harmonic, FallsOffLikeTheLogarithmWithinARing) {
    // A ring of 64 probes, 40 cells from the one in the middle. Point-like probes on a square grid hold like
    // discs of exp(-Euler's constant) / sqrt(8) cells; the ring's holds at where it is and a little outside.
    constexpr int n = 100, ring = 64;
    constexpr double middle = n * cell / 2.0, radius = 40;
    std::vector<glm::dvec2> rests{{middle, middle}};
    for (int k = 0; k < ring; ++k) {
        const double angle = 2 * std::numbers::pi * k / ring;
        rests.push_back(middle + radius * cell * glm::dvec2(std::cos(angle), std::sin(angle)));
    }
    Scene scene(whole_grid(n, n), rests);
    const Table table = harmonic_table(scene.input());
    const double disc = std::exp(-std::numbers::egamma) / std::sqrt(8);
    const double apart = 2 * std::numbers::pi * radius / ring;
    const double outer =
        radius + apart / (2 * std::numbers::pi) * std::log(apart / (2 * std::numbers::pi * disc));
    for (const int r : {5, 10, 20, 30})
        // A grid's kernel is the logarithm but for some 0.02 / r^2; the ring's holds differ by less.
        EXPECT_NEAR(share(table, rests.size(), scene.at(n / 2 + r, n / 2), 0),
                    std::log(outer / r) / std::log(outer / disc), 0.001)
            << r;
}

TEST(Harmonic, IsTheProbesOwnWithinItsCore) {
    // Two fingers of two cells with a gap of one between them, joined at the bottom; a reach of 180 has a
    // core of 30.
    auto cells = whole_grid(5, 20);
    for (int row = 0; row < 18; ++row) cells[std::size_t(row)][2] = '.';
    Scene scene(cells, {{12, 52}, {43, 181}});
    for (Probe& probe : scene.probes) probe.radius = 180;
    const Table table = harmonic_table(scene.input());
    for (int row = 0; row <= 20; ++row)
        for (int column = 0; column <= 5; ++column) {
            const double d = std::hypot(column * cell - 12, row * cell - 52);
            if (column <= 2 && d < 30 - cell) {  // the rim is a cell wide
                EXPECT_NEAR(share(table, 2, scene.at(column, row), 0), 1, 1e-9) << column << ' ' << row;
            } else if (d > 30 && (row * cell > 52 || column > 2)) {  // above it, the core fills the finger
                EXPECT_LT(share(table, 2, scene.at(column, row), 0), 1) << column << ' ' << row;
            }
            // As near, but across the gap.
            if (column >= 3 && row < 17) {
                EXPECT_LT(share(table, 2, scene.at(column, row), 0), 0.3) << column << ' ' << row;
            }
        }
}

TEST(Harmonic, CoresOfProbesSideBySideDoNotMeet) {
    Scene scene(whole_grid(20, 20), {{95, 100}, {105, 100}});
    for (Probe& probe : scene.probes) probe.radius = 600;
    const Table table = harmonic_table(scene.input());
    for (int row = 0; row <= 20; ++row)                                 // as far from either
        EXPECT_NEAR(share(table, 2, scene.at(10, row), 0), 0.5, 1e-6);  // a float
    EXPECT_GT(share(table, 2, scene.at(9, 10), 0), 0.5);
}

TEST(Harmonic, KeepsTheMaximumPrincipleAndSumsToOne) {
    expect_always("no share is above all of its neighbours'", [] {
        const auto scene = any_scene(6);
        const auto all = raw_shares(*scene);
        const Shape& shape = scene->cache->shape;
        const auto places = places_of(scene->input(), shape);
        std::vector<std::size_t> on_island(std::size_t(scene->islands.count), 0);
        std::vector<std::uint8_t> tied(shape.vertices, 0);
        for (const Place& place : places) {
            ++on_island[std::size_t(place.island)];
            for (const std::uint32_t v : place.corners) tied[v] = 1;
        }
        constexpr double rounding = 1e-9;  // systems of up to 100 unknowns, shares of 1
        for (int row = 0; row <= shape.rows; ++row)
            for (int column = 0; column <= shape.columns; ++column) {
                const std::uint32_t v = shape.grid[shape.crossing(column, row)];
                if (v == no_vertex || on_island[std::size_t(scene->islands.of[v])] == 0) continue;
                double sum = 0;
                for (std::size_t p = 0; p < places.size(); ++p) {
                    const double here = all[v * places.size() + p];
                    RC_ASSERT(here >= -rounding && here <= 1 + rounding);
                    sum += here;
                    if (tied[v]) continue;
                    double most = -1, least = 2;
                    const auto look = [&](int c, int r) {
                        const double there = all[shape.grid[shape.crossing(c, r)] * places.size() + p];
                        most = std::max(most, there), least = std::min(least, there);
                    };
                    const auto has = [&](int c, int r) { return shape.has_cell(c, r); };
                    if (has(column, row - 1) || has(column, row)) look(column + 1, row);
                    if (has(column - 1, row - 1) || has(column - 1, row)) look(column - 1, row);
                    if (has(column - 1, row) || has(column, row)) look(column, row + 1);
                    if (has(column - 1, row - 1) || has(column, row - 1)) look(column, row - 1);
                    RC_ASSERT(here <= most + rounding && here >= least - rounding);
                }
                RC_ASSERT(std::abs(sum - 1) < rounding);
            }
    });
}

TEST(Harmonic, IsStrictlyBetweenNoughtAndOneAwayFromTheProbes) {
    Scene scene(whole_grid(20, 20), {{31, 52}, {100, 100}, {170, 55}});
    const auto all = raw_shares(scene);
    const std::size_t on = scene.mesh.anchors[1];
    for (std::size_t v = 0; v < scene.cache->shape.vertices; ++v)
        for (std::size_t p = 0; v != on && p < 3; ++p) {
            EXPECT_GT(all[v * 3 + p], 0);
            EXPECT_LT(all[v * 3 + p], 1);
        }
}

TEST(Harmonic, IsTheMeanOfTheNeighboursWhereNobodyHolds) {
    // Large, so that panels are wide and many.
    Scene scene(whole_grid(100, 100), {{103, 207}, {500, 500}, {808.5, 301}, {807, 303}, {999, 1}});
    const auto all = raw_shares(scene);
    const auto places = places_of(scene.input(), scene.cache->shape);
    for (int row = 1; row < 100; ++row)
        for (int column = 1; column < 100; ++column) {
            const auto holds = [&](const Place& place) {
                return std::hypot(column * cell - place.at.x, row * cell - place.at.y) < 1.5 * cell;
            };
            if (std::ranges::any_of(places, holds)) continue;
            double sum = 0;
            for (std::size_t p = 0; p < places.size(); ++p) {
                const auto at = [&](int c, int r) { return all[scene.at(c, r) * places.size() + p]; };
                const double here = at(column, row);
                const double beside = at(column - 1, row) + at(column + 1, row);
                const double mean = (beside + at(column, row - 1) + at(column, row + 1)) / 4;
                ASSERT_NEAR(here, mean, 1e-13) << column << ' ' << row;  // a few roundings of shares of 1
                sum += here;
            }
            ASSERT_NEAR(sum, 1, 1e-9);  // the condition number is some 1e4, of 1e-16 each
        }
}

TEST(Harmonic, IsTheSameHoweverTheProbesCameThere) {
    expect_always("bit for bit, after other probes on the same shape or at once", [] {
        Scene scene(whole_grid(9, 7), {{12, 13}, {60, 50}, {85, 9}});
        for (int move = 0; move < 4; ++move) {
            std::vector<Probe> probes;
            for (int count = *whole(1, 5); count > 0; --count) {
                Probe probe;
                probe.rest = any_rest(9, 7);
                probe.radius = *real(0.01, 120);
                probes.push_back(probe);
            }
            std::vector<glm::dvec2> rests;
            for (const Probe& probe : probes) rests.push_back(probe.rest);
            Scene fresh(whole_grid(9, 7), rests);
            scene.mesh = fresh.mesh, scene.islands = fresh.islands, scene.probes = fresh.probes = probes;
            RC_ASSERT(raw_shares(scene) == raw_shares(fresh));
        }
    });
}

}  // namespace
}  // namespace probewarp
