// The weights within the shape: known answers for each scheme, the maximum principle, and what holds for any
// shape and any probes.
#include "model/weights_in_shape.h"

#include <algorithm>
#include <atomic>
#include <map>

#include "generators.h"
#include "model/error.h"

namespace probewarp {
namespace {

using testing::expect_always;
using testing::real;
using testing::whole;

constexpr int cell = 10;  // image pixels along each side

/// A mesh of the cells marked '#', with probes on it.
struct Scene {
    Mesh mesh;
    Islands islands;
    std::vector<Probe> probes;
    std::shared_ptr<WeightCache> cache{};
    std::atomic<bool> given_up{false};

    Scene(const std::vector<std::string>& cells, const std::vector<glm::dvec2>& rests) {
        for (const glm::dvec2 rest : rests) {
            Probe probe;
            probe.rest = probe.now = rest;
            probe.radius = 0.01;  // points, but where a test says otherwise
            probes.push_back(probe);
        }
        Image image;
        image.width = int(cells[0].size()) * cell;
        image.height = int(cells.size()) * cell;
        std::vector<std::uint8_t> kept;
        for (const std::string& row : cells)
            for (const char c : row) kept.push_back(c == '#');
        mesh = probe_mesh(image, int(std::max(cells.size(), cells[0].size())), kept, rests);
        islands = islands_of(mesh);
    }
    WeightInput input(double exponent = 2) { return {mesh, islands, probes, exponent, cache, &given_up}; }
    /// The vertex at that crossing of the grid.
    std::size_t at(int column, int row) const {
        return mesh.grid[std::size_t(row) * std::size_t(mesh.columns + 1) + std::size_t(column)];
    }
};

std::vector<std::string> whole_grid(int columns, int rows) {
    return std::vector<std::string>(std::size_t(rows), std::string(std::size_t(columns), '#'));
}

using Table = std::vector<float>;

/// Of the probe in the row: its part of the row's sum.
double share(const Table& table, std::size_t probes, std::size_t vertex, std::size_t probe) {
    double sum = 0;
    for (std::size_t i = 0; i < probes; ++i) sum += double(table[vertex * probes + i]);
    return double(table[vertex * probes + probe]) / sum;
}

struct Scheme {
    const char* name;
    Table (*table)(const WeightInput&);
};
constexpr Scheme schemes[] = {
    {"geodesic", geodesic_table}, {"harmonic", harmonic_table}, {"biharmonic", biharmonic_table}};

/// The raw harmonic shares: #grid vertices x #places.
std::vector<double> raw_shares(Scene& scene, HarmonicWay way) {
    const WeightInput input = scene.input();
    WeightCache& cache = cache_for(input);
    const auto places = places_of(input, cache.shape);
    std::vector<double> all(cache.shape.vertices * places.size(), -1);
    harmonic_shares(
        input, cache, places, way,
        [&](std::size_t vertex, std::size_t place, std::span<const double> part, std::size_t across) {
            for (std::size_t k = 0; k < part.size(); ++k)
                all[(vertex + k / across) * places.size() + place + k % across] = part[k];
        });
    return all;
}

/// A whole cell more often than chance would have it; somewhat beside the picture, too.
glm::dvec2 any_rest(int columns, int rows) {
    const auto coordinate = [](int cells) {
        const double anywhere = *real(-0.3 * cell, (cells + 0.3) * cell);
        return *whole(0, 3) == 0 ? std::round(anywhere / cell) * cell : anywhere;
    };
    return {coordinate(columns), coordinate(rows)};
}

/// Some cells of a small grid, at least one, and up to `most` probes, some in the same place.
std::unique_ptr<Scene> any_scene(int most) {
    const int columns = *whole(1, 8), rows = *whole(1, 8);
    auto cells = whole_grid(columns, rows);
    for (std::string& row : cells)
        for (char& c : row) c = *whole(0, 9) < 7 ? '#' : '.';
    cells[0][0] = '#';
    std::vector<glm::dvec2> rests{any_rest(columns, rows)};
    const int count = *whole(1, most);
    while (int(rests.size()) < count)
        rests.push_back(*whole(0, 5) == 0 ? rests.front() : any_rest(columns, rows));
    return std::make_unique<Scene>(cells, rests);
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
            } else if (d > 30) {
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
        const auto all = raw_shares(*scene, HarmonicWay::by_columns);
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
    const auto all = raw_shares(scene, HarmonicWay::by_columns);
    const std::size_t on = scene.mesh.anchors[1];
    for (std::size_t v = 0; v < scene.cache->shape.vertices; ++v)
        for (std::size_t p = 0; v != on && p < 3; ++p) {
            EXPECT_GT(all[v * 3 + p], 0);
            EXPECT_LT(all[v * 3 + p], 1);
        }
}

TEST(Harmonic, IsTheSameEitherWay) {
    expect_always("by columns = directly", [] {
        const auto scene = any_scene(10);
        const auto one = raw_shares(*scene, HarmonicWay::by_columns);
        const auto other = raw_shares(*scene, HarmonicWay::directly);
        std::vector<std::uint8_t> inhabited(std::size_t(scene->islands.count), 0);
        for (const Place& place : places_of(scene->input(), scene->cache->shape))
            inhabited[std::size_t(place.island)] = 1;
        const std::size_t places = one.size() / scene->cache->shape.vertices;
        for (std::size_t k = 0; k < one.size(); ++k)
            if (inhabited[std::size_t(scene->islands.of[k / places])])
                RC_ASSERT(std::abs(one[k] - other[k]) < 1e-9);  // as above
    });
    // A size at which the condition number tells: some 1e4 at 10'000 vertices, of 1e-16 each.
    Scene scene(whole_grid(100, 100), {{103, 207}, {500, 500}, {808.5, 301}, {807, 303}, {999, 1}});
    const auto one = raw_shares(scene, HarmonicWay::by_columns);
    const auto other = raw_shares(scene, HarmonicWay::directly);
    double apart = 0;
    for (std::size_t k = 0; k < one.size(); ++k) apart = std::max(apart, std::abs(one[k] - other[k]));
    EXPECT_LT(apart, 1e-9);
}

TEST(Geodesic, IsEuclideanWhereNothingIsInTheWay) {
    constexpr int n = 60;
    for (const glm::dvec2 rest : {glm::dvec2{0, 0}, {300, 300}, {123.4, 377.7}, {599, 20}}) {
        Scene scene(whole_grid(n, n), {rest});
        const WeightInput input = scene.input();
        const Shape shape = shape_of(scene.mesh);
        const auto distances = geodesic_distances(shape, places_of(input, shape)[0]);
        for (std::size_t v = 0; v < distances.size(); ++v) {
            const glm::dvec2 away = glm::dvec2(scene.mesh.rest[v]) - rest;
            const double straight = std::hypot(away.x, away.y);
            // Never shorter (but for a float); marching takes the front to be straight between vertices,
            // which after the first rings costs at most 1.5 per cent.
            EXPECT_GE(distances[v], straight * (1 - 1e-6));
            EXPECT_LE(distances[v], straight * 1.015);
        }
    }
}

TEST(Geodesic, GoesRoundAnObstacle) {
    // A wall from the top down to row 30, ten columns wide.
    auto cells = whole_grid(50, 40);
    for (int row = 0; row < 30; ++row)
        for (int column = 20; column < 30; ++column) cells[std::size_t(row)][std::size_t(column)] = '.';
    Scene scene(cells, {{100, 50}});
    const WeightInput input = scene.input();
    const Shape shape = shape_of(scene.mesh);
    const auto distances = geodesic_distances(shape, places_of(input, shape)[0]);
    // Down to the wall's one corner (200, 300), along to the other (300, 300), and up to the vertex.
    for (const auto [column, row] : {std::array{30, 0}, std::array{40, 5}, std::array{50, 20}}) {
        const double way = std::hypot(100, 250) + 100 + std::hypot(column * cell - 300, row * cell - 300);
        EXPECT_NEAR(double(distances[scene.at(column, row)]), way, 0.03 * way);  // as above, once a corner
    }
}

TEST(Geodesic, IsRadiusOverDistanceToTheExponent) {
    Scene scene(whole_grid(9, 1), {{0, 5}, {90, 5}});
    scene.probes[0].radius = 50;
    scene.probes[1].radius = 100;
    const std::size_t v = scene.at(3, 0);
    for (const double exponent : {1.0, 2.0, 3.5}) {
        const Table table = geodesic_table(scene.input(exponent));
        // Six cells around a probe are measured as the crow flies; floats.
        EXPECT_NEAR(table[2 * v + 1] / table[2 * v],
                    std::pow(100 / std::hypot(60, 5) / (50 / std::hypot(30, 5)), exponent), 1e-5);
    }
}

/// Two legs, four cells wide and one apart, hanging from a bar.
std::vector<std::string> two_legs() {
    std::vector<std::string> cells(3, "#########");
    cells.resize(60, "####.####");
    return cells;
}

TEST(WeightsInShape, DoNotReachAcrossBetweenTheLegs) {
    constexpr int foot = 57;  // the probes' row, three above the soles
    for (const Scheme& scheme : schemes) {
        Scene scene(two_legs(), {{20, foot * cell}, {70, foot * cell}});
        const Table table = scheme.table(scene.input());
        for (int row = foot + 1; row <= 60; ++row)  // the foot's part of the leg, below the probe
            for (int column = 0; column <= 4; ++column)
                EXPECT_LT(share(table, 2, scene.at(column, row), 1), 0.01)
                    << scheme.name << " " << column << ", " << row;
    }
    // By the formula of the inverse distance, the other leg would have more than a quarter of the inner side.
    const double own = 1 / std::pow(20, 2), other = 1 / std::pow(30, 2);
    EXPECT_GT(other / (own + other), 0.25);
}

TEST(WeightsInShape, AreExactAtAProbeWhereverInTheCellItIs) {
    for (const Scheme& scheme : schemes)
        for (const glm::dvec2 in_cell : {glm::dvec2{0, 0},
                                         {5, 5},
                                         {5, 0},
                                         {0, 5},
                                         {7, 2},
                                         {2, 7},
                                         {10, 10},
                                         {0.01, 0},
                                         {9.99, 0.01},
                                         {3, 3.0001},
                                         {3, 2.9999}}) {
            Scene scene(whole_grid(8, 8), {glm::dvec2(30) + in_cell, {12, 71}, {75, 8}});
            const Table table = scheme.table(scene.input());
            for (std::size_t i = 0; i < 3; ++i)
                for (std::size_t k = 0; k < 3; ++k)
                    EXPECT_EQ(table[scene.mesh.anchors[i] * 3 + k], i == k ? 1 : 0) << scheme.name;
        }
}

TEST(WeightsInShape, ChangeLittleAsAProbeCrossesAnEdgeOrAVertex) {
    struct Crossing {
        glm::dvec2 from, to;
    };
    // Across a cell's left edge, its top edge, its diagonal, through a vertex, and onto one.
    const Crossing crossings[] = {{{79.99, 83}, {80.01, 83}},
                                  {{83, 79.99}, {83, 80.01}},
                                  {{84.01, 84}, {84, 84.01}},
                                  {{79.99, 79.995}, {80.01, 80.005}},
                                  {{80.003, 80.002}, {80, 80}}};
    for (const Scheme& scheme : schemes)
        for (const auto& [from, to] : crossings) {
            const std::vector<glm::dvec2> others{{20, 20}, {140, 61}};
            Scene before(whole_grid(16, 16), {from, others[0], others[1]});
            Scene after(whole_grid(16, 16), {to, others[0], others[1]});
            const Table one = scheme.table(before.input()), other = scheme.table(after.input());
            for (std::size_t v = 0; v < before.cache->shape.vertices; ++v)
                for (std::size_t i = 0; i < 3; ++i) {
                    // The rest moves by 0.003 cells at most, and a share's slope is 1 a cell at most.
                    // Marching starts from another block of cells: half its error, as above, and weights go
                    // by the distance's square.
                    EXPECT_NEAR(share(one, 3, v, i), share(other, 3, v, i), 0.01)
                        << scheme.name << " " << v << " " << from.x << ", " << from.y;
                }
        }
}

TEST(WeightsInShape, AnIslandWithoutAProbeFollowsTheNearest) {
    const std::vector<std::string> cells{"##..##..##", "##..##..##"};
    for (const Scheme& scheme : schemes) {
        Scene scene(cells, {{95, 12}, {13, 4}, {4, 13}});
        const auto followed = followed_probes(scene.input());
        // From the middle island's sides at 40 and 60: 35 to the first, 27 to the second.
        EXPECT_EQ(followed, (std::vector<std::uint32_t>{no_vertex, 1, no_vertex}));
        const Table table = scheme.table(scene.input());
        for (const int column : {4, 5, 6})
            for (std::size_t i = 0; i < 3; ++i)
                EXPECT_EQ(table[scene.at(column, 1) * 3 + i], i == 1 ? 1 : 0) << scheme.name;
        for (const int column : {8, 9, 10})
            for (std::size_t i = 0; i < 3; ++i)
                EXPECT_EQ(table[scene.at(column, 0) * 3 + i], i == 0 ? 1 : 0) << scheme.name;
        EXPECT_EQ(table[scene.at(0, 0) * 3], 0) << scheme.name;
    }
    Scene between({"#.#"}, {{15, 5}, {15, 5}});
    // On neither: both sit on the nearest vertex, the first of equals, and the other island follows the
    // first.
    EXPECT_EQ(followed_probes(between.input()), (std::vector<std::uint32_t>{no_vertex, 0}));
}

TEST(WeightsInShape, AProbeBesideTheMeshSitsOnTheNearestVertexThatIsFree) {
    for (const Scheme& scheme : schemes) {
        Scene scene(whole_grid(6, 6), {{0, 0}, {-4, -3}});
        ASSERT_EQ(scene.mesh.anchors[1], no_vertex);
        const Table table = scheme.table(scene.input());
        EXPECT_EQ(table[scene.at(0, 0) * 2], 1);
        EXPECT_EQ(table[scene.at(0, 0) * 2 + 1], 0);
        // (0, 10) is 13.6 away and (10, 0) 14.3.
        EXPECT_EQ(table[scene.at(0, 1) * 2 + 1], 1);
        EXPECT_LT(table[scene.at(0, 1) * 2], 0.02f)
            << scheme.name;  // a biharmonic hold of 300 gives a little
    }
}

TEST(WeightsInShape, OneProbeHasAllTheWeight) {
    for (const Scheme& scheme : schemes)
        for (const glm::dvec2 rest : {glm::dvec2{33, 21}, {30, 20}, {-50, 1000}}) {
            Scene scene({"##.##", "##.##", "##.##"}, {rest});
            const Table table = scheme.table(scene.input());
            EXPECT_EQ(table, Table(scene.mesh.rest.size(), 1.0f)) << scheme.name;
        }
}

TEST(WeightsInShape, ProbesInOnePlaceShareIt) {
    for (const Scheme& scheme : schemes) {
        Scene pair(whole_grid(12, 12), {{33, 41}, {90, 80}, {33, 41}});
        Scene alone(whole_grid(12, 12), {{33, 41}, {90, 80}});
        const Table table = scheme.table(pair.input()), single = scheme.table(alone.input());
        const float* anchored = table.data() + pair.mesh.anchors[0] * 3;
        EXPECT_EQ(Table(anchored, anchored + 3), (Table{1, 0, 1}));
        for (std::size_t v = 0; v < pair.cache->shape.vertices; ++v) {
            EXPECT_EQ(table[v * 3], table[v * 3 + 2]) << scheme.name;
            // Two of them pull twice by the distance, and together as one where shares are solved for.
            const double both = 2 * share(table, 3, v, 0), one = share(single, 2, v, 0);
            if (scheme.table == geodesic_table)
                EXPECT_NEAR(both, 2 * one / (1 + one), 1e-6);
            else
                EXPECT_NEAR(both, one, 1e-6) << scheme.name;
        }
    }
}

void expect_sound(const Table& table, std::size_t probes, const char* name) {
    ASSERT_EQ(table.size() % probes, 0u);
    for (std::size_t at = 0; at < table.size(); at += probes) {
        const auto row = std::span(table).subspan(at, probes);
        ASSERT_TRUE(std::all_of(row.begin(), row.end(), [](float w) { return w >= 0 && w <= 1; })) << name;
        ASSERT_EQ(*std::max_element(row.begin(), row.end()), 1) << name;
    }
}

TEST(WeightsInShape, TakeProbesInALineAndManyInOneCell) {
    std::vector<glm::dvec2> line, crowd;
    for (int k = 0; k < 12; ++k) {
        line.emplace_back(7 + 9.3 * k, 3 + 9.3 * k);
        crowd.emplace_back(51 + 0.7 * k, 58 - 0.6 * k);
    }
    for (const Scheme& scheme : schemes)
        for (const auto& rests : {line, crowd}) {
            Scene scene(whole_grid(12, 12), rests);
            expect_sound(scheme.table(scene.input()), rests.size(), scheme.name);
        }
}

TEST(WeightsInShape, TakeFiveHundredProbes) {
    std::vector<glm::dvec2> rests;
    for (int k = 0; k < 500; ++k)  // spread by the golden ratio and its like
        rests.emplace_back(std::fmod(k * 0.754877666, 1.0) * 400, std::fmod(k * 0.569840296, 1.0) * 300);
    for (const Scheme& scheme : schemes) {
        Scene scene(whole_grid(40, 30), rests);
        expect_sound(scheme.table(scene.input()), rests.size(), scheme.name);
    }
}

TEST(WeightsInShape, AreWithinNoughtAndOneForAnyShapeAndProbes) {
    expect_always("finite, >= 0, the largest 1, and the anchors' own", [] {
        const auto scene = any_scene(8);
        const std::size_t probes = scene->probes.size();
        for (Probe& probe : scene->probes) probe.radius = *real(0.001, 1000);
        for (const Scheme& scheme : schemes) {
            const Table table = scheme.table(scene->input(*real(min_exponent, max_exponent)));
            RC_ASSERT(table.size() == scene->mesh.rest.size() * probes);
            for (std::size_t at = 0; at < table.size(); at += probes) {
                for (std::size_t i = 0; i < probes; ++i)  // false for NaN
                    RC_ASSERT(table[at + i] >= 0 && table[at + i] <= 1);
                RC_ASSERT(*std::max_element(&table[at], &table[at] + probes) == 1);
            }
            const auto& anchors = scene->mesh.anchors;
            for (const std::uint32_t v : anchors)
                for (std::size_t i = 0; v != no_vertex && i < probes; ++i)
                    RC_ASSERT(table[v * probes + i] == float(anchors[i] == v));
        }
    });
}

TEST(WeightsInShape, AreTheSameFromACacheAsAnew) {
    expect_always("kept = anew", [] {
        auto cells = whole_grid(6, 6);
        cells[2][3] = cells[3][3] = '.';
        std::vector<glm::dvec2> rests{{12, 13}, {50, 20}, {33, 46}};
        std::shared_ptr<WeightCache> kept[std::size(schemes)];
        for (int move = 0; move < 3; ++move) {
            rests[std::size_t(*whole(0, 2))] = any_rest(6, 6);
            // Also another shape: one with the same vertices and a cell fewer.
            if (*whole(0, 3) == 0) cells[4][4] = cells[4][4] == '#' ? '.' : '#';
            for (std::size_t s = 0; s < std::size(schemes); ++s) {
                Scene scene(cells, rests), anew(cells, rests);
                scene.cache = kept[s];
                const Table one = schemes[s].table(scene.input()), other = schemes[s].table(anew.input());
                kept[s] = scene.cache;
                for (std::size_t k = 0; k < one.size(); ++k)
                    RC_ASSERT(std::abs(one[k] - other[k]) < 1e-6f);  // some roundings of a float
            }
        }
    });
}

TEST(WeightsInShape, KeepWhatDidNotChange) {
    Scene before(whole_grid(9, 9), {{12, 13}, {70, 20}}), after(whole_grid(9, 9), {{12, 13}, {44, 77}});
    geodesic_table(before.input());
    const float* distances = before.cache->distances.at({12, 13}).data();
    after.cache = before.cache;
    geodesic_table(after.input());
    EXPECT_EQ(after.cache, before.cache);
    EXPECT_EQ(after.cache->distances.at({12, 13}).data(), distances);
    EXPECT_EQ(after.cache->distances.size(), 2u);  // the moved probe's old ones are gone
}

TEST(WeightsInShape, StopWhereNobodyWantsThem) {
    for (const Scheme& scheme : schemes) {
        Scene scene(whole_grid(9, 9), {{12, 13}, {70, 20}});
        scene.given_up = true;
        EXPECT_THROW(scheme.table(scene.input()), GivenUp) << scheme.name;
        // What was left behind serves the next time.
        scene.given_up = false;
        Scene anew(whole_grid(9, 9), {{12, 13}, {70, 20}});
        EXPECT_EQ(scheme.table(scene.input()), scheme.table(anew.input())) << scheme.name;
    }
}

TEST(Biharmonic, SaysWhatToDoWhereTheMeshIsTooFine) {
    Scene scene(whole_grid(700, 700), {{12, 13}});
    try {
        biharmonic_table(scene.input());
        ADD_FAILURE() << "took it";
    } catch (const Error& error) {
        EXPECT_STREQ(error.what(),
                     "biharmonic weights take at most 330000 vertices: choose a coarser mesh or the "
                     "harmonic weights");
    }
}

TEST(Biharmonic, ComesToRestInThePlane) {
    // Two probes side by side: 1 behind either, and in between where thirty times as many rounds of the
    // search end. The harmonic shares, where it starts, are 0.75 two cells off.
    Scene scene(whole_grid(40, 40), {{100, 200}, {300, 200}});
    const Table start = harmonic_table(scene.input()), table = biharmonic_table(scene.input());
    EXPECT_LT(share(start, 2, scene.at(12, 20), 0), 0.8);
    for (const auto& [column, rest] : {std::pair{5, 1.0}, {8, 1.0}, {12, 0.9368}, {14, 0.8460}, {16, 0.7388}})
        EXPECT_NEAR(share(table, 2, scene.at(column, 20), 0), rest, 0.008) << column;  // see `stop`
    // A half where one is as far as the other, from either side alike (floats).
    for (int row = 0; row <= 40; ++row) EXPECT_NEAR(share(table, 2, scene.at(20, row), 0), 0.5, 1e-6) << row;
}

TEST(Biharmonic, IsSmoothAndBoundedBetweenTwoProbes) {
    // Between the ends of a strip the energy is least for the cubic 1 - 3 t^2 + 2 t^3, flat at either end,
    // where the bounds keep it from going beyond.
    constexpr int n = 40;
    Scene scene(whole_grid(n, 1), {{0, 5}, {n * cell, 5}});
    const Table table = biharmonic_table(scene.input());
    for (int column = 0; column <= n; ++column) {
        const double t = double(column) / n;
        // The search ends within some thousandths, and a grid's curve bends a cell later.
        EXPECT_NEAR(share(table, 2, scene.at(column, 0), 0), 1 - 3 * t * t + 2 * t * t * t, 0.02) << column;
    }
}

}  // namespace
}  // namespace probewarp
