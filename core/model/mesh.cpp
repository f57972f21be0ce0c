#include "model/mesh.h"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace probewarp {

std::array<int, 2> grid_size(int width, int height, int cells) {
    const int longer = std::max(width, height), shorter = std::min(width, height);
    const int across = std::max(1, int(std::lround(double(cells) * shorter / longer)));
    return width >= height ? std::array{cells, across} : std::array{across, cells};
}

Mesh grid_mesh(int width, int height, int cells) {
    assert(width > 0 && height > 0 && cells >= min_cells && cells <= max_cells);
    Mesh mesh;
    const auto [columns, rows] = grid_size(width, height, cells);
    mesh.columns = columns;
    mesh.rows = rows;
    mesh.rest.reserve(std::size_t(columns + 1) * std::size_t(rows + 1));
    for (int y = 0; y <= rows; ++y)
        for (int x = 0; x <= columns; ++x)
            mesh.rest.emplace_back(double(width) * x / columns, double(height) * y / rows);
    mesh.triangles.reserve(std::size_t(columns) * std::size_t(rows) * 6);
    for (int y = 0; y < rows; ++y)
        for (int x = 0; x < columns; ++x) {
            const auto top_left = std::uint32_t(y * (columns + 1) + x), top_right = top_left + 1;
            const auto bottom_left = top_left + std::uint32_t(columns + 1), bottom_right = bottom_left + 1;
            for (std::uint32_t corner :
                 {top_left, bottom_right, top_right, top_left, bottom_left, bottom_right})
                mesh.triangles.push_back(corner);
        }
    return mesh;
}

namespace {

double cross(glm::dvec2 a, glm::dvec2 b) { return a.x * b.y - a.y * b.x; }

/// Barycentric coordinates of `point`, where it lies in the triangle or on its edge.
std::optional<glm::dvec3> barycentric(glm::dvec2 a, glm::dvec2 b, glm::dvec2 c, glm::dvec2 point) {
    const double area = cross(b - a, c - a);
    if (area == 0) return {};
    const double u = cross(b - point, c - point) / area, v = cross(c - point, a - point) / area;
    const double w = 1 - u - v;
    constexpr double edge = -1e-9;  // a point on a shared edge belongs to either, never to none
    if (u < edge || v < edge || w < edge) return {};
    return glm::dvec3{u, v, w};
}

}  // namespace

std::optional<MeshPoint> locate(const Mesh& mesh, std::span<const glm::vec2> vertices, glm::dvec2 point) {
    assert(vertices.size() == mesh.rest.size());
    for (std::size_t t = mesh.triangles.size(); t > 0; t -= 3) {
        const std::array corners{mesh.triangles[t - 3], mesh.triangles[t - 2], mesh.triangles[t - 1]};
        if (const auto at =
                barycentric(vertices[corners[0]], vertices[corners[1]], vertices[corners[2]], point))
            return MeshPoint{corners, *at};
    }
    return {};
}

glm::dvec2 rest_point(const Mesh& mesh, const MeshPoint& at) {
    glm::dvec2 sum{0};
    for (int k = 0; k < 3; ++k) sum += at.barycentric[k] * glm::dvec2(mesh.rest[at.corners[std::size_t(k)]]);
    return sum;
}

}  // namespace probewarp
