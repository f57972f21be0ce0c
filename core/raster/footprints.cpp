#include "raster/footprints.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace probewarp {

namespace {

using glm::dvec2;

/// Below the 1.02 at which mesh.frag begins by what float can be wrong: it knows places to 1/512 of a pixel,
/// and their differences between neighbours far better.
constexpr double hardly_shrunk = 1.015;

/// The target pixel's sides in the picture at rest, the longer one. scale: target pixels per image pixel
double footprint(dvec2 rest1, dvec2 rest2, dvec2 now1, dvec2 now2, dvec2 scale) {
    const double area = now1.x * now2.y - now1.y * now2.x;
    const dvec2 across = (rest1 * now2.y - rest2 * now1.y) / (area * scale.x);
    const dvec2 down = (rest2 * now1.x - rest1 * now2.x) / (area * scale.y);
    const double longer = std::max(std::hypot(across.x, across.y), std::hypot(down.x, down.y));
    return longer >= 0 ? longer : std::numeric_limits<double>::infinity();  // NaN: no area
}

/// Whether the box, in image pixels, may show in the view.
bool touches(glm::vec2 least, glm::vec2 most, const View& view) {
    // A pixel more: the driver rounds corners.
    const dvec2 first = view.origin - 1.0 / view.scale,
                last = view.origin + (dvec2(view.width, view.height) + 1.0) / view.scale;
    return least.x <= last.x && least.y <= last.y && most.x >= first.x && most.y >= first.y;
}

}  // namespace

Footprints::Footprints(const Deformation& deformation, const View& view) {
    if (!deformation.moved) {
        const Image& picture = deformation.source.picture->image;
        largest_ = 1 / std::min(view.scale.x, view.scale.y);
        triangles_.push_back({{0, 0}, {picture.width, picture.height}, largest_ >= hardly_shrunk});
        return;
    }
    const Mesh& mesh = mesh_of(deformation);
    triangles_.reserve(mesh.triangles.size() / 3);
    for (std::size_t i = 0; i + 2 < mesh.triangles.size(); i += 3) {
        const std::uint32_t a = mesh.triangles[i], b = mesh.triangles[i + 1], c = mesh.triangles[i + 2];
        const glm::vec2 p = deformation.now[a], q = deformation.now[b], r = deformation.now[c];
        const dvec2 rest(mesh.rest[a]);
        const double pixels = footprint(dvec2(mesh.rest[b]) - rest, dvec2(mesh.rest[c]) - rest,
                                        dvec2(q) - dvec2(p), dvec2(r) - dvec2(p), view.scale);
        triangles_.push_back({{std::min({p.x, q.x, r.x}), std::min({p.y, q.y, r.y})},
                              {std::max({p.x, q.x, r.x}), std::max({p.y, q.y, r.y})},
                              pixels >= hardly_shrunk});
        if (touches(triangles_.back().least, triangles_.back().most, view))
            largest_ = std::max(largest_, pixels);
    }
}

int Footprints::wanted_levels() const {
    if (largest_ < hardly_shrunk) return 0;
    // mesh.frag mixes the two levels around log2; a hundredth more for its rounding.
    return 1 + int(std::min(31.0, std::log2(largest_ * 1.01)));
}

std::vector<TriangleRun> Footprints::runs_within(const View& view) const {
    std::vector<TriangleRun> runs;
    for (std::size_t i = 0; i < triangles_.size(); ++i) {
        const Triangle& triangle = triangles_[i];
        if (!touches(triangle.least, triangle.most, view)) continue;
        if (runs.empty() || runs.back().shrunk != triangle.shrunk) runs.push_back({i, 0, triangle.shrunk});
        runs.back().count = i + 1 - runs.back().first;
    }
    return runs;
}

}  // namespace probewarp
