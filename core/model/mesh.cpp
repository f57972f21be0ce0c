#include "model/mesh.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <glm/common.hpp>
#include <limits>
#include <numeric>

#include "model/cells_near.h"

namespace probewarp {

std::array<int, 2> grid_size(int width, int height, int cells) {
    const int longer = std::max(width, height), shorter = std::min(width, height);
    const int across = std::max(1, int(std::lround(double(cells) * shorter / longer)));
    return width >= height ? std::array{cells, across} : std::array{across, cells};
}

namespace {

template <class Sample>
void mark_visible(const std::vector<Sample>& rgba, const Image& image, const MeshSettings& settings,
                  int columns, int rows, std::vector<std::uint8_t>& kept) {
    const int full = std::numeric_limits<Sample>::max();
    std::vector<std::array<int, 2>> across;
    for (int x = 0; x < image.width; ++x)
        across.push_back(cells_near(x, settings.margin, columns, image.width));
    std::vector<std::uint8_t> in_row(static_cast<std::size_t>(columns));
    for (int y = 0; y < image.height; ++y) {
        std::fill(in_row.begin(), in_row.end(), std::uint8_t{0});
        const Sample* alpha = rgba.data() + std::size_t(y) * std::size_t(image.width) * 4 + 3;
        int marked = -1;  // the last column that is
        for (int x = 0; x < image.width; ++x, alpha += 4) {
            if (int(*alpha) * 255 <= settings.threshold * full) continue;
            const auto [from, to] = across[std::size_t(x)];
            for (int c = std::max(from, marked + 1); c <= to; ++c) in_row[std::size_t(c)] = 1;
            marked = std::max(marked, to);
        }
        if (marked < 0) continue;
        const auto [from, to] = cells_near(y, settings.margin, rows, image.height);
        for (int r = from; r <= to; ++r)
            for (int c = 0; c < columns; ++c)
                kept[std::size_t(r) * std::size_t(columns) + std::size_t(c)] |= in_row[std::size_t(c)];
    }
}

}  // namespace

std::vector<std::uint8_t> visible_cells(const Image& image, const MeshSettings& settings) {
    const auto [columns, rows] = grid_size(image.width, image.height, settings.cells);
    const std::size_t cells = std::size_t(columns) * std::size_t(rows);
    if (!settings.from_alpha || !has_alpha(image)) return std::vector<std::uint8_t>(cells, 1);
    std::vector<std::uint8_t> kept(cells, 0);
    std::visit(
        [&, c = columns, r = rows](const auto& rgba) { mark_visible(rgba, image, settings, c, r, kept); },
        image.rgba);
    if (std::find(kept.begin(), kept.end(), 1) == kept.end())
        std::fill(kept.begin(), kept.end(), std::uint8_t{1});
    return kept;
}

bool has_cell(const Mesh& mesh, std::size_t cell) {
    return mesh.first_triangle[cell] < mesh.first_triangle[cell + 1];
}

bool has_cell(const Mesh& mesh, int column, int row) {
    return column >= 0 && row >= 0 && column < mesh.columns && row < mesh.rows &&
           has_cell(mesh, std::size_t(row) * std::size_t(mesh.columns) + std::size_t(column));
}

namespace {

double cross(glm::dvec2 a, glm::dvec2 b) { return a.x * b.y - a.y * b.x; }

/// Barycentric coordinates of `point`; empty where the triangle has no area.
std::optional<glm::dvec3> barycentric(glm::dvec2 a, glm::dvec2 b, glm::dvec2 c, glm::dvec2 point) {
    const double area = cross(b - a, c - a);
    if (area == 0) return {};
    const double u = cross(b - point, c - point) / area, v = cross(c - point, a - point) / area;
    return glm::dvec3{u, v, 1 - u - v};
}

double least(glm::dvec3 v) { return std::min({v.x, v.y, v.z}); }

/// Of a triangle's height or a cell's side: what is nearer to a vertex or an edge is on it. Vertices are
/// floats, so that a point on an edge may lie a hair beside it.
constexpr double hair = 1e-4;

/// The cells that hold `point` of the picture's plane or on whose edge it lies, row by row: at most four.
struct CellsAt {
    std::array<std::size_t, 4> cells{};
    std::size_t count = 0;
    const std::size_t* begin() const { return cells.data(); }
    const std::size_t* end() const { return cells.data() + count; }
};
CellsAt cells_at(const Mesh& mesh, glm::dvec2 point) {
    CellsAt found;
    const double x = point.x / mesh.size.x * mesh.columns, y = point.y / mesh.size.y * mesh.rows;
    if (!(x >= -hair && y >= -hair && x <= mesh.columns + hair && y <= mesh.rows + hair)) return found;
    const auto first = [](double at) { return std::max(0, int(std::floor(at - hair))); };
    const auto last = [](double at, int cells) { return std::min(cells - 1, int(std::floor(at + hair))); };
    for (int row = first(y); row <= last(y, mesh.rows); ++row)
        for (int column = first(x); column <= last(x, mesh.columns); ++column)
            found.cells[found.count++] = std::size_t(row) * std::size_t(mesh.columns) + std::size_t(column);
    return found;
}

/// The cell of the mesh at `point`; empty beside it.
std::optional<std::size_t> cell_at(const Mesh& mesh, glm::dvec2 point) {
    for (const std::size_t cell : cells_at(mesh, point))
        if (has_cell(mesh, cell)) return cell;
    return {};
}

/// The places in the mesh's grid of the crossings at a cell's corners, row by row.
std::array<std::size_t, 4> crossings_of(const Mesh& mesh, std::size_t cell) {
    const std::size_t columns = std::size_t(mesh.columns), across = columns + 1;
    const std::size_t first = cell / columns * across + cell % columns;
    return {first, first + 1, first + across, first + across + 1};
}

/// The grid's vertices there.
std::array<std::uint32_t, 4> corners_of(const Mesh& mesh, std::size_t cell) {
    const auto [top_left, top_right, bottom_left, bottom_right] = crossings_of(mesh, cell);
    return {mesh.grid[top_left], mesh.grid[top_right], mesh.grid[bottom_left], mesh.grid[bottom_right]};
}

/// The grid's vertices that a kept cell has, row by row.
void add_grid_vertices(Mesh& mesh, std::span<const std::uint8_t> kept) {
    const std::size_t across = std::size_t(mesh.columns) + 1;
    mesh.grid.assign(across * (std::size_t(mesh.rows) + 1), no_vertex);
    for (std::size_t cell = 0; cell < kept.size(); ++cell) {
        if (!kept[cell]) continue;
        for (const std::size_t at : crossings_of(mesh, cell)) mesh.grid[at] = 0;
    }
    for (std::size_t at = 0; at < mesh.grid.size(); ++at) {
        if (mesh.grid[at] == no_vertex) continue;
        mesh.grid[at] = std::uint32_t(mesh.rest.size());
        mesh.rest.emplace_back(mesh.size.x * double(at % across) / mesh.columns,
                               mesh.size.y * double(at / across) / mesh.rows);
    }
}

using Corners = std::array<std::uint32_t, 3>;

/// Cuts the triangle of `cell` that holds `point` into three, or those on whose edge it lies into two each,
/// from `vertex` (no_vertex: one that is added there). Returns the vertex at the point: a corner where it
/// lies on one.
std::uint32_t insert(Mesh& mesh, std::vector<Corners>& cell, glm::dvec2 point, std::uint32_t vertex) {
    std::vector<std::pair<std::size_t, glm::dvec3>> holding;
    for (std::size_t t = 0; t < cell.size(); ++t) {
        const auto [a, b, c] = cell[t];
        const auto at = barycentric(mesh.rest[a], mesh.rest[b], mesh.rest[c], point);
        if (!at || least(*at) < -hair) continue;
        for (int k = 0; k < 3; ++k)
            if ((*at)[k] > 1 - hair) return cell[t][std::size_t(k)];
        holding.emplace_back(t, *at);
    }
    if (holding.empty()) return vertex;
    if (vertex == no_vertex) {
        vertex = std::uint32_t(mesh.rest.size());
        mesh.rest.emplace_back(point);
    }
    for (const auto& [t, at] : holding) {
        const Corners old = cell[t];
        std::size_t cuts = 0;
        for (std::size_t k = 0; k < 3; ++k) {  // a part beside each edge but the one that the point is on
            if (at[int(k)] <= hair) continue;
            const Corners part{old[(k + 1) % 3], old[(k + 2) % 3], vertex};
            if (cuts++ == 0)
                cell[t] = part;
            else
                cell.push_back(part);
        }
    }
    return vertex;
}

/// Pairs of a cell and the place of a rest that it holds or has on its edge, in the cells' order.
std::vector<std::pair<std::size_t, std::size_t>> rests_by_cell(const Mesh& mesh,
                                                               std::span<const glm::dvec2> rests) {
    std::vector<std::pair<std::size_t, std::size_t>> found;
    for (std::size_t i = 0; i < rests.size(); ++i)
        for (const std::size_t cell : cells_at(mesh, rests[i])) found.emplace_back(cell, i);
    std::sort(found.begin(), found.end());
    return found;
}

}  // namespace

Mesh probe_mesh(const Image& image, int cells, std::span<const std::uint8_t> kept,
                std::span<const glm::dvec2> rests) {
    assert(image.width > 0 && image.height > 0 && cells >= min_cells && cells <= max_cells);
    Mesh mesh;
    mesh.size = {image.width, image.height};
    const auto [columns, rows] = grid_size(image.width, image.height, cells);
    mesh.columns = columns;
    mesh.rows = rows;
    assert(kept.size() == std::size_t(columns) * std::size_t(rows));
    add_grid_vertices(mesh, kept);

    const auto by_cell = rests_by_cell(mesh, rests);
    mesh.anchors.assign(rests.size(), no_vertex);
    mesh.first_triangle.reserve(kept.size() + 1);
    mesh.triangles.reserve(kept.size() * 6 + rests.size() * 6);
    auto next = by_cell.begin();
    std::vector<Corners> cut;
    for (std::size_t cell = 0; cell < kept.size(); ++cell) {
        mesh.first_triangle.push_back(std::uint32_t(mesh.triangles.size() / 3));
        if (!kept[cell]) continue;
        const auto [top_left, top_right, bottom_left, bottom_right] = corners_of(mesh, cell);
        cut.assign({{top_left, bottom_right, top_right}, {top_left, bottom_left, bottom_right}});
        while (next != by_cell.end() && next->first < cell) ++next;  // cells that are left out
        for (; next != by_cell.end() && next->first == cell; ++next) {
            std::uint32_t& anchor = mesh.anchors[next->second];
            anchor = insert(mesh, cut, rests[next->second], anchor);
        }
        for (const Corners& triangle : cut)
            mesh.triangles.insert(mesh.triangles.end(), triangle.begin(), triangle.end());
    }
    mesh.first_triangle.push_back(std::uint32_t(mesh.triangles.size() / 3));
    return mesh;
}

Mesh grid_mesh(int width, int height, int cells) {
    Image image;
    image.width = width;
    image.height = height;
    const auto [columns, rows] = grid_size(width, height, cells);
    const std::vector<std::uint8_t> all(std::size_t(columns) * std::size_t(rows), 1);
    return probe_mesh(image, cells, all, {});
}

namespace {

/// Where `point` is seen from a triangle, inside it or not; empty where the triangle has no area.
std::optional<MeshPoint> seen_from(const Mesh& mesh, std::span<const glm::vec2> vertices,
                                   std::size_t triangle, glm::dvec2 point) {
    const auto* t = mesh.triangles.data() + 3 * triangle;
    const auto at = barycentric(vertices[t[0]], vertices[t[1]], vertices[t[2]], point);
    if (!at) return {};
    return MeshPoint{{t[0], t[1], t[2]}, *at, std::uint32_t(triangle)};
}

/// Whether the box around a triangle holds `point`: few do, and this is quickly seen. Rows lie below each
/// other, so y goes first.
bool is_near(const Mesh& mesh, std::span<const glm::vec2> vertices, std::size_t triangle, glm::dvec2 point) {
    constexpr double rounding = 1e-4;  // pixels: more than `edge` is of a triangle as large as a picture
    const auto* t = mesh.triangles.data() + 3 * triangle;
    const glm::vec2 a = vertices[t[0]], b = vertices[t[1]], c = vertices[t[2]];
    const auto within = [](float p, float q, float r, double at) {
        return double(std::min({p, q, r})) <= at + rounding && double(std::max({p, q, r})) >= at - rounding;
    };
    return within(a.y, b.y, c.y, point.y) && within(a.x, b.x, c.x, point.x);
}

}  // namespace

std::optional<MeshPoint> locate(const Mesh& mesh, std::span<const glm::vec2> vertices, glm::dvec2 point) {
    assert(vertices.size() == mesh.rest.size());
    constexpr double edge = -1e-9;  // a point on a shared edge belongs to either, never to none
    for (std::size_t t = mesh.triangles.size() / 3; t-- > 0;) {
        if (!is_near(mesh, vertices, t, point)) continue;
        if (auto at = seen_from(mesh, vertices, t, point); at && least(at->barycentric) >= edge) return at;
    }
    return {};
}

std::optional<MeshPoint> locate_at_rest(const Mesh& mesh, glm::dvec2 point) {
    const auto cell = cell_at(mesh, point);
    if (!cell) return {};
    // As for insert, the nearest triangle is the one; its share of the corners is never negative.
    std::optional<MeshPoint> nearest;
    for (std::size_t t = mesh.first_triangle[*cell]; t < mesh.first_triangle[*cell + 1]; ++t)
        if (const auto at = seen_from(mesh, mesh.rest, t, point);
            at && (!nearest || least(at->barycentric) > least(nearest->barycentric)))
            nearest = at;
    if (nearest) {
        const glm::dvec3 inside = glm::max(nearest->barycentric, glm::dvec3(0));
        nearest->barycentric = inside / (inside.x + inside.y + inside.z);
    }
    return nearest;
}

std::array<std::uint32_t, 4> grid_corners(const Mesh& mesh, glm::dvec2 point) {
    const auto cell = cell_at(mesh, point);
    if (!cell) return {no_vertex, no_vertex, no_vertex, no_vertex};
    return corners_of(mesh, *cell);
}

glm::dvec2 rest_point(const Mesh& mesh, const MeshPoint& at) {
    glm::dvec2 sum{0};
    for (int k = 0; k < 3; ++k) sum += at.barycentric[k] * glm::dvec2(mesh.rest[at.corners[std::size_t(k)]]);
    return sum;
}

Islands islands_of(const Mesh& mesh) {
    // Union-find: each vertex points towards an earlier one of its island, the first to itself.
    std::vector<std::uint32_t> towards(mesh.rest.size());
    std::iota(towards.begin(), towards.end(), 0u);
    const auto root = [&towards](std::uint32_t v) {
        while (towards[v] != v) v = towards[v] = towards[towards[v]];
        return v;
    };
    for (std::size_t i = 0; i < mesh.triangles.size(); i += 3)
        for (const std::size_t k : {i + 1, i + 2}) {
            const std::uint32_t a = root(mesh.triangles[i]), b = root(mesh.triangles[k]);
            towards[std::max(a, b)] = std::min(a, b);
        }
    Islands islands;
    islands.of.resize(towards.size());
    for (std::uint32_t v = 0; v < towards.size(); ++v)
        islands.of[v] = towards[v] == v ? islands.count++ : islands.of[root(v)];
    return islands;
}

}  // namespace probewarp
