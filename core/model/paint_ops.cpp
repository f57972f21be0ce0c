#include "model/paint_ops.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace probewarp {

PaintMap paint_of(const PaintMap& map, const ShareRaster& raster) {
    assert(raster.width == map.width && raster.height == map.height);
    PaintMap result = map;
    std::ranges::fill(result.tiles, nullptr);
    const std::size_t across = std::size_t(raster.width);
    edit_texels(result, 0, 0, map.width, map.height, [&](int x, int y, Paint) {
        return Paint{raster.share[std::size_t(y) * across + std::size_t(x)], 1};
    });
    return result;
}

PaintMap filled(const PaintMap& map, float value) {
    constexpr int side = paint_tile_side;
    const auto full = std::make_shared<PaintTile>();
    full->value.fill(to_stored(value));
    full->coverage.fill(paint_one);
    PaintMap result = map;
    std::ranges::fill(result.tiles, nullptr);
    const int whole_right = map.width / side * side, whole_bottom = map.height / side * side;
    for_each_tile(map, 0, 0, whole_right, whole_bottom,
                  [&](const TileRect& rect) { result.tiles[rect.tile] = full; });
    // Beyond the map's edge texels stay 0: the tiles there are not full ones.
    const auto fill = [value](int, int, Paint) { return Paint{value, 1}; };
    edit_texels(result, whole_right, 0, map.width, map.height, fill);
    edit_texels(result, 0, whole_bottom, whole_right, map.height, fill);
    return result;
}

ShareRaster inverted(ShareRaster raster) {
    for (float& share : raster.share) share = 1 - share;
    return raster;
}

ShareRaster levelled(ShareRaster raster, float black, float white, float gamma) {
    assert(black < white && gamma > 0);
    for (float& share : raster.share) {
        const float part = std::clamp((share - black) / (white - black), 0.0f, 1.0f);
        share = gamma == 1 ? part : std::pow(part, 1 / gamma);
    }
    return raster;
}

namespace {

constexpr double widest_blur = 32;  // texels: a wider Gaussian is blurred at half the size

/// Half of a Gaussian, from its middle outwards.
std::vector<float> gaussian(double radius) {
    std::vector<float> taps;
    for (int d = 0; d <= int(std::ceil(4 * radius)); ++d)
        taps.push_back(float(std::exp(-d * d / (2 * radius * radius))));
    return taps;
}

/// Blurs along columns of floats: `lines` rows of `across` floats each, every float with those above and
/// below.
std::vector<float> blurred_down(const std::vector<float>& from, int across, int lines,
                                const std::vector<float>& taps) {
    const std::size_t width = std::size_t(across);
    std::vector<float> to(from.size());
    for (int y = 0; y < lines; ++y) {
        float* const out = to.data() + std::size_t(y) * width;
        const int reach = int(taps.size()) - 1;
        float total = 0;
        for (int other = std::max(0, y - reach); other <= std::min(lines - 1, y + reach); ++other) {
            const float tap = taps[std::size_t(std::abs(other - y))];
            const float* const in = from.data() + std::size_t(other) * width;
            for (std::size_t x = 0; x < width; ++x) out[x] += tap * in[x];
            total += tap;
        }
        for (std::size_t x = 0; x < width; ++x) out[x] = std::min(out[x] / total, 1.0f);
    }
    return to;
}

std::vector<float> transposed(const std::vector<float>& from, int width, int height) {
    constexpr int block = 32;  // what of both fits into the processor's cache
    std::vector<float> to(from.size());
    for (int top = 0; top < height; top += block)
        for (int left = 0; left < width; left += block)
            for (int y = top; y < std::min(top + block, height); ++y)
                for (int x = left; x < std::min(left + block, width); ++x)
                    to[std::size_t(x) * std::size_t(height) + std::size_t(y)] =
                        from[std::size_t(y) * std::size_t(width) + std::size_t(x)];
    return to;
}

/// Means of 2 x 2 texels; an odd last row or column stands for itself.
ShareRaster halved(const ShareRaster& raster) {
    ShareRaster half{(raster.width + 1) / 2, (raster.height + 1) / 2, {}};
    const auto share = [&](int x, int y) {
        return raster.share[std::size_t(std::min(y, raster.height - 1)) * std::size_t(raster.width) +
                            std::size_t(std::min(x, raster.width - 1))];
    };
    for (int y = 0; y < raster.height; y += 2)
        for (int x = 0; x < raster.width; x += 2)
            half.share.push_back((share(x, y) + share(x + 1, y) + share(x, y + 1) + share(x + 1, y + 1)) / 4);
    return half;
}

/// Bilinear, to twice the size less what `halved` added.
ShareRaster doubled(const ShareRaster& half, int width, int height) {
    ShareRaster raster{width, height, {}};
    raster.share.reserve(std::size_t(width) * std::size_t(height));
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            // The nearest texel of the half counts three quarters, the next one a quarter.
            const int near_x = x / 2, far_x = std::clamp(near_x + (x % 2 ? 1 : -1), 0, half.width - 1);
            const int near_y = y / 2, far_y = std::clamp(near_y + (y % 2 ? 1 : -1), 0, half.height - 1);
            const auto share = [&](int column, int row) {
                return half.share[std::size_t(row) * std::size_t(half.width) + std::size_t(column)];
            };
            raster.share.push_back(0.5625f * share(near_x, near_y) + 0.1875f * share(far_x, near_y) +
                                   0.1875f * share(near_x, far_y) + 0.0625f * share(far_x, far_y));
        }
    return raster;
}

}  // namespace

ShareRaster blurred(const ShareRaster& raster, double radius) {
    assert(std::isfinite(radius));
    if (!(radius > 0)) return raster;
    if (radius > widest_blur) {
        // Halving and doubling blur by themselves: 1/4 and 1/2 of the variance of radius 1.
        const double rest = std::sqrt(radius * radius - 0.75) / 2;
        return doubled(blurred(halved(raster), rest), raster.width, raster.height);
    }
    const std::vector<float> taps = gaussian(radius);
    ShareRaster result{raster.width, raster.height, {}};
    result.share = blurred_down(raster.share, raster.width, raster.height, taps);
    result.share = transposed(result.share, raster.width, raster.height);
    result.share = blurred_down(result.share, raster.height, raster.width, taps);
    result.share = transposed(result.share, raster.height, raster.width);
    return result;
}

namespace {

/// How far `point` lies beyond the axis, seen from `side`, image pixels; negative on the side itself.
double beyond(const MirrorAxis& axis, Side side, glm::dvec2 point) {
    const glm::dvec2 rightwards(std::cos(axis.angle), std::sin(axis.angle));
    const double right = glm::dot(point - axis.point, rightwards);
    return side == Side::left ? right : -right;
}

/// As sample, but of the texels whose centres are on the side, so that nothing of what is to be replaced
/// shines through along the axis.
Paint sample_side(const PaintMap& map, const PictureFrame& frame, const MirrorAxis& axis, Side side,
                  glm::dvec2 point) {
    const glm::dvec2 at = to_texels(map, frame, point);
    const glm::dvec2 texel_side = frame.longer * map.extent / glm::dvec2(map.width, map.height);
    if (beyond(axis, side, point) < -glm::length(texel_side)) return sample(map, at);
    if (!(at.x >= 0 && at.y >= 0 && at.x <= map.width && at.y <= map.height)) return {};
    const glm::dvec2 last(map.width - 1, map.height - 1);
    const glm::dvec2 place = glm::clamp(at - 0.5, glm::dvec2(0), last);
    const glm::dvec2 corner = glm::floor(place), part = place - corner;
    const double hair = 1e-9 * frame.longer;
    double weight = 0, coverage = 0, covered_value = 0;
    for (const int right : {0, 1})
        for (const int down : {0, 1}) {
            const glm::dvec2 other = glm::min(corner + glm::dvec2(right, down), last);
            if (beyond(axis, side, to_picture(map, frame, other + 0.5)) > hair) continue;
            const double w = (right ? part.x : 1 - part.x) * (down ? part.y : 1 - part.y);
            const Paint paint = texel(map, int(other.x), int(other.y));
            weight += w;
            coverage += w * paint.coverage;
            covered_value += w * (double(paint.coverage) * paint.value);
        }
    if (!(weight > 0)) return sample(map, at);  // the map's edge alone is on the side
    if (!(coverage > 0)) return {};
    return {float(std::min(covered_value / coverage, 1.0)), float(std::min(coverage / weight, 1.0))};
}

}  // namespace

PaintMap mirrored_paint(const PaintMap& onto, const PaintMap& from, const PictureFrame& frame,
                        const MirrorAxis& axis, Side side) {
    PaintMap result = onto;
    const double hair = 1e-9 * frame.longer;  // what lies on the axis itself stays
    edit_texels(result, 0, 0, onto.width, onto.height, [&](int x, int y, Paint old) {
        const glm::dvec2 point = to_picture(onto, frame, {x + 0.5, y + 0.5});
        if (beyond(axis, side, point) <= hair) return old;
        return sample_side(from, frame, axis, side, reflect(axis, point));
    });
    return result;
}

PaintMap mirrored_paint(const PaintMap& map, const PictureFrame& frame, const MirrorAxis& axis, Side side) {
    return mirrored_paint(map, map, frame, axis, side);
}

namespace {

/// Changes the texels with coverage of the maps of `probes`, which all have the same texels: to
/// edit(probe, shares, Paint) -> value, with shares the settled ones there, #probes of the document. They are
/// worked out once for all of the maps, tile after tile.
template <class Edit>
void edit_covered(std::vector<PaintMap>& maps, std::span<const std::size_t> probes, const ShareLookup& lookup,
                  const PictureFrame& frame, Edit edit) {
    const PaintMap grid = maps[probes.front()];
    const std::size_t all = maps.size(), side = paint_tile_side;
    std::vector<float> shares(side * side * all);  // texels of a tile x #probes, row-major
    for_each_tile(grid, 0, 0, grid.width, grid.height, [&](const TileRect& rect) {
        const auto has_tile = [&](std::size_t i) { return maps[i].tiles[rect.tile] != nullptr; };
        if (std::ranges::none_of(probes, has_tile)) return;
        const auto at = [&](int x, int y) {
            return std::span(shares).subspan(TileRect::at(x, y) * all, all);
        };
        for (int y = rect.top; y < rect.bottom; ++y)
            for (int x = rect.left; x < rect.right; ++x)
                lookup.at(to_picture(grid, frame, {x + 0.5, y + 0.5}), at(x, y));
        for (const std::size_t i : probes) {
            if (!has_tile(i)) continue;
            edit_texels(maps[i], rect.left, rect.top, rect.right, rect.bottom, [&](int x, int y, Paint old) {
                if (old.coverage > 0) old.value = edit(i, at(x, y), old);
                return old;
            });
        }
    });
}

/// The document with every painted probe's map edited so; a map in which nothing changed stays the same.
template <class Edit>
Document with_covered(const Deformation& deformation, Edit edit) {
    Document document = deformation.source;
    const PictureFrame frame = frame_of(document.picture->image);
    const ShareLookup lookup(deformation);
    std::vector<PaintMap> maps(document.probes.size());
    std::vector<std::size_t> left;
    for (std::size_t i = 0; i < maps.size(); ++i)
        if (document.probes[i].paint && !document.probes[i].locked)
            maps[i] = *document.probes[i].paint, left.push_back(i);
    while (!left.empty()) {
        const PaintMap first = maps[left.front()];
        const auto others = std::stable_partition(left.begin(), left.end(),
                                                  [&](std::size_t i) { return same_texels(maps[i], first); });
        edit_covered(maps, {left.begin(), others}, lookup, frame, edit);
        left.erase(left.begin(), others);
    }
    for (std::size_t i = 0; i < maps.size(); ++i) {
        PaintPtr& paint = document.probes[i].paint;
        if (paint && !document.probes[i].locked && !(*paint == maps[i]))
            paint = std::make_shared<const PaintMap>(std::move(maps[i]));
    }
    return document;
}

}  // namespace

Document normalised_paint(const Deformation& deformation) {
    return with_covered(deformation, [](std::size_t probe, std::span<const float> shares, Paint) {
        return std::clamp(shares[probe], 0.0f, 1.0f);
    });
}

Document limited_paint(const Deformation& deformation, std::size_t most) {
    assert(most > 0);
    return with_covered(deformation, [most](std::size_t probe, std::span<const float> shares, Paint old) {
        std::size_t heavier = 0;
        for (std::size_t i = 0; i < shares.size(); ++i)
            heavier += shares[i] > shares[probe] || (shares[i] == shares[probe] && i < probe);
        return heavier < most ? old.value : 0.0f;
    });
}

std::size_t counterpart(const Document& document, std::size_t probe, const MirrorAxis& axis) {
    assert(probe < document.probes.size());
    const glm::dvec2 image = reflect(axis, document.probes[probe].rest);
    std::size_t found = probe;
    double nearest = counterpart_reach * frame_of(document.picture->image).longer;
    for (std::size_t i = 0; i < document.probes.size(); ++i) {
        const double distance = glm::distance(document.probes[i].rest, image);
        if (distance >= nearest) continue;
        nearest = distance;
        found = i;
    }
    return found;
}

}  // namespace probewarp
