// The grid mesh that carries the picture, and the question which of its triangles lies under a point.
#pragma once

#include <array>
#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <optional>
#include <span>
#include <vector>

namespace probewarp {

inline constexpr int min_cells = 1;
inline constexpr int max_cells = 1000;
inline constexpr int default_cells = 100;

struct Mesh {
    int columns = 0;  ///< cells along x
    int rows = 0;     ///< cells along y
    /// #vertices = (columns + 1) (rows + 1), row by row from the top-left corner; image pixels.
    std::vector<glm::vec2> rest;
    /// #triangles x 3 places in `rest`; two triangles a cell, cut from its top-left to its bottom-right
    /// corner.
    std::vector<std::uint32_t> triangles;
};

/// Cells along x and y: `cells` along the longer side, max(1, round(cells short / long)) along the shorter.
std::array<int, 2> grid_size(int width, int height, int cells);

/// The grid over [0, width] x [0, height]. Requires cells in [min_cells, max_cells].
Mesh grid_mesh(int width, int height, int cells);

struct MeshPoint {
    std::array<std::uint32_t, 3> corners;  ///< places in the mesh's vertices
    glm::dvec3 barycentric;                ///< of the corners; sums to 1
};

/// The topmost triangle under `point`: where the deformed mesh folds, the last drawn. Empty outside the mesh.
/// vertices: #vertices, image pixels, the mesh's deformed (or rest) vertices.
std::optional<MeshPoint> locate(const Mesh& mesh, std::span<const glm::vec2> vertices, glm::dvec2 point);

/// The point of the picture at rest that `at` names.
glm::dvec2 rest_point(const Mesh& mesh, const MeshPoint& at);

}  // namespace probewarp
