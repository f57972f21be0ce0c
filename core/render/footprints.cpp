#include "render/footprints.h"

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

bool touches(const Footprint& triangle, const View& view) {
    // A pixel more: the driver rounds corners.
    const dvec2 least = view.origin - 1.0 / view.scale,
                most = view.origin + (dvec2(view.width, view.height) + 1.0) / view.scale;
    return triangle.least.x <= most.x && triangle.least.y <= most.y && triangle.most.x >= least.x &&
           triangle.most.y >= least.y;
}

}  // namespace

std::vector<Footprint> shrunk_triangles(const Deformation& deformation, const View& view) {
    const Image& picture = deformation.source.picture->image;
    if (!deformation.moved) {
        const double pixels = 1 / std::min(view.scale.x, view.scale.y);
        if (pixels < hardly_shrunk) return {};
        return {{{0, 0}, {picture.width, picture.height}, pixels}};
    }
    const Mesh& mesh = mesh_of(deformation);
    std::vector<Footprint> shrunk;
    for (std::size_t i = 0; i + 2 < mesh.triangles.size(); i += 3) {
        const std::uint32_t a = mesh.triangles[i], b = mesh.triangles[i + 1], c = mesh.triangles[i + 2];
        const glm::vec2 p = deformation.now[a], q = deformation.now[b], r = deformation.now[c];
        const dvec2 rest(mesh.rest[a]);
        const double pixels = footprint(dvec2(mesh.rest[b]) - rest, dvec2(mesh.rest[c]) - rest,
                                        dvec2(q) - dvec2(p), dvec2(r) - dvec2(p), view.scale);
        if (pixels < hardly_shrunk) continue;
        const Footprint triangle{{std::min({p.x, q.x, r.x}), std::min({p.y, q.y, r.y})},
                                 {std::max({p.x, q.x, r.x}), std::max({p.y, q.y, r.y})},
                                 pixels};
        if (touches(triangle, view)) shrunk.push_back(triangle);
    }
    return shrunk;
}

int wanted_levels(const std::vector<Footprint>& shrunk) {
    double most = 1;
    for (const Footprint& triangle : shrunk) most = std::max(most, triangle.pixels);
    if (most == 1) return 0;
    // mesh.frag mixes the two levels around log2; a hundredth more for its rounding.
    return 1 + int(std::min(31.0, std::log2(most * 1.01)));
}

bool any_within(const std::vector<Footprint>& shrunk, const View& view) {
    return std::any_of(shrunk.begin(), shrunk.end(), [&](const Footprint& t) { return touches(t, view); });
}

}  // namespace probewarp
