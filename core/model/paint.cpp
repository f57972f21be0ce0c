#include "model/paint.h"

#include <cassert>
#include <cmath>

#include "model/sum_of.h"

namespace probewarp {

PaintMap empty_paint_map(int width, int height, glm::dvec2 extent) {
    PaintMap map;
    map.width = width;
    map.height = height;
    map.extent = extent;
    map.tiles.resize(std::size_t(tiles_along(width)) * std::size_t(tiles_along(height)));
    return map;
}

PaintMap new_paint_map(int width, int height) {
    assert(width > 0 && height > 0);
    constexpr int fewest = 256, most = 2048;
    const int longer = std::max(width, height), along = std::clamp(longer, fewest, most);
    const auto texels = [=](int side) {
        return std::max(1, int(std::lround(double(along) * side / longer)));
    };
    return empty_paint_map(texels(width), texels(height), glm::dvec2(width, height) / double(longer));
}

glm::dvec2 to_texels(const PaintMap& map, const PictureFrame& frame, glm::dvec2 point) {
    return ((point - frame.centre) / (frame.longer * map.extent) + 0.5) * glm::dvec2(map.width, map.height);
}

glm::dvec2 to_picture(const PaintMap& map, const PictureFrame& frame, glm::dvec2 texel) {
    return frame.centre + (texel / glm::dvec2(map.width, map.height) - 0.5) * (frame.longer * map.extent);
}

Paint texel(const PaintMap& map, int x, int y) {
    assert(x >= 0 && y >= 0 && x < map.width && y < map.height);
    return texel(map.tiles[tile_at(map, x, y)].get(), TileRect::at(x, y));
}

std::optional<Taps> taps_at(const PaintMap& map, glm::dvec2 at) {
    if (!(at.x >= 0 && at.y >= 0 && at.x <= map.width && at.y <= map.height)) return {};
    if (map.width < 1 || map.height < 1) return {};
    const double x = std::clamp(at.x - 0.5, 0.0, map.width - 1.0);
    const double y = std::clamp(at.y - 0.5, 0.0, map.height - 1.0);
    const int left = int(x), top = int(y);
    const double right_part = x - left, lower_part = y - top;
    const std::array<int, 2> columns{left, std::min(left + 1, map.width - 1)};
    const std::array<int, 2> rows{top, std::min(top + 1, map.height - 1)};
    Taps taps;
    for (std::size_t k = 0; k < 4; ++k) {
        const int column = columns[k % 2], row = rows[k / 2];
        taps.tile[k] = tile_at(map, column, row);
        taps.at[k] = TileRect::at(column, row);
        taps.weight[k] = (k % 2 ? right_part : 1 - right_part) * (k / 2 ? lower_part : 1 - lower_part);
    }
    return taps;
}

Paint sample_at(const PaintMap& map, const Taps& taps) {
    // In double the products of whole numbers are exact, and so is their quotient where only one texel
    // counts.
    double coverage = 0, covered_value = 0;  // in steps of 1/65535, and of its square
    for (std::size_t k = 0; k < 4; ++k) {
        const PaintTile* const tile = map.tiles[taps.tile[k]].get();
        if (!tile) continue;
        const double here = taps.weight[k] * tile->coverage[taps.at[k]];
        coverage += here;
        covered_value += here * tile->value[taps.at[k]];
    }
    if (!(coverage > 0)) return {};
    constexpr double one = paint_one;
    return {float(std::min(covered_value / (coverage * one), 1.0)), float(std::min(coverage / one, 1.0))};
}

Paint sample(const PaintMap& map, glm::dvec2 at) {
    const auto taps = taps_at(map, at);
    return taps ? sample_at(map, *taps) : Paint{};
}

bool same_texels(const PaintMap& a, const PaintMap& b) {
    return a.width == b.width && a.height == b.height && a.extent == b.extent;
}

bool is_blank(const PaintMap& map) {
    return std::ranges::none_of(map.tiles, [](const auto& tile) {
        return tile && std::ranges::any_of(tile->coverage, [](auto c) { return c != 0; });
    });
}

std::size_t own_bytes(const PaintMap& map, const PaintMap* other) {
    const bool comparable = other && other->width == map.width && other->height == map.height;
    std::size_t own = 0;
    for (std::size_t i = 0; i < map.tiles.size(); ++i)
        if (map.tiles[i] && !(comparable && other->tiles[i] == map.tiles[i])) own += sizeof(PaintTile);
    return own;
}

namespace {

/// What probes ask for at one place: `painted` the sum of c v, `following` that of (1 - c) a.
struct Demand {
    double painted = 0, following = 0;
};

/// c v factor_painted + (1 - c) a factor_following is what a probe gets.
struct Factors {
    double painted = 1, following = 1;
};

/// Divides `rest` so that all of it is taken; at least one of the demands is positive.
Factors divide(const Demand& demand, double rest) {
    if (demand.painted > rest || !(demand.following > 0)) return {rest / demand.painted, 0};
    return {1, (rest - demand.painted) / demand.following};
}

}  // namespace

void settle(std::span<const float> automatic, std::span<const Paint> paint,
            std::span<const std::uint8_t> locked, std::span<float> settled) {
    assert(paint.size() == automatic.size() && locked.size() == automatic.size() &&
           settled.size() == automatic.size());
    const double each = 1 / sum_of(automatic);
    const auto painted = [&](std::size_t i) { return double(paint[i].coverage) * paint[i].value; };
    const auto following = [&](std::size_t i) {
        return (1 - double(paint[i].coverage)) * (automatic[i] * each);
    };

    std::array<Demand, 2> demands;  // of those that are not locked, and of those that are
    for (std::size_t i = 0; i < automatic.size(); ++i) {
        Demand& demand = demands[locked[i] ? 1 : 0];
        demand.painted += painted(i);
        demand.following += following(i);
    }
    const auto& [free, kept] = demands;
    const double keep = kept.painted + kept.following;
    const bool free_take = free.painted > 0 || free.following > 0;
    const bool stand = !free_take && !(keep > 0);  // nobody wants anything: the automatic weights do
    Factors of_free{0, 0}, of_locked{1, 1};
    if (keep > 1 || (!free_take && keep > 0))
        of_locked = {1 / keep, 1 / keep};
    else if (free_take)
        of_free = divide(free, 1 - keep);
    for (std::size_t i = 0; i < automatic.size(); ++i) {
        const Factors& factors = locked[i] ? of_locked : of_free;
        settled[i] = float(stand ? automatic[i] * each
                                 : painted(i) * factors.painted + following(i) * factors.following);
    }
}

}  // namespace probewarp
