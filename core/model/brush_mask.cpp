#include "model/brush.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>
#include <optional>

namespace probewarp {

double falloff(double distance, double radius, double hardness) {
    if (!(distance < radius)) return 0;
    const double left = 1 - distance / radius;
    const double p = left >= 1 - hardness ? 1 : left / (1 - hardness);
    return p * p * (3 - 2 * p);
}

namespace {

using Corners = std::array<glm::dvec2, 3>;

double cross(glm::dvec2 a, glm::dvec2 b) { return a.x * b.y - a.y * b.x; }

/// How far beyond its edges a triangle still takes a texel (or a buffer's cell), in these: neighbours share
/// their edges, and rounding must not leave a texel between them.
constexpr double slack = 1e-5;

/// origin + p.x x + p.y y.
struct Affine {
    glm::dvec2 x{0}, y{0}, origin{0};
    glm::dvec2 operator()(glm::dvec2 p) const { return origin + p.x * x + p.y * y; }
};

/// What takes one triangle to another; empty where the first is thinner than the slack that its neighbours
/// have, or not a number.
std::optional<Affine> between(const Corners& from, const Corners& to) {
    const glm::dvec2 u = from[1] - from[0], v = from[2] - from[0], w = from[2] - from[1];
    const double area = cross(u, v);
    const double longest = std::sqrt(std::max({glm::dot(u, u), glm::dot(v, v), glm::dot(w, w)}));
    if (!(std::abs(area) > 2 * slack * longest)) return {};
    const glm::dvec2 s = to[1] - to[0], t = to[2] - to[0];
    Affine map;
    map.x = (v.y * s - u.y * t) / area;
    map.y = (u.x * t - v.x * s) / area;
    map.origin = to[0] - from[0].x * map.x - from[0].y * map.y;
    return map;
}

/// Whether a triangle holds `point`, give or take a thousandth of the triangle.
bool holds(const Corners& triangle, glm::dvec2 point) {
    const auto& [a, b, c] = triangle;
    const double area = cross(b - a, c - a), edge = -1e-3;
    if (area == 0) return false;
    return cross(b - point, c - point) / area >= edge && cross(c - point, a - point) / area >= edge &&
           cross(a - point, b - point) / area >= edge;
}

struct Box {
    glm::dvec2 least{std::numeric_limits<double>::infinity()};
    glm::dvec2 most{-std::numeric_limits<double>::infinity()};
    void add(glm::dvec2 p) { least = glm::min(least, p), most = glm::max(most, p); }
};

Box box_of(const Corners& corners) {
    Box box;
    for (const glm::dvec2 p : corners) box.add(p);
    return box;
}

/// Whether any point of the box is nearer to the origin than `radius`.
bool meets_disc(const Box& box, double radius) {
    const glm::dvec2 nearest = glm::clamp(glm::dvec2(0), box.least, box.most);
    return glm::dot(nearest, nearest) < radius * radius;
}

/// Columns or rows [first, end).
struct Range {
    int first = 0, end = 0;
};

/// Those whose centres lie in [low, high] and that `within` has.
Range centres(double low, double high, Range within) {
    const double first = std::max(std::ceil(low - 0.5), double(within.first));
    const double end = std::min(std::floor(high - 0.5) + 1, double(within.end));
    return first < end ? Range{int(first), int(end)} : Range{};
}

/// Whether a box, grown by the slack, has any centre in [0, size) x [0, size).
bool has_centres(const Box& box, int size) {
    const auto any = [size](double low, double high) {
        return std::max(std::ceil(low - slack - 0.5), 0.0) <= std::min(high + slack - 0.5, size - 1.0);
    };
    return any(box.least.x, box.most.x) && any(box.least.y, box.most.y);
}

/// Calls `visit(row, columns)` for the rows and columns whose centres a triangle holds.
template <class Visit>
void scan(const Corners& triangle, Range columns, Range rows, Visit visit) {
    const Box box = box_of(triangle);
    rows = centres(box.least.y - slack, box.most.y + slack, rows);
    for (int row = rows.first; row < rows.end; ++row) {
        const double y = std::clamp(row + 0.5, box.least.y, box.most.y);
        double low = box.most.x, high = box.least.x;
        for (std::size_t k = 0; k < 3; ++k) {
            const glm::dvec2 a = triangle[k], b = triangle[(k + 1) % 3];
            if ((a.y < y && b.y < y) || (a.y > y && b.y > y)) continue;
            const double x = a.y == b.y ? a.x : a.x + (y - a.y) / (b.y - a.y) * (b.x - a.x);
            low = std::min(low, x), high = std::max(high, x);
            if (a.y == b.y) low = std::min(low, b.x), high = std::max(high, b.x);
        }
        if (const Range found = centres(low - slack, high + slack, columns); found.first < found.end)
            visit(row, found);
    }
}

/// The mesh as the brush meets it: places on the deformed picture are about the brush's centre.
struct Ground {
    const Mesh& mesh;
    std::span<const glm::vec2> now;  ///< #vertices, image pixels
    const Image& image;
    glm::dvec2 centre;  ///< image pixels

    Corners rest(std::uint32_t triangle) const { return corners(mesh.rest, triangle, {0, 0}); }
    Corners place(std::uint32_t triangle) const { return corners(now, triangle, centre); }

    Corners corners(std::span<const glm::vec2> vertices, std::uint32_t triangle, glm::dvec2 about) const {
        const std::uint32_t* t = mesh.triangles.data() + std::size_t{3} * triangle;
        return {glm::dvec2(vertices[t[0]]) - about, glm::dvec2(vertices[t[1]]) - about,
                glm::dvec2(vertices[t[2]]) - about};
    }

    /// Whether the picture has any alpha at a point at rest.
    bool has_alpha(glm::dvec2 at) const {
        if (pixel_bytes(image).empty()) return true;
        const auto place = [](double x, int size) { return int(std::clamp(std::floor(x), 0.0, size - 1.0)); };
        return pixel(image, place(at.x, image.width), place(at.y, image.height))[3] > 0;
    }
};

/// The triangles whose bounding boxes meet the square of `reach` pixels around the centre, in the mesh's
/// order.
std::vector<std::uint32_t> triangles_near(const Ground& ground, double reach) {
    const glm::vec2 least(ground.centre - reach), most(ground.centre + reach);
    // Of each vertex, the sides of the square that it lies beyond.
    std::vector<std::uint8_t> beyond(ground.now.size());
    std::ranges::transform(ground.now, beyond.begin(), [=](glm::vec2 p) {
        return std::uint8_t((p.x < least.x) | (p.x > most.x) << 1 | (p.y < least.y) << 2 |
                            (p.y > most.y) << 3);
    });
    std::vector<std::uint32_t> near;
    const std::vector<std::uint32_t>& t = ground.mesh.triangles;
    for (std::size_t i = 0; i < t.size(); i += 3)
        if (!(beyond[t[i]] & beyond[t[i + 1]] & beyond[t[i + 2]])) near.push_back(std::uint32_t(i / 3));
    return near;
}

/// Which part of the picture at rest is on top: a coarse picture of the disc's square, one cell more on each
/// side, in which each cell holds the point at rest that its centre shows.
class TopLayer {
  public:
    TopLayer(const Ground& ground, std::span<const std::uint32_t> triangles, double radius)
        : side(std::clamp(int(2 * std::min(radius, 1000.0)), 16, 128) + 2), cell(2 * radius / (side - 2)) {
        shown.assign(std::size_t(side) * std::size_t(side), nothing);
        const Mesh& mesh = ground.mesh;
        same_layer = 2 * glm::length(mesh.size / glm::dvec2(mesh.columns, mesh.rows));
        for (const std::uint32_t triangle : triangles) draw(ground, triangle);
    }

    /// How far from what is shown there a point of the triangle that `to_place` deforms may lie and still be
    /// of the same layer: image pixels at rest. A cell of this buffer shows more where the picture is
    /// squeezed. texel: its sides, image pixels at rest
    double tolerance(const Affine& to_place, glm::dvec2 texel) const {
        const glm::dvec2 x = to_place.x / texel.x, y = to_place.y / texel.y;
        const double stretch = std::sqrt(glm::dot(x, x) + glm::dot(y, y));
        const double squeezed = std::abs(cross(x, y)) * 16 > stretch ? stretch / std::abs(cross(x, y)) : 16;
        return same_layer + cell * squeezed;
    }

    /// Whether the point at rest `rest` can be seen at `place`, within the disc.
    bool shows(glm::dvec2 rest, glm::dvec2 place, double tolerance) const {
        if (!folded) return true;
        const auto at = [this](double x) { return std::clamp(int(x / cell + 0.5 * side), 1, side - 2); };
        const int row = at(place.y), column = at(place.x);
        const auto near = [&](int down, int right) {
            const glm::dvec2 apart = glm::dvec2((*this)(row + down, column + right)) - rest;
            return glm::dot(apart, apart) <= tolerance * tolerance;
        };
        if ((*this)(row, column) == nothing || near(0, 0)) return true;
        for (int down = -1; down <= 1; ++down)
            for (int right = -1; right <= 1; ++right)
                if (near(down, right)) return true;
        return false;
    }

  private:
    static constexpr glm::vec2 nothing{std::numeric_limits<float>::infinity()};

    int side;                      ///< cells
    double cell;                   ///< image pixels
    double same_layer = 0;         ///< image pixels at rest
    std::vector<glm::vec2> shown;  ///< side x side, row-major; image pixels at rest
    bool folded = false;           ///< whether any cell has seen two layers

    const glm::vec2& operator()(int row, int column) const {
        return shown[std::size_t(row) * std::size_t(side) + std::size_t(column)];
    }

    void draw(const Ground& ground, std::uint32_t triangle) {
        Corners cells = ground.place(triangle);
        for (glm::dvec2& p : cells) p = p / cell + 0.5 * side;
        if (!has_centres(box_of(cells), side)) return;
        const auto to_rest = between(cells, ground.rest(triangle));
        if (!to_rest) return;
        scan(cells, {0, side}, {0, side}, [&](int row, Range columns) {
            for (int column = columns.first; column < columns.end; ++column) {
                const glm::dvec2 rest = (*to_rest)({column + 0.5, row + 0.5});
                cover(ground, shown[std::size_t(row) * std::size_t(side) + std::size_t(column)], rest);
            }
        });
    }

    /// Lays `rest` over what a cell showed. Alpha is looked at only where that makes a difference.
    void cover(const Ground& ground, glm::vec2& below, glm::dvec2 rest) {
        const glm::dvec2 apart = glm::dvec2(below) - rest;
        if (below == nothing || glm::dot(apart, apart) <= same_layer * same_layer) {
            below = rest;
            return;
        }
        folded = true;
        if (ground.has_alpha(rest))
            below = rest;
        else if (!ground.has_alpha(below))
            below = nothing;
    }
};

/// The point at rest that can be seen at the centre; of what has no alpha the topmost.
std::optional<glm::dvec2> rest_at_centre(const Ground& ground, std::span<const std::uint32_t> triangles) {
    std::optional<glm::dvec2> topmost;
    for (std::size_t i = triangles.size(); i-- > 0;) {
        const Corners place = ground.place(triangles[i]);
        if (!holds(place, {0, 0})) continue;
        const auto to_rest = between(place, ground.rest(triangles[i]));
        if (!to_rest) continue;
        if (ground.has_alpha(to_rest->origin)) return to_rest->origin;
        if (!topmost) topmost = to_rest->origin;
    }
    return topmost;
}

bool is_outermost(const Mesh& mesh, int column, int row) {
    for (int y = row - 1; y <= row + 1; ++y)
        for (int x = column - 1; x <= column + 1; ++x)
            if (!has_cell(mesh, x, y)) return true;
    return false;
}

/// Fills a mask triangle by triangle.
class MaskPainter {
  public:
    MaskPainter(const PaintMap& map, const PictureFrame& frame, const Ground& on, const Brush& with,
                std::span<const std::uint32_t> triangles)
        : ground(on),
          brush(with),
          origin(to_picture(map, frame, {0, 0})),
          texel(to_picture(map, frame, {1, 1}) - origin),
          top(ground, triangles, brush.radius) {
        Box box;
        for (const std::uint32_t triangle : triangles)
            if (meets_disc(box_of(ground.place(triangle)), brush.radius))
                for (const glm::dvec2 p : in_texels(ground.rest(triangle))) box.add(p);
        const Range across = centres(box.least.x - 1, box.most.x + 1, {0, map.width});
        const Range down = centres(box.least.y - 1, box.most.y + 1, {0, map.height});
        mask = {across.first,          down.first, across.end - across.first,
                down.end - down.first, {},         brush.radius / texel.x};
        mask.strength.resize(std::size_t(mask.width) * std::size_t(mask.height));
    }

    /// `cell` is the triangle's, its column and its row.
    void paint(std::uint32_t triangle, std::array<int, 2> cell, bool outermost) {
        const Corners places = ground.place(triangle);
        if (!meets_disc(box_of(places), brush.radius)) return;
        const Corners rest = in_texels(ground.rest(triangle));
        const auto to_place = between(rest, places);
        if (!to_place) return;
        const double tolerance = top.tolerance(*to_place, texel);
        scan(rest, columns(), rows(), [&](int row, Range columns) {
            glm::dvec2 at{columns.first + 0.5, row + 0.5}, place = (*to_place)(at);
            for (int column = columns.first; column < columns.end; ++column) {
                add(column, row, at, place, tolerance);
                at.x += 1;
                place += to_place->x;
            }
        });
        if (outermost) paint_beyond(rest, *to_place, tolerance, cell);
    }

    /// Whether no texel has got half of a dab.
    bool is_faint() const {
        return std::ranges::none_of(mask.strength, [](float strength) { return strength >= 0.5f; });
    }

    /// Gives the texel at `rest` (image pixels) a whole dab.
    void paint_texel(glm::dvec2 rest) {
        // The map's right and lower edges belong to the outermost texels, and so do the others.
        const glm::dvec2 at = (rest - origin) / texel - slack;
        if (!(at.x > -2 * slack && at.y > -2 * slack && at.x < columns().end && at.y < rows().end)) return;
        const int column = int(at.x), row = int(at.y);
        if (column >= mask.left && row >= mask.top) strength_at(column, row) = 1;
    }

    Mask mask;

  private:
    const Ground& ground;
    const Brush& brush;
    glm::dvec2 origin;  ///< of the map, image pixels
    glm::dvec2 texel;   ///< its sides, image pixels at rest
    TopLayer top;

    Range columns() const { return {mask.left, mask.left + mask.width}; }
    Range rows() const { return {mask.top, mask.top + mask.height}; }

    float& strength_at(int column, int row) { return mask.strength[mask.at(column, row)]; }

    Corners in_texels(Corners rest) const {
        for (glm::dvec2& p : rest) p = (p - origin) / texel;
        return rest;
    }

    /// The texel takes what falls at `place`, where the point at rest `at` (texels) is, if that can be seen.
    void add(int column, int row, glm::dvec2 at, glm::dvec2 place, double tolerance) {
        const double square = glm::dot(place, place);
        if (!(square < brush.radius * brush.radius)) return;
        if (!top.shows(origin + at * texel, place, tolerance)) return;
        float& strength = strength_at(column, row);
        strength = std::max(strength, float(falloff(std::sqrt(square), brush.radius, brush.hardness)));
    }

    /// The texels up to one beyond the mesh take the place of the nearest point of their neighbouring cell.
    void paint_beyond(const Corners& rest, const Affine& to_place, double tolerance,
                      std::array<int, 2> cell) {
        const Mesh& mesh = ground.mesh;
        const glm::dvec2 side = mesh.size / glm::dvec2(mesh.columns, mesh.rows);
        const glm::dvec2 corner(cell[0], cell[1]);
        const glm::dvec2 least = (corner * side - origin) / texel,
                         most = ((corner + 1.0) * side - origin) / texel;
        const Box box = box_of(rest);
        const Range down = centres(box.least.y - 1, box.most.y + 1, rows());
        const Range across = centres(box.least.x - 1, box.most.x + 1, columns());
        for (int row = down.first; row < down.end; ++row)
            for (int column = across.first; column < across.end; ++column) {
                const glm::dvec2 at{column + 0.5, row + 0.5};
                const glm::dvec2 nearest = glm::clamp(at, least, most);
                const glm::dvec2 in = glm::floor((origin + at * texel) / side);
                if (nearest == at || has_cell(mesh, int(in.x), int(in.y)) || !holds(rest, nearest)) continue;
                add(column, row, nearest, to_place(nearest), tolerance);
            }
    }
};

}  // namespace

Mask dab_mask(const PaintMap& map, const PictureFrame& frame, const Mesh& mesh,
              std::span<const glm::vec2> now, const Image& image, const Brush& brush, glm::dvec2 centre) {
    assert(now.size() == mesh.rest.size());
    if (map.width < 1 || map.height < 1) return {};
    const Ground ground{mesh, now, image, centre};
    // Beyond the disc: the cells of the top layer around it.
    const auto triangles = triangles_near(ground, brush.radius * 1.125);
    MaskPainter painter(map, frame, ground, brush, triangles);
    std::size_t cell = 0;
    bool outermost = false;
    std::optional<std::size_t> asked;
    for (const std::uint32_t triangle : triangles) {
        while (mesh.first_triangle[cell + 1] <= triangle) ++cell;
        const std::array at{int(cell % std::size_t(mesh.columns)), int(cell / std::size_t(mesh.columns))};
        if (asked != cell) outermost = is_outermost(mesh, at[0], at[1]);
        asked = cell;
        painter.paint(triangle, at, outermost);
    }
    if (painter.is_faint())
        if (const auto rest = rest_at_centre(ground, triangles)) painter.paint_texel(*rest);
    return std::move(painter.mask);
}

glm::dvec2 reflect(const MirrorAxis& axis, glm::dvec2 point) {
    const glm::dvec2 along{std::sin(axis.angle), -std::cos(axis.angle)};
    const glm::dvec2 from = point - axis.point;
    return axis.point + 2 * glm::dot(along, from) * along - from;
}

Mask mirrored(const Mask& mask, const PaintMap& from, const PaintMap& to, const PictureFrame& frame,
              const MirrorAxis& axis) {
    if (mask.strength.empty()) return {};
    const auto onto = [&](glm::dvec2 at) {
        return to_texels(to, frame, reflect(axis, to_picture(from, frame, at)));
    };
    const auto back = [&](glm::dvec2 at) {
        return to_texels(from, frame, reflect(axis, to_picture(to, frame, at)));
    };
    Box box;
    for (const int x : {-1, mask.width + 1})
        for (const int y : {-1, mask.height + 1}) box.add(onto(glm::dvec2(mask.left + x, mask.top + y)));
    // The outermost texels' own are in even where the box is smaller than a texel.
    const Range columns = centres(box.least.x - 1, box.most.x + 1, {0, to.width});
    const Range rows = centres(box.least.y - 1, box.most.y + 1, {0, to.height});
    Mask result{columns.first,
                rows.first,
                columns.end - columns.first,
                rows.end - rows.first,
                {},
                mask.radius * (to.width / to.extent.x) / (from.width / from.extent.x)};
    result.strength.reserve(std::size_t(result.width) * std::size_t(result.height));

    const auto strength = [&](int x, int y) {
        return x < 0 || y < 0 || x >= mask.width || y >= mask.height
                   ? 0.0
                   : double(mask.strength[std::size_t(y) * std::size_t(mask.width) + std::size_t(x)]);
    };
    for (int row = rows.first; row < rows.end; ++row)
        for (int column = columns.first; column < columns.end; ++column) {
            const glm::dvec2 at = back({column + 0.5, row + 0.5}) - glm::dvec2(mask.left, mask.top) - 0.5;
            const glm::dvec2 whole = glm::floor(at), f = at - whole;
            const int x = int(whole.x), y = int(whole.y);
            const double sum = (1 - f.y) * ((1 - f.x) * strength(x, y) + f.x * strength(x + 1, y)) +
                               f.y * ((1 - f.x) * strength(x, y + 1) + f.x * strength(x + 1, y + 1));
            result.strength.push_back(float(std::min(sum, 1.0)));
        }

    const auto most = std::ranges::max_element(mask.strength) - mask.strength.begin();
    const glm::dvec2 strongest = glm::floor(
        onto({mask.left + double(most % mask.width) + 0.5, mask.top + double(most / mask.width) + 0.5}));
    const glm::dvec2 at = strongest - glm::dvec2(result.left, result.top);
    if (at.x >= 0 && at.y >= 0 && at.x < result.width && at.y < result.height) {
        float& there = result.strength[std::size_t(at.y) * std::size_t(result.width) + std::size_t(at.x)];
        there = std::max(there, mask.strength[std::size_t(most)]);
    }
    return result;
}

}  // namespace probewarp
