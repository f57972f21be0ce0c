#include "raster/triangles.h"

#include <oneapi/tbb/blocked_range.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/parallel_reduce.h>

#include <cmath>
#include <numeric>

namespace probewarp {

namespace {

using Range = oneapi::tbb::blocked_range<std::size_t>;

/// Triangles that one thread looks at, at least.
constexpr std::size_t at_once = 1 << 12;

/// Bins from `first` to before `end`.
struct BinRange {
    std::uint32_t first = 0, end = 0;
};

/// The rows around a triangle, and one more on both sides, for corners are rounded. Empty beside the view.
BinRange bins_of(const Corners& corners, const View& view, int rows, std::size_t bins) {
    const auto x = [&](std::size_t k) { return (corners.now[k].x - view.origin.x) * view.scale.x; };
    const auto y = [&](std::size_t k) { return (corners.now[k].y - view.origin.y) * view.scale.y; };
    const auto [left, right] = std::minmax({x(0), x(1), x(2)});
    const auto [top, bottom] = std::minmax({y(0), y(1), y(2)});
    if (!(right >= -1 && left <= view.width + 1 && bottom >= -1 && top <= view.height + 1)) return {};
    const auto bin_at = [&](double row) { return std::clamp(row / rows, 0.0, double(bins)); };
    return {std::uint32_t(bin_at(top - 1)), std::uint32_t(std::ceil(bin_at(bottom + 1)))};
}

}  // namespace

float mipmap_level(double footprint_squared) {
    // Below 2 % of shrinking there is nothing to alias, and an unshrunk picture stays exact.
    return footprint_squared < 1.02 * 1.02 ? 0.0f : float(0.5 * std::log2(footprint_squared));
}

int wanted_levels(const DeformedMesh& mesh, const View& view) {
    const double largest = oneapi::tbb::parallel_reduce(
        Range(0, mesh.triangle_count(), at_once), 0.0,
        [&](const Range& range, double so_far) {
            for (std::size_t i = range.begin(); i < range.end(); ++i) {
                const Corners corners = corners_of(mesh, i);
                if (bins_of(corners, view, view.height, 1).end == 0) continue;
                const double squared = footprint_squared(lookup_of(corners, view));
                if (std::isfinite(squared)) so_far = std::max(so_far, squared);
            }
            return so_far;
        },
        [](double a, double b) { return std::max(a, b); });
    const float level = mipmap_level(largest);
    return level > 0 ? 1 + int(level) : 0;
}

TriangleBins bin_triangles(const DeformedMesh& mesh, const View& view, int rows) {
    const std::size_t bins = std::size_t((view.height + rows - 1) / rows);
    std::vector<BinRange> ranges(mesh.triangle_count());
    oneapi::tbb::parallel_for(Range(0, ranges.size(), at_once), [&](const Range& range) {
        for (std::size_t i = range.begin(); i < range.end(); ++i)
            ranges[i] = bins_of(corners_of(mesh, i), view, rows, bins);
    });
    TriangleBins binned{std::vector<std::size_t>(bins + 1), {}};
    for (const BinRange& range : ranges)
        for (std::uint32_t bin = range.first; bin < range.end; ++bin) ++binned.first[bin + 1];
    std::partial_sum(binned.first.begin(), binned.first.end(), binned.first.begin());
    binned.triangles.resize(binned.first.back());
    std::vector<std::size_t> next(binned.first.begin(), binned.first.end() - 1);
    for (std::size_t i = 0; i < ranges.size(); ++i)
        for (std::uint32_t bin = ranges[i].first; bin < ranges[i].end; ++bin)
            binned.triangles[next[bin]++] = std::uint32_t(i);
    return binned;
}

}  // namespace probewarp
