// Meshes drawn with characters, with probes on them, for the tests of the weights within the shape.
#pragma once

#include <algorithm>
#include <atomic>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "generators.h"
#include "model/weights_in_shape.h"

namespace probewarp::testing {

inline constexpr int cell = 10;  // image pixels along each side

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

inline std::vector<std::string> whole_grid(int columns, int rows) {
    return std::vector<std::string>(std::size_t(rows), std::string(std::size_t(columns), '#'));
}

using Table = std::vector<float>;

/// Of the probe in the row: its part of the row's sum.
inline double share(const Table& table, std::size_t probes, std::size_t vertex, std::size_t probe) {
    double sum = 0;
    for (std::size_t i = 0; i < probes; ++i) sum += double(table[vertex * probes + i]);
    return double(table[vertex * probes + probe]) / sum;
}

struct Scheme {
    const char* name;
    Table (*table)(const WeightInput&);
};
inline constexpr Scheme schemes[] = {
    {"geodesic", geodesic_table}, {"harmonic", harmonic_table}, {"biharmonic", biharmonic_table}};
/// A whole cell more often than chance would have it; somewhat beside the picture, too.
inline glm::dvec2 any_rest(int columns, int rows) {
    const auto coordinate = [](int cells) {
        const double anywhere = *real(-0.3 * cell, (cells + 0.3) * cell);
        return *whole(0, 3) == 0 ? std::round(anywhere / cell) * cell : anywhere;
    };
    return {coordinate(columns), coordinate(rows)};
}

/// Some cells of a small grid, at least one, and up to `most` probes, some in the same place.
inline std::unique_ptr<Scene> any_scene(int most) {
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

}  // namespace probewarp::testing
