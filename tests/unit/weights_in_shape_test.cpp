// What holds for all weights within the shape, for any shape and any probes.

#include "shape_scene.h"

namespace probewarp {
namespace {

using namespace testing;

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

}  // namespace
}  // namespace probewarp
