// A deformed mesh's triangles, and which place of the picture at rest their pixels show.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <glm/vec2.hpp>
#include <span>

#include "raster/picture_drawer.h"

namespace probewarp {

/// The mesh as it is drawn.
struct DeformedMesh {
    std::span<const glm::vec2> rest, now;      ///< #vertices, image pixels
    std::span<const std::uint32_t> triangles;  ///< #triangles x 3
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

/// How many of the picture's pixels a target pixel spans along its longer side there.
inline double footprint(const Lookup& lookup) {
    return std::max(std::hypot(lookup.across.x, lookup.across.y), std::hypot(lookup.down.x, lookup.down.y));
}

}  // namespace probewarp
