#include "model/brush.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <glm/geometric.hpp>
#include <limits>

namespace probewarp {

namespace {

std::vector<float>& tile_of(std::vector<std::vector<float>>& tiles, const PaintMap& map, std::size_t tile,
                            float otherwise) {
    if (tiles.empty()) tiles.resize(map.tiles.size());
    if (tiles[tile].empty()) tiles[tile].assign(texels_a_tile, otherwise);
    return tiles[tile];
}

float within_nought_and_one(float x) { return x > 0 ? std::min(x, 1.0f) : 0.0f; }

/// The share at each texel of a rectangle of the map before the stroke, asked for where it is not known yet:
/// calls `visit(x, y, share)`, tile after tile.
template <class Visit>
void for_each_share(Stroke& stroke, const ShareAt& share, TileRect rect, Visit visit) {
    for_each_tile(stroke.before, rect.left, rect.top, rect.right, rect.bottom, [&](const TileRect& part) {
        std::vector<float>& known = tile_of(stroke.share, stroke.before, part.tile, -1);
        for (int y = part.top; y < part.bottom; ++y)
            for (int x = part.left; x < part.right; ++x) {
                float& s = known[TileRect::at(x, y)];
                if (s < 0) s = within_nought_and_one(share(x, y));
                visit(x, y, s);
            }
    });
}

/// For each texel of a tile's rectangle the mean share over the square of `reach` texels around, cut to the
/// map. Returns its rows x its columns.
std::vector<float> mean_shares(Stroke& stroke, const ShareAt& share, const TileRect& rect, int reach) {
    const int left = std::max(rect.left - reach, 0), top = std::max(rect.top - reach, 0);
    const int right = std::min(rect.right + reach, stroke.before.width);
    const int bottom = std::min(rect.bottom + reach, stroke.before.height);
    // A summed-area table: at (x, y) the sum of all shares above and to the left of that corner.
    const std::size_t across = std::size_t(right - left) + 1;
    std::vector<double> sums(across * (std::size_t(bottom - top) + 1));
    const auto sum = [&](int x, int y) -> double& {
        return sums[std::size_t(y - top) * across + std::size_t(x - left)];
    };
    for_each_share(stroke, share, {0, left, top, right, bottom},
                   [&](int x, int y, float s) { sum(x + 1, y + 1) = s; });
    for (int y = top + 1; y <= bottom; ++y)
        for (int x = left + 1; x <= right; ++x)
            sum(x, y) += sum(x - 1, y) + sum(x, y - 1) - sum(x - 1, y - 1);

    std::vector<float> means;
    for (int y = rect.top; y < rect.bottom; ++y)
        for (int x = rect.left; x < rect.right; ++x) {
            const int x0 = std::max(x - reach, left), x1 = std::min(x + reach + 1, right);
            const int y0 = std::max(y - reach, top), y1 = std::min(y + reach + 1, bottom);
            const double inside = sum(x1, y1) - sum(x0, y1) - sum(x1, y0) + sum(x0, y0);
            means.push_back(within_nought_and_one(float(inside / (double(x1 - x0) * (y1 - y0)))));
        }
    return means;
}

/// What replace leaves on a texel with V = value.
Paint covered(Paint before, float fallen, float value) {
    const float kept = (1 - fallen) * before.coverage, coverage = kept + fallen;
    return {(kept * before.value + fallen * value) / coverage, coverage};
}

BrushMode opposite(BrushMode mode) {
    if (mode == BrushMode::add) return BrushMode::subtract;
    return mode == BrushMode::subtract ? BrushMode::add : mode;
}

/// What a mask has for the texels of one tile's rectangle.
struct MaskPart {
    const Mask& mask;
    const TileRect& rect;

    float operator()(int x, int y) const { return mask.strength[mask.at(x, y)]; }
    bool empty() const {
        for (int y = rect.top; y < rect.bottom; ++y)
            for (int x = rect.left; x < rect.right; ++x)
                if ((*this)(x, y) > 0) return false;
        return true;
    }
};

}  // namespace

void dab(PaintMap& map, Stroke& stroke, const Mask& mask, const Brush& brush, bool inverted,
         const ShareAt& share) {
    const BrushMode mode = inverted ? opposite(brush.mode) : brush.mode;
    const auto strength = float(brush.strength);
    const auto value = float(brush.mode == BrushMode::replace && inverted ? 1 - brush.value : brush.value);
    const int reach = std::max(1, int(mask.radius / 8));
    const auto fall = [&](const TileRect& rect) {
        const MaskPart part{mask, rect};
        if (part.empty()) return;
        std::vector<float>& fallen = tile_of(stroke.fallen, map, rect.tile, 0);
        const bool asks = mode == BrushMode::add || mode == BrushMode::subtract;
        std::vector<float>* known = asks ? &tile_of(stroke.share, map, rect.tile, -1) : nullptr;
        std::vector<float> means;
        if (mode == BrushMode::smooth) means = mean_shares(stroke, share, rect, reach);
        const auto painted = [&](int x, int y) {
            if (mode == BrushMode::smooth)
                return means[std::size_t(y - rect.top) * std::size_t(rect.right - rect.left) +
                             std::size_t(x - rect.left)];
            if (mode == BrushMode::replace) return value;
            float& s = (*known)[TileRect::at(x, y)];
            if (s < 0) s = within_nought_and_one(share(x, y));
            return within_nought_and_one(mode == BrushMode::add ? s + value : s - value);
        };
        const PaintTile* before = stroke.before.tiles[rect.tile].get();
        edit_texels(map, rect.left, rect.top, rect.right, rect.bottom, [&](int x, int y, Paint so_far) {
            const std::size_t at = TileRect::at(x, y);
            const float m = strength * part(x, y);
            const float sum = brush.build_up ? fallen[at] + (1 - fallen[at]) * m : std::max(fallen[at], m);
            if (!(sum > fallen[at])) return so_far;
            fallen[at] = std::min(sum, 1.0f);
            const Paint old = texel(before, at);
            if (mode == BrushMode::erase) return Paint{old.value, old.coverage * (1 - fallen[at])};
            return covered(old, fallen[at], painted(x, y));
        });
    };
    for_each_tile(map, mask.left, mask.top, mask.left + mask.width, mask.top + mask.height, fall);
}

std::vector<glm::dvec2> dabs_between(glm::dvec2 last, glm::dvec2 to, const Brush& brush) {
    constexpr double most = 4096;
    const double length = glm::distance(last, to), spacing = brush.spacing * brush.radius;
    if (!(length < std::numeric_limits<double>::infinity())) return {};
    // A path of whole spacings has all of its dabs, whatever the last digit says.
    const double whole = std::floor(length / spacing + 1e-9);
    if (!(whole >= 1)) return {};
    const int count = int(std::min(whole, most));
    const glm::dvec2 step = (to - last) / length * (whole > most ? length / most : spacing);
    std::vector<glm::dvec2> dabs;
    for (int k = 1; k <= count; ++k) dabs.push_back(last + double(k) * step);
    return dabs;
}

}  // namespace probewarp
