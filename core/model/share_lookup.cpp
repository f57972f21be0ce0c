#include "model/share_lookup.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <deque>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <optional>

#include "model/refine.h"
#include "model/sum_of.h"

namespace probewarp {

namespace {

/// For each cell of the grid the nearest that is kept, counted in steps from cell to cell.
std::vector<std::uint32_t> nearest_kept_cells(const Mesh& mesh) {
    const auto columns = std::uint32_t(mesh.columns), cells = columns * std::uint32_t(mesh.rows);
    std::vector<std::uint32_t> nearest(cells, no_vertex);
    std::deque<std::uint32_t> front;
    const auto reach = [&](std::uint32_t cell, std::uint32_t from) {
        if (nearest[cell] != no_vertex) return;
        nearest[cell] = from;
        front.push_back(cell);
    };
    for (std::uint32_t cell = 0; cell < cells; ++cell)
        if (has_cell(mesh, cell)) reach(cell, cell);
    for (; !front.empty(); front.pop_front()) {
        const std::uint32_t cell = front.front(), from = nearest[cell];
        if (cell >= columns) reach(cell - columns, from);
        if (cell % columns > 0) reach(cell - 1, from);
        if (cell % columns + 1 < columns) reach(cell + 1, from);
        if (cell + columns < cells) reach(cell + columns, from);
    }
    return nearest;
}

}  // namespace

ShareLookup::ShareLookup(const Deformation& deformation)
    : deformation_(deformation),
      nearest_cell_(nearest_kept_cells(mesh_of(deformation))),
      frame_(frame_of(deformation.source.picture->image)) {
    const Document& document = deformation.source;
    const std::size_t probes = document.probes.size();
    // Whether the vertices' weights are not the paint's and the automatic ones alone.
    const bool interpolated = document.stiffness || is_limited(document);
    weights_ = interpolated ? weights_of(deformation) : std::span(deformation.binding->automatic);
    if (probes > 0)
        for (std::size_t row = 0; row < weights_.size(); row += probes)
            to_share_.push_back(float(1 / sum_of(weights_.subspan(row, probes))));
    for (std::size_t i = 0; i < probes; ++i) {
        locked_.push_back(document.probes[i].locked);
        if (interpolated || !document.probes[i].paint) continue;
        const PaintMap& map = *document.probes[i].paint;
        auto same = std::ranges::find_if(painted_, [&](const auto& p) { return same_texels(p.grid, map); });
        if (same == painted_.end()) same = painted_.insert(same, {map, {}});
        same->probes.push_back(i);
    }
    paint_.resize(probes);
    anchored_ = anchored_vertices(mesh_of(deformation));
}

MeshPoint ShareLookup::nearest_place(glm::dvec2 point) const {
    const Mesh& mesh = mesh_of(deformation_);
    if (const auto at = locate_at_rest(mesh, point)) return *at;
    const glm::dvec2 count(mesh.columns, mesh.rows), side = mesh.size / count;
    const glm::dvec2 over = glm::clamp(glm::floor(point / side), glm::dvec2(0), count - 1.0);
    const std::uint32_t cell =
        nearest_cell_[std::size_t(over.y) * std::size_t(mesh.columns) + std::size_t(over.x)];
    const glm::dvec2 corner(cell % std::uint32_t(mesh.columns), cell / std::uint32_t(mesh.columns));
    constexpr double hair = 1e-9;  // a cell's edge may be taken for its neighbour's, which may be left out
    return *locate_at_rest(mesh, glm::clamp(point, (corner + hair) * side, (corner + 1.0 - hair) * side));
}

float ShareLookup::sample_paint(glm::dvec2 point) const {
    float covered = 0;
    for (const auto& [grid, probes] : painted_) {
        const auto taps = taps_at(grid, to_texels(grid, frame_, point));
        for (const std::size_t i : probes) {
            paint_[i] = taps ? sample_at(*deformation_.source.probes[i].paint, *taps) : Paint{};
            covered = std::max(covered, paint_[i].coverage);
        }
    }
    return covered;
}

void ShareLookup::at(glm::dvec2 point, std::span<float> shares) const {
    const std::size_t probes = shares.size();
    assert(probes == paint_.size());
    if (probes == 0) return;
    const MeshPoint place = nearest_place(point);
    const float covered = sample_paint(point);
    std::array<const float*, 3> rows{};
    std::array<float, 3> part{};
    for (std::size_t k = 0; k < 3; ++k) {
        rows[k] = weights_.data() + place.corners[k] * probes;
        part[k] = float(place.barycentric[int(k)]) * to_share_[place.corners[k]];
        if (covered == 0 || !std::ranges::binary_search(anchored_, place.corners[k])) continue;
        opened_[k].assign(rows[k], rows[k] + probes);
        open_anchor(*deformation_.binding, anchored_, place.corners[k], covered, opened_[k]);
        rows[k] = opened_[k].data();
        part[k] = float(place.barycentric[int(k)]);
    }
    for (std::size_t i = 0; i < probes; ++i)
        shares[i] = part[0] * rows[0][i] + part[1] * rows[1][i] + part[2] * rows[2][i];
    if (covered > 0) settle(shares, paint_, locked_, shares);
}

ShareRaster share_raster(const Deformation& deformation, std::size_t probe, const PaintMap& map) {
    const ShareLookup lookup(deformation);
    const PictureFrame frame = frame_of(deformation.source.picture->image);
    std::vector<float> shares(deformation.source.probes.size());
    ShareRaster raster{map.width, map.height, {}};
    raster.share.reserve(std::size_t(map.width) * std::size_t(map.height));
    for (int y = 0; y < map.height; ++y)
        for (int x = 0; x < map.width; ++x) {
            lookup.at(to_picture(map, frame, {x + 0.5, y + 0.5}), shares);
            raster.share.push_back(std::clamp(shares[probe], 0.0f, 1.0f));
        }
    return raster;
}

namespace {

/// Rounds shares that sum to 1 to whole numbers of 1/65535 that sum to 65535: each is what it adds to the
/// rounded sum of those before it. The sums are exact, in 65536ths of a step, so a whole number stays one.
void round_shares(std::span<const float> shares, std::span<std::uint16_t> rounded) {
    constexpr std::int64_t step = 65536, half = step / 2;
    // Painted shares are whole numbers, known to float's rounding: 65535 / 2^24 of a step, with others' as
    // much.
    constexpr std::int64_t hair = step / 64;
    std::int64_t sum = half;
    for (std::size_t i = 0; i < shares.size(); ++i) {
        std::int64_t exact = std::int64_t(double(shares[i]) * (paint_one * double(step)) + 0.5);
        const std::int64_t whole = (exact + half) / step * step;
        if (std::abs(exact - whole) <= hair) exact = whole;
        const std::int64_t before = sum / step;
        sum += exact;
        rounded[i] = std::uint16_t(std::min<std::int64_t>(sum / step - before, paint_one));
    }
}

}  // namespace

std::vector<std::vector<std::uint16_t>> weight_images(const Deformation& deformation,
                                                      std::span<const std::size_t> probes, int width,
                                                      int height) {
    const ShareLookup lookup(deformation);
    const glm::dvec2 pixel = mesh_of(deformation).size / glm::dvec2(width, height);
    const std::size_t all = deformation.source.probes.size();
    std::vector<float> shares(all);
    std::vector<std::uint16_t> rounded(all);
    const std::size_t pixels = std::size_t(width) * std::size_t(height);
    std::vector<std::vector<std::uint16_t>> images(probes.size(), std::vector<std::uint16_t>(pixels));
    std::size_t at = 0;
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x, ++at) {
            lookup.at(glm::dvec2(x + 0.5, y + 0.5) * pixel, shares);
            round_shares(shares, rounded);
            for (std::size_t k = 0; k < probes.size(); ++k) images[k][at] = rounded[probes[k]];
        }
    return images;
}

}  // namespace probewarp
