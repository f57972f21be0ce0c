#include "raster/scan_conversion.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace probewarp {

namespace {

using glm::dvec2;

/// The side of a triangle from its upper end to its lower one: the same whichever triangle's it is.
struct Side {
    dvec2 upper;
    double slope;  ///< how far it goes right on its way down by one

    Side(dvec2 from, dvec2 to) : upper(from), slope((to.x - from.x) / (to.y - from.y)) {}
    double x_at(double y) const { return upper.x + (y - upper.y) * slope; }
};

/// Drivers put corners on a grid of 1/256 of a pixel.
dvec2 snapped(dvec2 corner) {
    constexpr double steps = 256;
    return {std::nearbyint(corner.x * steps) / steps, std::nearbyint(corner.y * steps) / steps};
}

/// The first pixel whose centre is at `from` or beyond, in [least, most].
int first_centre(double from, int least, int most) {
    return int(std::clamp(std::ceil(from - 0.5), double(least), double(most)));
}

/// Calls cover(row, first, end) for each row's pixels from `first` to before `end`. corners: target pixels
template <class Cover>
void cover_rows(std::array<dvec2, 3> corners, const Rows& rows, int width, const Cover& cover) {
    std::sort(corners.begin(), corners.end(),
              [](dvec2 a, dvec2 b) { return a.y < b.y || (a.y == b.y && a.x < b.x); });
    const auto [top, middle, bottom] = corners;
    const double area = (middle.x - top.x) * (bottom.y - top.y) - (bottom.x - top.x) * (middle.y - top.y);
    if (area == 0) return;
    const Side whole(top, bottom);
    for (const auto& [upper, lower] : {std::pair(top, middle), std::pair(middle, bottom)}) {
        const int first = first_centre(upper.y, rows.first, rows.end);
        const int end = first_centre(lower.y, rows.first, rows.end);
        if (first >= end) continue;
        const Side half(upper, lower);
        const Side &left = area > 0 ? whole : half, &right = area > 0 ? half : whole;
        for (int row = first; row < end; ++row) {
            const int from = first_centre(left.x_at(row + 0.5), 0, width);
            const int to = first_centre(right.x_at(row + 0.5), 0, width);
            if (from < to) cover(row, from, to);
        }
    }
}

}  // namespace

std::vector<std::vector<PixelSpan>> scan_convert(const DeformedMesh& mesh,
                                                 std::span<const std::uint32_t> triangles, const View& view,
                                                 const Rows& rows, int last_level) {
    std::vector<std::vector<PixelSpan>> spans(std::size_t(rows.end - rows.first));
    for (const std::uint32_t triangle : triangles) {
        const Corners corners = corners_of(mesh, triangle);
        const Lookup lookup = lookup_of(corners, view);
        const double footprint = footprint_squared(lookup);
        if (!std::isfinite(footprint)) continue;  // no area
        const float level = std::min(mipmap_level(footprint), float(last_level));
        std::array<dvec2, 3> on_grid;
        for (std::size_t k = 0; k < 3; ++k) on_grid[k] = snapped((corners.now[k] - view.origin) * view.scale);
        cover_rows(on_grid, rows, view.width, [&](int row, int first, int end) {
            const dvec2 at = lookup.at + lookup.across * (first + 0.5) + lookup.down * (row + 0.5);
            spans[std::size_t(row - rows.first)].push_back({first, end, at, lookup.across, level});
        });
    }
    return spans;
}

double lowest_lookup(const DeformedMesh& mesh, std::span<const std::uint32_t> triangles, const View& view,
                     const Rows& rows, double widest) {
    double lowest = 0;
    for (const std::uint32_t triangle : triangles) {
        const Corners corners = corners_of(mesh, triangle);
        const Lookup lookup = lookup_of(corners, view);
        const double footprint = std::sqrt(footprint_squared(lookup));
        if (!std::isfinite(footprint)) continue;
        if (footprint > widest) return std::numeric_limits<double>::infinity();
        // Its highest place on the target, and where that box, cut to the rows, reaches down at rest.
        const auto x = [&](std::size_t k) { return (corners.now[k].x - view.origin.x) * view.scale.x; };
        const auto y = [&](std::size_t k) { return (corners.now[k].y - view.origin.y) * view.scale.y; };
        const auto [left, right] = std::minmax({x(0), x(1), x(2)});
        const auto [top, bottom] = std::minmax({y(0), y(1), y(2)});
        const double from = std::clamp(left, 0.0, double(view.width)),
                     to = std::clamp(right, 0.0, double(view.width));
        const double first = std::max(top, double(rows.first)), end = std::min(bottom, double(rows.end));
        const double in_box = lookup.at.y + std::max(lookup.across.y * from, lookup.across.y * to) +
                              std::max(lookup.down.y * first, lookup.down.y * end);
        const double in_triangle = std::max({corners.rest[0].y, corners.rest[1].y, corners.rest[2].y});
        // Corners are put on a grid, and a mipmap's pixel is up to twice the footprint.
        lowest = std::max(lowest, std::min(in_box, in_triangle) + 4 * footprint + 2);
    }
    return lowest;
}

}  // namespace probewarp
