#include "model/folds.h"

#include <oneapi/tbb/blocked_range.h>
#include <oneapi/tbb/parallel_reduce.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <functional>

namespace probewarp {

namespace {

/// Whether a triangle is turned over. Its corners at rest go round from the y axis towards the x axis.
bool is_folded(glm::dvec2 a, glm::dvec2 b, glm::dvec2 c) {
    const glm::dvec2 p = b - a, q = c - a;
    const double turned_over = p.x * q.y - p.y * q.x;
    if (!(turned_over > 0)) return false;
    // A float has 24 bits, and the blend rounds a few times: a sliver beside a probe may have less height.
    const double rounding =
        4 * 0x1p-24 *
        std::max({std::abs(a.x), std::abs(a.y), std::abs(b.x), std::abs(b.y), std::abs(c.x), std::abs(c.y)});
    return turned_over > rounding * (std::abs(p.x) + std::abs(p.y) + std::abs(q.x) + std::abs(q.y));
}

}  // namespace

std::size_t folded_triangles(const Mesh& mesh, std::span<const glm::vec2> now) {
    assert(now.size() == mesh.rest.size());
    using Range = oneapi::tbb::blocked_range<std::size_t>;
    constexpr std::size_t at_once = 1 << 14;  // triangles
    const std::uint32_t* const corners = mesh.triangles.data();
    return oneapi::tbb::parallel_reduce(
        Range(0, mesh.triangles.size() / 3, at_once), std::size_t{0},
        [&](const Range& range, std::size_t so_far) {
            for (std::size_t i = range.begin(); i < range.end(); ++i)
                so_far += is_folded(now[corners[3 * i]], now[corners[3 * i + 1]], now[corners[3 * i + 2]]);
            return so_far;
        },
        std::plus<>());
}

}  // namespace probewarp
