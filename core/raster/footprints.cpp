#include "raster/footprints.h"

#include <algorithm>
#include <cmath>

#include "raster/triangles.h"

namespace probewarp {

namespace {

/// Below the 1.02 at which drawing begins with mipmaps by what a graphics driver's float can be wrong: it
/// knows places to 1/512 of a pixel, and their differences between neighbours far better.
constexpr double hardly_shrunk = 1.015;

DeformedMesh deformed_mesh(const Deformation& deformation) {
    const Mesh& mesh = mesh_of(deformation);
    return {mesh.rest, deformation.now, mesh.triangles};
}

/// Pixels of the picture that a target pixel spans at most.
double largest_footprint(const Deformation& deformation, const View& view) {
    if (!deformation.moved) return 1 / std::min(view.scale.x, view.scale.y);
    const DeformedMesh mesh = deformed_mesh(deformation);
    const TriangleRun visible = TriangleBoxes(deformation).within(view);
    double largest = 1;
    for (std::size_t i = visible.first; i < visible.first + visible.count; ++i)
        if (const double pixels = footprint(lookup_of(corners_of(mesh, i), view)); std::isfinite(pixels))
            largest = std::max(largest, pixels);
    return largest;
}

}  // namespace

int wanted_levels(const Deformation& deformation, const View& view) {
    const double largest = largest_footprint(deformation, view);
    if (largest < hardly_shrunk) return 0;
    // Two levels are mixed around log2; a hundredth more for its rounding.
    return 1 + int(std::min(31.0, std::log2(largest * 1.01)));
}

TriangleBoxes::TriangleBoxes(const Deformation& deformation) {
    if (!deformation.moved) return;
    const DeformedMesh mesh = deformed_mesh(deformation);
    boxes_.reserve(mesh.triangles.size() / 3);
    for (std::size_t i = 0; i < mesh.triangles.size() / 3; ++i) {
        const auto [a, b, c] = corners_of(mesh, i).now;
        boxes_.push_back({{std::min({a.x, b.x, c.x}), std::min({a.y, b.y, c.y})},
                          {std::max({a.x, b.x, c.x}), std::max({a.y, b.y, c.y})}});
    }
}

TriangleRun TriangleBoxes::within(const View& view) const {
    // A pixel more: corners are rounded.
    const glm::dvec2 first = view.origin - 1.0 / view.scale,
                     last = view.origin + (glm::dvec2(view.width, view.height) + 1.0) / view.scale;
    TriangleRun run;
    for (std::size_t i = 0; i < boxes_.size(); ++i) {
        const Box& box = boxes_[i];
        if (box.least.x > last.x || box.least.y > last.y || box.most.x < first.x || box.most.y < first.y)
            continue;
        if (run.count == 0) run.first = i;
        run.count = i + 1 - run.first;
    }
    return run;
}

}  // namespace probewarp
