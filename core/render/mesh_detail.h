// Which triangles of a mesh a view needs: only those that may show in it, and where the mesh is finer than
// the screen, those of every second, fourth ... line of its grid in place of all.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/vec2.hpp>
#include <span>
#include <vector>

#include "model/mesh.h"
#include "raster/picture_drawer.h"

namespace probewarp {

/// Cells of the grid along a block, and the largest stride.
inline constexpr int block_cells = 32;

/// Image pixels. Empty where least is not below most.
struct Box {
    glm::vec2 least, most;
};

/// Where the grid's blocks are on the deformed picture.
struct MeshBlocks {
    int columns = 0, rows = 0;
    std::vector<Box> boxes;  ///< rows x columns, row by row: around all triangles of the block's cells
};

/// now: #vertices, image pixels
MeshBlocks blocks_of(const Mesh& mesh, std::span<const glm::vec2> now);

/// Whether no cell is left out, as it takes to draw a mesh coarser.
bool is_whole(const Mesh& mesh);

/// How far a whole mesh's vertices are from the triangles of each stride of detail_of, 1, 2, 4 ...
/// block_cells: image pixels, at most
using StrideErrors = std::array<float, 6>;

/// #blocks, row by row. now: #vertices, image pixels
std::vector<StrideErrors> stride_errors(const Mesh& mesh, std::span<const glm::vec2> now);

/// Of how many lines of a whole mesh's grid one is enough, so that nobody sees it: a power of two, at most
/// block_cells. errors: of its blocks; largest: target pixels, of a triangle's side
int stride_for(const Mesh& mesh, const MeshBlocks& blocks, std::span<const StrideErrors> errors,
               const View& view, double largest);

/// Whether any stride but 1 is within the largest side.
bool may_be_coarser(const Mesh& mesh, const View& view, double largest);

/// The triangles of every stride-th line of the grid, without the probes' own vertices.
struct MeshDetail {
    int stride = 1;
    int columns = 0, rows = 0;             ///< cells
    std::vector<std::uint32_t> triangles;  ///< as triangles_of; none where the mesh has them itself
    std::vector<std::uint32_t> first;      ///< rows x columns + 1: the first triangle of each cell
};

/// stride: 1, for the mesh as it is, or of a whole mesh a power of two up to block_cells
MeshDetail detail_of(const Mesh& mesh, int stride);

/// #triangles x 3, row by row. detail: of this mesh
inline std::span<const std::uint32_t> triangles_of(const Mesh& mesh, const MeshDetail& detail) {
    return detail.stride == 1 ? mesh.triangles : detail.triangles;
}

/// Triangles [first, first + count).
struct TriangleRun {
    std::size_t first = 0, count = 0;
};

/// Those that may show in the view, in their order.
std::vector<TriangleRun> visible_runs(const MeshDetail& detail, const MeshBlocks& blocks, const View& view);

}  // namespace probewarp
