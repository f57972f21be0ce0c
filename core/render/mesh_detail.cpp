#include "render/mesh_detail.h"

#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <cassert>
#include <limits>

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

/// A probe's own vertex is in a cell, or on the side of two.
void take_in_own(const Mesh& mesh, std::uint32_t vertex, glm::vec2 now, MeshBlocks& blocks) {
    const auto cell = [](float at, double size, int cells) { return int(double(at) / size * cells); };
    const int x = cell(mesh.rest[vertex].x, mesh.size.x, mesh.columns);
    const int y = cell(mesh.rest[vertex].y, mesh.size.y, mesh.rows);
    const auto block = [](int at, int cells) { return std::clamp(at, 0, cells - 1) / block_cells; };
    for (const int row : {block(y - 1, mesh.rows), block(y + 1, mesh.rows)})
        for (const int column : {block(x - 1, mesh.columns), block(x + 1, mesh.columns)})
            take_in(blocks.boxes[std::size_t(row) * std::size_t(blocks.columns) + std::size_t(column)], now);
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
        if (vertex != no_vertex) take_in_own(mesh, vertex, now[vertex], blocks);
    return blocks;
}

bool is_whole(const Mesh& mesh) {
    return std::ranges::adjacent_find(mesh.first_triangle, std::greater_equal<>()) ==
           mesh.first_triangle.end();
}

int stride_for(const Mesh& mesh, const MeshBlocks* blocks, const View& view) {
    // A line through cells of a few pixels bends by hundredths of a pixel; where the picture is stretched it
    // is straighter still.
    constexpr double usual = 4, widest = 10;  // target pixels
    const glm::dvec2 scale = view.scale;
    double cell = std::max(mesh.size.x / mesh.columns * scale.x, mesh.size.y / mesh.rows * scale.y);
    double stretched = cell;
    if (blocks) {
        const Box seen = box_of(view);
        for (const Box& box : blocks->boxes)
            if (meet(box, seen))
                stretched = std::max({stretched, double(box.most.x - box.least.x) * scale.x / block_cells,
                                      double(box.most.y - box.least.y) * scale.y / block_cells});
    }
    int stride = 1;
    while (stride < block_cells && cell * stride * 2 <= usual && stretched * stride * 2 <= widest)
        stride *= 2;
    return stride;
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
