// The brush: where on the paint a dab on the deformed picture falls, and what it does there.
#pragma once

#include <functional>
#include <glm/vec2.hpp>
#include <span>
#include <string_view>
#include <vector>

#include "model/image.h"
#include "model/mesh.h"
#include "model/paint.h"

namespace probewarp {

enum class BrushMode { replace, add, subtract, smooth, erase };

struct Brush {
    BrushMode mode = BrushMode::replace;
    double radius = 60;     ///< image pixels of the deformed picture, > 0
    double hardness = 0;    ///< [0, 1]: the part of the radius within which a dab is whole
    double strength = 1;    ///< (0, 1]: of a whole dab
    double spacing = 0.15;  ///< (0, 1]: between dabs along a stroke, of the radius
    double value = 1;       ///< [0, 1]: what replace paints; what add and subtract add at full strength
    bool build_up = false;  ///< dabs of one stroke pile up
};

/// 3 p^2 - 2 p^3 with p = (1 - d/R) / (1 - hardness), at most 1: how much of a dab falls at distance d. 0 at
/// d >= R.
double falloff(double distance, double radius, double hardness);

/// How much of a dab falls on each texel of a rectangle of a paint map.
struct Mask {
    int left = 0, top = 0, width = 0, height = 0;  ///< texels, within the map
    std::vector<float> strength;                   ///< height x width, row-major, [0, 1]
    double radius = 0;                             ///< the brush's on the picture at rest, texels along x

    /// The place in `strength` of texel (x, y) of the map.
    std::size_t at(int x, int y) const {
        return std::size_t(y - top) * std::size_t(width) + std::size_t(x - left);
    }
};

/// Where a dab at `centre` (image pixels of the deformed picture) falls on the paint: every texel whose place
/// on the deformed picture is nearer than the radius and can be seen there. Where the picture lies over
/// itself only the layer on top is painted (triangles later in the mesh lie over earlier ones, and pixels
/// without alpha hide nothing), but for about two cells along the fold, where the layers are one. Texels just
/// beyond the mesh, up to one away, which its outermost vertices look at too, take the place of the nearest
/// point of the mesh. Where the disc is so small that no texel gets half a dab, the texel under the centre
/// gets all of it. now: #vertices of the mesh, image pixels
Mask dab_mask(const PaintMap& map, const PictureFrame& frame, const Mesh& mesh,
              std::span<const glm::vec2> now, const Image& image, const Brush& brush, glm::dvec2 centre);

/// A straight line in the picture at rest: what lies on one side is reflected to the other.
struct MirrorAxis {
    glm::dvec2 point{0};  ///< image pixels
    double angle = 0;     ///< radians, clockwise as seen, of the line from the vertical
};
glm::dvec2 reflect(const MirrorAxis& axis, glm::dvec2 point);

/// `mask` of map `from` as it falls on map `to` reflected: bilinear, and where the strongest texel falls
/// never less than it has, so that a dab of one texel does not fade.
Mask mirrored(const Mask& mask, const PaintMap& from, const PaintMap& to, const PictureFrame& frame,
              const MirrorAxis& axis);

/// What a probe's share is at a texel of its map before the stroke, [0, 1]: asked for by add, subtract and
/// smooth.
using ShareAt = std::function<float(int x, int y)>;

/// One stroke on one map: dabs fall on the map as it was before the stroke, so that they do not pile up
/// (unless build up is on), and any order of the same dabs gives the same paint.
struct Stroke {
    PaintMap before;  ///< the map when the stroke began
    /// For each of the map's tiles (all empty until the first dab) its 64 x 64 texels, row-major, or none:
    std::vector<std::vector<float>> fallen;  ///< how much of the stroke has fallen
    std::vector<std::vector<float>> share;   ///< shares already asked for; negative: not yet
};

/// Lets a dab fall. What has fallen on a texel is the largest mask of any dab times the strength; with build
/// up each dab covers that part of what was left. With m fallen, value v and coverage c before, and share s
/// before:
///   replace    c' = 1 - (1 - c)(1 - m), v' = ((1 - m) c v + m V) / c', with V the brush's value
///   add        likewise with V = min(1, s + value);   subtract: V = max(0, s - value)
///   smooth     likewise with V the mean of s over the texels of the map within `reach` = max(1, radius / 8)
///              rows and columns (the mask's radius, rounded down: a sixteenth of the disc's width)
///   erase      c' = c (1 - m), v' = v
/// `inverted` (Ctrl) swaps add and subtract and paints 1 - value where replace paints value.
/// `map` is the map as the stroke has made it so far; it is changed within the mask's rectangle only. The
/// same brush throughout a stroke; `share` is asked once for each texel that needs it.
void dab(PaintMap& map, Stroke& stroke, const Mask& mask, const Brush& brush, bool inverted,
         const ShareAt& share);

/// The places of the dabs along a path: from `last` (where the last dab fell) towards `to`, every spacing x
/// radius, `last` itself left out. The last of them is where the next path goes on from. At most 4096, then
/// farther apart.
std::vector<glm::dvec2> dabs_between(glm::dvec2 last, glm::dvec2 to, const Brush& brush);

}  // namespace probewarp
