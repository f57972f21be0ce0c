// The geodesic weights: known distances within a shape.

#include "shape_scene.h"

namespace probewarp {
namespace {

using namespace testing;

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

}  // namespace
}  // namespace probewarp
