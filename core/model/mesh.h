// The mesh that carries the picture: a grid without the cells where nothing is to be seen, and with a vertex
// at every probe. And the questions which of its triangles lies under a point, and which parts hang together.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <optional>
#include <span>
#include <vector>

#include "model/image.h"

namespace probewarp {

inline constexpr int min_cells = 1;
inline constexpr int max_cells = 1000;
inline constexpr int default_cells = 100;
inline constexpr double max_mesh_margin = 1000;  // image pixels

/// How the mesh is laid over a picture.
struct MeshSettings {
    int cells = default_cells;  ///< along the picture's longer side, in [min_cells, max_cells]
    bool from_alpha = true;     ///< leave out the cells without a visible pixel; an opaque picture has none
    int threshold = 0;  ///< a pixel is visible where its alpha, as 0 to 255, is above this; in [0, 254]
    double margin = 2;  ///< image pixels, in [0, max_mesh_margin]: cells as near a visible pixel stay
    friend bool operator==(const MeshSettings&, const MeshSettings&) = default;
};

inline constexpr std::uint32_t no_vertex = 0xffffffff;

struct Mesh {
    int columns = 0;     ///< cells along x
    int rows = 0;        ///< cells along y
    glm::dvec2 size{0};  ///< of the picture, image pixels
    /// #vertices; image pixels. Those of the grid row by row from the top-left corner, then the probes' own.
    std::vector<glm::vec2> rest;
    /// #triangles x 3 places in `rest`, cell after cell, row by row: a later one is drawn over an earlier
    /// one, so that of two pieces that overlap the one from lower down lies on top, all of it. (In narrow
    /// strips 0.6 vertices a triangle would be shaded in place of 1, but overlaps would be torn at each.) A
    /// cell is cut from its top-left to its bottom-right corner; a triangle with a probe inside or on its
    /// edge is cut again from there to its corners.
    std::vector<std::uint32_t> triangles;
    /// rows x columns + 1: the first triangle of each cell; a cell that is left out has none.
    std::vector<std::uint32_t> first_triangle;
    /// (rows + 1) x (columns + 1): the vertex at each crossing of the grid, or no_vertex.
    std::vector<std::uint32_t> grid;
    /// #probes: the vertex at each probe's rest; no_vertex for a probe that is not on the mesh.
    std::vector<std::uint32_t> anchors;
};

/// Vertices [first, first + count) of a mesh.
struct VertexRun {
    std::size_t first = 0, count = 0;
};

/// Cells along x and y: `cells` along the longer side, max(1, round(cells short / long)) along the shorter.
std::array<int, 2> grid_size(int width, int height, int cells);

/// Which cells hold something to see: rows x columns, row-major, 1 or 0. All of them where the picture has no
/// alpha, where the settings do not ask, or where nothing at all is visible.
std::vector<std::uint8_t> visible_cells(const Image& image, const MeshSettings& settings);

/// Whether the mesh has that cell of its grid (its place, row by row): one that is left out has no triangle.
bool has_cell(const Mesh& mesh, std::size_t cell);
/// Whether the mesh has the cell in that column and row; beside the grid there is none.
bool has_cell(const Mesh& mesh, int column, int row);

/// The whole grid over [0, width] x [0, height], without probes. Requires cells in [min_cells, max_cells].
Mesh grid_mesh(int width, int height, int cells);

/// The grid's cells that `kept` (as visible_cells gives it) has, with a vertex at each of `rests` (#probes,
/// image pixels) that lies in one of them. A rest nearer than a ten-thousandth of a cell to a vertex takes
/// that.
Mesh probe_mesh(const Image& image, int cells, std::span<const std::uint8_t> kept,
                std::span<const glm::dvec2> rests);

struct MeshPoint {
    std::array<std::uint32_t, 3> corners;  ///< places in the mesh's vertices
    glm::dvec3 barycentric;                ///< of the corners; sums to 1
    std::uint32_t triangle = 0;            ///< its place, from 0
};

/// The topmost triangle under `point`: where the deformed mesh folds, the last drawn. Empty outside the mesh.
/// vertices: #vertices, image pixels, the mesh's deformed (or rest) vertices.
std::optional<MeshPoint> locate(const Mesh& mesh, std::span<const glm::vec2> vertices, glm::dvec2 point);

/// The triangle of the mesh at rest under `point`, found by its cell. Empty outside the mesh.
std::optional<MeshPoint> locate_at_rest(const Mesh& mesh, glm::dvec2 point);

/// The grid's vertices at the corners of the cell at `point` of the picture at rest; no_vertex beside the
/// mesh.
std::array<std::uint32_t, 4> grid_corners(const Mesh& mesh, glm::dvec2 point);

/// The point of the picture at rest that `at` names.
glm::dvec2 rest_point(const Mesh& mesh, const MeshPoint& at);

/// Which vertices hang together through triangles.
struct Islands {
    std::vector<int> of;  ///< #vertices: from 0
    int count = 0;
};
Islands islands_of(const Mesh& mesh);

}  // namespace probewarp
