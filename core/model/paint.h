// Paint: what a person paints over the automatic weights of one probe, and how paint and automatic weights
// are settled into the weights that deform. A layer of its own, in the picture's plane, so that it outlives
// every mesh, scheme, probe position and picture.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/vec2.hpp>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

namespace probewarp {

inline constexpr int paint_tile_side = 64;    // texels
inline constexpr int max_paint_side = 32768;  // texels
inline constexpr std::size_t texels_a_tile = std::size_t{paint_tile_side} * paint_tile_side;
inline constexpr std::uint16_t paint_one = 65535;  // what stands for 1

/// 64 x 64 texels, row-major. Where coverage is 0 the value means nothing and is 0.
struct PaintTile {
    std::array<std::uint16_t, texels_a_tile> value{};     ///< 65535 is 1
    std::array<std::uint16_t, texels_a_tile> coverage{};  ///< 65535 is 1
};

/// Tiles along a side of that many texels: ceil(side / 64).
constexpr int tiles_along(int side) { return (side + paint_tile_side - 1) / paint_tile_side; }

/// A value: copies share their tiles, and a tile that is shared is never written to.
struct PaintMap {
    int width = 0, height = 0;  ///< texels
    /// Of the painted rectangle, in units of the picture's longer side, about the picture's centre: a picture
    /// of 400 x 300 has {1, 0.75}. Another picture put under the probes keeps it, as it keeps the probes.
    glm::dvec2 extent{0};
    /// Rows of tiles from the top-left corner, ceil(width / 64) a row; null where nothing is painted. Texels
    /// beyond the map's edge stay 0.
    std::vector<std::shared_ptr<const PaintTile>> tiles;

    /// The same tiles, not merely equal ones: what undo needs to know.
    friend bool operator==(const PaintMap&, const PaintMap&) = default;
};
using PaintPtr = std::shared_ptr<const PaintMap>;  ///< null: nothing is painted

/// Where a picture lies in the plane that its paint is about.
struct PictureFrame {
    glm::dvec2 centre{0};  ///< image pixels
    double longer = 1;     ///< the picture's longer side, image pixels
};

/// An empty map of width x height texels over `extent` (see PaintMap).
PaintMap empty_paint_map(int width, int height, glm::dvec2 extent);

/// An empty map over a picture of that size; as many texels along the longer side as the picture has pixels,
/// at least 256 and at most 2048.
PaintMap new_paint_map(int width, int height);

/// Image pixels to texels (texel centres at +0.5) and back.
glm::dvec2 to_texels(const PaintMap& map, const PictureFrame& frame, glm::dvec2 point);
glm::dvec2 to_picture(const PaintMap& map, const PictureFrame& frame, glm::dvec2 texel);

struct Paint {
    float value = 0;     ///< [0, 1]
    float coverage = 0;  ///< [0, 1]
    friend bool operator==(const Paint&, const Paint&) = default;
};

/// 65535 as 1: exactly n / 65535 in float, and back to the nearest n; what is beyond [0, 1] is cut, not a
/// number is 0.
constexpr float from_stored(std::uint16_t n) { return float(n) / float(paint_one); }
constexpr std::uint16_t to_stored(float x) {
    return x > 0 ? std::uint16_t(std::min(x, 1.0f) * float(paint_one) + 0.5f) : std::uint16_t{0};
}

/// The place in the map's tiles of the one that texel (x, y) is in.
inline std::size_t tile_at(const PaintMap& map, int x, int y) {
    return std::size_t(y / paint_tile_side) * std::size_t(tiles_along(map.width)) +
           std::size_t(x / paint_tile_side);
}

/// Texel `at` (row-major) of a tile; of null no paint.
inline Paint texel(const PaintTile* tile, std::size_t at) {
    return tile ? Paint{from_stored(tile->value[at]), from_stored(tile->coverage[at])} : Paint{};
}

/// One texel. Requires it inside. Exact: n / 65535 in float.
Paint texel(const PaintMap& map, int x, int y);

/// The four texels that a place of a map looks at, for several maps with the same texels.
struct Taps {
    std::array<std::size_t, 4> tile{}, at{};  ///< which tile, and where in it
    std::array<double, 4> weight{};           ///< sums to 1
};

/// `at`: texels. Empty outside the map.
std::optional<Taps> taps_at(const PaintMap& map, glm::dvec2 at);
Paint sample_at(const PaintMap& map, const Taps& taps);

/// Bilinear, at `at` texels: the coverage is the mean, the value the mean weighted by coverage. Beyond the
/// outermost texel centres but inside the map the outermost texels continue; outside the map there is no
/// paint. At a texel's centre exactly that texel.
Paint sample(const PaintMap& map, glm::dvec2 at);

/// Writes texels: calls `edit(x, y, Paint) -> Paint` once for each texel of the rectangle [left, right) x
/// [top, bottom), cut to the map, tile after tile, and rounds what it gives to 1/65535. Tiles are copied
/// before they are written to; a tile that ends up without coverage becomes null again, and one in which
/// nothing changed stays the same tile.
template <class Edit>
void edit_texels(PaintMap& map, int left, int top, int right, int bottom, Edit edit);

/// Whether two maps have the same texels over the same rectangle.
bool same_texels(const PaintMap& a, const PaintMap& b);

/// Whether there is any coverage.
bool is_blank(const PaintMap& map);

/// Bytes of the tiles that `map` has and `other` does not share (at the same place of a map of the same
/// size).
std::size_t own_bytes(const PaintMap& map, const PaintMap* other);

/// Settles one place's weights. With shares a_i (the automatic weights, made to sum to 1), values v_i and
/// coverages c_i: a probe follows c_i v_i + (1 - c_i) a_i x, where x is what lets the shares sum to 1. So a
/// probe that is fully covered has exactly its painted share, and the others divide the rest in proportion,
/// whatever was painted first. Where the painted shares c_i v_i alone are more than there is, or nobody could
/// follow the rest, they divide all there is in proportion; where they are 0 too, the automatic weights
/// stand.
///
/// Locked probes come first: each keeps k_i = c_i v_i + (1 - c_i) a_i, and the others divide what is left as
/// above. Where the k_i alone are more than 1, or no other can take what is left, they divide 1 in
/// proportion.
///
/// automatic: #probes, finite, >= 0, not all zero; paint: #probes; locked: #probes, 1 or 0; settled:
/// #probes, >= 0, sums to 1 (to float's rounding); may be `automatic`
void settle(std::span<const float> automatic, std::span<const Paint> paint,
            std::span<const std::uint8_t> locked, std::span<float> settled);

// Definitions.

/// Where one tile of the map lies in a rectangle of texels.
struct TileRect {
    std::size_t tile = 0;                          ///< its place in the map's tiles
    int left = 0, top = 0, right = 0, bottom = 0;  ///< texels of the map

    /// The place of texel (x, y) of the map in this tile.
    static std::size_t at(int x, int y) {
        return std::size_t(y % paint_tile_side) * paint_tile_side + std::size_t(x % paint_tile_side);
    }
};

/// Calls `visit(TileRect)` for each tile of the map that the rectangle meets, row by row.
template <class Visit>
void for_each_tile(const PaintMap& map, int left, int top, int right, int bottom, Visit visit) {
    constexpr int side = paint_tile_side;
    left = std::max(left, 0), top = std::max(top, 0);
    right = std::min(right, map.width), bottom = std::min(bottom, map.height);
    if (left >= right || top >= bottom) return;
    for (int row = top / side; row <= (bottom - 1) / side; ++row)
        for (int column = left / side; column <= (right - 1) / side; ++column)
            visit(TileRect{tile_at(map, column * side, row * side), std::max(left, column * side),
                           std::max(top, row * side), std::min(right, (column + 1) * side),
                           std::min(bottom, (row + 1) * side)});
}

template <class Edit>
void edit_texels(PaintMap& map, int left, int top, int right, int bottom, Edit edit) {
    for_each_tile(map, left, top, right, bottom, [&](const TileRect& rect) {
        const PaintTile* old = map.tiles[rect.tile].get();
        std::shared_ptr<PaintTile> copy;
        for (int y = rect.top; y < rect.bottom; ++y)
            for (int x = rect.left; x < rect.right; ++x) {
                const std::size_t at = TileRect::at(x, y);
                const Paint paint = edit(x, y, texel(old, at));
                const std::uint16_t coverage = to_stored(paint.coverage);
                const std::uint16_t value = coverage ? to_stored(paint.value) : std::uint16_t{0};
                const bool same = old ? coverage == old->coverage[at] && value == old->value[at] : !coverage;
                if (same) continue;
                if (!copy) copy = old ? std::make_shared<PaintTile>(*old) : std::make_shared<PaintTile>();
                copy->value[at] = value;
                copy->coverage[at] = coverage;
            }
        if (!copy) return;
        const bool covered = std::ranges::any_of(copy->coverage, [](auto c) { return c != 0; });
        map.tiles[rect.tile] = covered ? std::move(copy) : nullptr;
    });
}

}  // namespace probewarp
