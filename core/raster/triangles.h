// A deformed mesh's triangles: which place of the picture at rest their pixels show, and in which rows they
// are.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <span>
#include <vector>

#include "raster/picture_drawer.h"

namespace probewarp {

/// The mesh as it is drawn.
struct DeformedMesh {
    std::span<const glm::vec2> rest, now;      ///< #vertices, image pixels
    std::span<const std::uint32_t> triangles;  ///< #triangles x 3

    std::size_t triangle_count() const { return triangles.size() / 3; }
};

/// A triangle's corners in the picture at rest, and where they are now: image pixels.
struct Corners {
    std::array<glm::dvec2, 3> rest, now;
};

inline Corners corners_of(const DeformedMesh& mesh, std::size_t triangle) {
    Corners corners;
    for (std::size_t k = 0; k < 3; ++k) {
        const std::uint32_t vertex = mesh.triangles[triangle * 3 + k];
        corners.rest[k] = glm::dvec2(mesh.rest[vertex]);
        corners.now[k] = glm::dvec2(mesh.now[vertex]);
    }
    return corners;
}

/// The target's point t shows the picture at rest at `at + across t.x + down t.y`, image pixels.
struct Lookup {
    glm::dvec2 at, across, down;
};

/// Not finite where the corners have no area. view: of the target
inline Lookup lookup_of(const Corners& corners, const View& view) {
    const auto on_target = [&](std::size_t k) { return (corners.now[k] - view.origin) * view.scale; };
    const auto back = [&](std::size_t k) { return corners.rest[k] - corners.now[k]; };
    const glm::dvec2 p = on_target(1) - on_target(0), q = on_target(2) - on_target(0);
    // The way back is 0 all over a triangle that has not moved, which then shows the picture's own pixels.
    const glm::dvec2 u = back(1) - back(0), v = back(2) - back(0);
    const double area = p.x * q.y - p.y * q.x;
    const glm::dvec2 across = (u * q.y - v * p.y) / area, down = (v * p.x - u * q.x) / area;
    return {view.origin + back(0) - across * on_target(0).x - down * on_target(0).y,
            glm::dvec2(1 / view.scale.x, 0) + across, glm::dvec2(0, 1 / view.scale.y) + down};
}

/// How many of the picture's pixels a target pixel spans there along its longer side; squared.
inline double footprint_squared(const Lookup& lookup) {
    return std::max(glm::dot(lookup.across, lookup.across), glm::dot(lookup.down, lookup.down));
}

/// The mipmap to look up, 0 being the picture; its fraction is how much of the next one is mixed in:
/// shaders/mesh.frag.
float mipmap_level(double footprint_squared);

/// How many mipmaps can be wanted where the view is drawn: 0 where nothing shrinks.
int wanted_levels(const DeformedMesh& mesh, const View& view);

/// Which triangles may show in which rows of a view.
struct TriangleBins {
    std::vector<std::size_t> first;        ///< #bins + 1: where each bin begins in `triangles`
    std::vector<std::uint32_t> triangles;  ///< in each bin in the mesh's order

    std::span<const std::uint32_t> bin(std::size_t i) const {
        return std::span(triangles).subspan(first[i], first[i + 1] - first[i]);
    }
};

/// rows: of each bin but the last
TriangleBins bin_triangles(const DeformedMesh& mesh, const View& view, int rows);

}  // namespace probewarp
