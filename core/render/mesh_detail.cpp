#include "render/mesh_detail.h"

#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <utility>

namespace probewarp {

namespace {

constexpr float infinity = std::numeric_limits<float>::infinity();

void take_in(Box& box, glm::vec2 point) {
    box.least = {std::min(box.least.x, point.x), std::min(box.least.y, point.y)};
    box.most = {std::max(box.most.x, point.x), std::max(box.most.y, point.y)};
}

int blocks_along(int cells) { return (cells + block_cells - 1) / block_cells; }

/// Around the grid's vertices of one block.
Box box_of(const Mesh& mesh, std::span<const glm::vec2> now, int column, int row) {
    Box box{{infinity, infinity}, {-infinity, -infinity}};
    const int right = std::min((column + 1) * block_cells, mesh.columns);
    const int bottom = std::min((row + 1) * block_cells, mesh.rows);
    for (int y = row * block_cells; y <= bottom; ++y) {
        const auto* line = mesh.grid.data() + std::size_t(y) * std::size_t(mesh.columns + 1);
        for (int x = column * block_cells; x <= right; ++x)
            if (line[x] != no_vertex) take_in(box, now[line[x]]);
    }
    return box;
}

/// Calls visit(block) for each block that a probe's own vertex there may be of: it is in a cell, or on the
/// side of two. rest: image pixels
template <class Visit>
void for_blocks_at(const Mesh& mesh, glm::vec2 rest, const Visit& visit) {
    const auto cell = [](float at, double size, int cells) { return int(double(at) / size * cells); };
    const int x = cell(rest.x, mesh.size.x, mesh.columns), y = cell(rest.y, mesh.size.y, mesh.rows);
    const auto blocks = [](int at, int cells) {
        const auto block = [cells](int of) { return std::clamp(of, 0, cells - 1) / block_cells; };
        return std::pair(block(at - 1), block(at + 1));
    };
    const auto [top, bottom] = blocks(y, mesh.rows);
    const auto [left, right] = blocks(x, mesh.columns);
    for (int row = top; row <= bottom; ++row)
        for (int column = left; column <= right; ++column)
            visit(std::size_t(row) * std::size_t(blocks_along(mesh.columns)) + std::size_t(column));
}

/// Image pixels.
Box box_of(const View& view) {
    const glm::dvec2 least = view.origin, most = least + glm::dvec2(view.width, view.height) / view.scale;
    return {glm::vec2(least), glm::vec2(most)};
}

bool meet(const Box& a, const Box& b) {
    return a.least.x <= b.most.x && b.least.x <= a.most.x && a.least.y <= b.most.y && b.least.y <= a.most.y;
}

}  // namespace

MeshBlocks blocks_of(const Mesh& mesh, std::span<const glm::vec2> now) {
    assert(now.size() == mesh.rest.size());
    MeshBlocks blocks{blocks_along(mesh.columns), blocks_along(mesh.rows), {}};
    blocks.boxes.resize(std::size_t(blocks.columns) * std::size_t(blocks.rows));
    oneapi::tbb::parallel_for(0, blocks.rows, [&](int row) {
        for (int column = 0; column < blocks.columns; ++column)
            blocks.boxes[std::size_t(row) * std::size_t(blocks.columns) + std::size_t(column)] =
                box_of(mesh, now, column, row);
    });
    for (const std::uint32_t vertex : mesh.anchors)
        if (vertex != no_vertex)
            for_blocks_at(mesh, mesh.rest[vertex],
                          [&](std::size_t block) { take_in(blocks.boxes[block], now[vertex]); });
    return blocks;
}

bool is_whole(const Mesh& mesh) {
    return std::ranges::adjacent_find(mesh.first_triangle, std::greater_equal<>()) ==
           mesh.first_triangle.end();
}

namespace {

/// A cell of a coarser grid: its corners, and where in it a place of the finer one is, [0, 1].
struct CoarseCell {
    int left, top, right, bottom;
    float x, y;
};

/// The place of the grid where stride's triangles have no vertex of their own.
CoarseCell coarse_cell(const Mesh& mesh, int x, int y, int stride) {
    const auto along = [stride](int at, int cells) {
        const int first = at == cells ? at : at / stride * stride;
        const int end = at == first ? first : std::min(first + stride, cells);
        return std::array{first, end};
    };
    const auto [left, right] = along(x, mesh.columns);
    const auto [top, bottom] = along(y, mesh.rows);
    const auto part = [](int at, int first, int end) {
        return first == end ? 0.0f : float(at - first) / float(end - first);
    };
    return {left, top, right, bottom, part(x, left, right), part(y, top, bottom)};
}

/// Where the cell's two triangles, cut from the top-left corner to the bottom-right one, have that place.
glm::vec2 on_triangles(const Mesh& mesh, std::span<const glm::vec2> now, const CoarseCell& cell) {
    const auto at = [&](int x, int y) {
        return now[mesh.grid[std::size_t(y) * std::size_t(mesh.columns + 1) + std::size_t(x)]];
    };
    const glm::vec2 first = at(cell.left, cell.top), last = at(cell.right, cell.bottom);
    if (cell.x > cell.y)
        return first * (1 - cell.x) + at(cell.right, cell.top) * (cell.x - cell.y) + last * cell.y;
    return first * (1 - cell.y) + at(cell.left, cell.bottom) * (cell.y - cell.x) + last * cell.x;
}

/// Adds, stride by stride, how far the vertices that are left out are from the next triangles.
StrideErrors errors_of(const Mesh& mesh, std::span<const glm::vec2> now, int column, int row) {
    const int right = std::min((column + 1) * block_cells, mesh.columns);
    const int bottom = std::min((row + 1) * block_cells, mesh.rows);
    const auto has = [](int at, int cells, int stride) { return at % stride == 0 || at == cells; };
    StrideErrors errors{};
    for (std::size_t i = 1; i < errors.size(); ++i) {
        const int stride = 1 << i, finer = stride / 2;
        float squared = 0;
        for (int y = row * block_cells; y <= bottom; ++y) {
            if (!has(y, mesh.rows, finer)) continue;
            for (int x = column * block_cells; x <= right; ++x) {
                if (!has(x, mesh.columns, finer)) continue;
                if (has(x, mesh.columns, stride) && has(y, mesh.rows, stride)) continue;
                const auto vertex =
                    mesh.grid[std::size_t(y) * std::size_t(mesh.columns + 1) + std::size_t(x)];
                const glm::vec2 off = now[vertex] - on_triangles(mesh, now, coarse_cell(mesh, x, y, stride));
                squared = std::max(squared, glm::dot(off, off));
            }
        }
        errors[i] = errors[i - 1] + std::sqrt(squared);
    }
    return errors;
}

/// A probe's own vertex, which no stride but 1 has.
float error_of_own(const Mesh& mesh, std::span<const glm::vec2> now, std::uint32_t vertex) {
    const glm::dvec2 at = glm::dvec2(mesh.rest[vertex]) / mesh.size * glm::dvec2(mesh.columns, mesh.rows);
    const int x = std::clamp(int(at.x), 0, mesh.columns - 1), y = std::clamp(int(at.y), 0, mesh.rows - 1);
    const CoarseCell cell{x, y, x + 1, y + 1, float(at.x - x), float(at.y - y)};
    return glm::distance(now[vertex], on_triangles(mesh, now, cell));
}

}  // namespace

std::vector<StrideErrors> stride_errors(const Mesh& mesh, std::span<const glm::vec2> now) {
    assert(is_whole(mesh) && now.size() == mesh.rest.size());
    const int columns = blocks_along(mesh.columns), rows = blocks_along(mesh.rows);
    std::vector<StrideErrors> errors(std::size_t(columns) * std::size_t(rows));
    oneapi::tbb::parallel_for(0, rows, [&](int row) {
        for (int column = 0; column < columns; ++column)
            errors[std::size_t(row) * std::size_t(columns) + std::size_t(column)] =
                errors_of(mesh, now, column, row);
    });
    // From a probe's own vertex to the grid's triangles, and on to the larger ones.
    std::vector<float> own(errors.size());
    for (const std::uint32_t vertex : mesh.anchors) {
        if (vertex == no_vertex) continue;
        const float error = error_of_own(mesh, now, vertex);
        for_blocks_at(mesh, mesh.rest[vertex],
                      [&](std::size_t block) { own[block] = std::max(own[block], error); });
    }
    for (std::size_t block = 0; block < errors.size(); ++block)
        for (std::size_t i = 1; i < errors[block].size(); ++i) errors[block][i] += own[block];
    return errors;
}

namespace {

/// Target pixels, at rest.
double cell_side(const Mesh& mesh, const View& view) {
    return std::max(mesh.size.x / mesh.columns * view.scale.x, mesh.size.y / mesh.rows * view.scale.y);
}

}  // namespace

bool may_be_coarser(const Mesh& mesh, const View& view, double largest) {
    return cell_side(mesh, view) * 2 <= largest;
}

int stride_for(const Mesh& mesh, const MeshBlocks& blocks, std::span<const StrideErrors> errors,
               const View& view, double largest) {
    constexpr float nobody_sees = 0.25f;  // target pixels
    const Box seen = box_of(view);
    const double cell = cell_side(mesh, view), scale = std::max(view.scale.x, view.scale.y);
    StrideErrors worst{};
    for (std::size_t block = 0; block < blocks.boxes.size(); ++block)
        if (meet(blocks.boxes[block], seen))
            for (std::size_t i = 0; i < worst.size(); ++i) worst[i] = std::max(worst[i], errors[block][i]);
    std::size_t i = 0;
    while (i + 1 < worst.size() && cell * double(2 << i) <= largest &&
           double(worst[i + 1]) * scale <= nobody_sees)
        ++i;
    return 1 << i;
}

MeshDetail detail_of(const Mesh& mesh, int stride) {
    if (stride == 1) return {1, mesh.columns, mesh.rows, {}, mesh.first_triangle};
    assert(is_whole(mesh) && block_cells % stride == 0);
    MeshDetail detail{
        stride, (mesh.columns + stride - 1) / stride, (mesh.rows + stride - 1) / stride, {}, {}};
    const auto vertex = [&](int column, int row) {
        const int x = std::min(column * stride, mesh.columns), y = std::min(row * stride, mesh.rows);
        return mesh.grid[std::size_t(y) * std::size_t(mesh.columns + 1) + std::size_t(x)];
    };
    const std::size_t cells = std::size_t(detail.columns) * std::size_t(detail.rows);
    detail.triangles.reserve(cells * 6);
    detail.first.reserve(cells + 1);
    for (int y = 0; y < detail.rows; ++y)
        for (int x = 0; x < detail.columns; ++x) {
            detail.first.push_back(std::uint32_t(detail.triangles.size() / 3));
            const std::uint32_t left = vertex(x, y), right = vertex(x + 1, y);
            const std::uint32_t below_left = vertex(x, y + 1), below_right = vertex(x + 1, y + 1);
            detail.triangles.insert(detail.triangles.end(),
                                    {left, below_right, right, left, below_left, below_right});
        }
    detail.first.push_back(std::uint32_t(detail.triangles.size() / 3));
    return detail;
}

std::vector<TriangleRun> visible_runs(const MeshDetail& detail, const MeshBlocks& blocks, const View& view) {
    const Box seen = box_of(view);
    const int along = block_cells / detail.stride;  // cells of the detail along a block
    std::vector<TriangleRun> runs;
    const auto add = [&](std::size_t row, int first_column, int end_column) {
        const std::size_t start = row * std::size_t(detail.columns);
        const std::size_t first = detail.first[start + std::size_t(first_column)];
        const std::size_t end = detail.first[start + std::size_t(end_column)];
        if (!runs.empty() && runs.back().first + runs.back().count == first)
            runs.back().count += end - first;
        else if (end > first)
            runs.push_back({first, end - first});
    };
    for (int y = 0; y < detail.rows; ++y) {
        const Box* row = blocks.boxes.data() + std::size_t(y / along) * std::size_t(blocks.columns);
        for (int block = 0; block < blocks.columns; ++block)
            if (meet(row[block], seen))
                add(std::size_t(y), block * along, std::min((block + 1) * along, detail.columns));
    }
    return runs;
}

}  // namespace probewarp
