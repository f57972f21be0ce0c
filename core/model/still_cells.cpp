#include "model/still_cells.h"

#include <cassert>

#include "model/cells_near.h"

namespace probewarp {

namespace {

/// How far beyond a pixel's edge it is seen where the picture is enlarged: image pixels.
constexpr double filter_reach = 1;

/// Cells from first to last, both ends included.
struct CellBox {
    std::array<int, 2> columns, rows;
};

/// A grid's cells, row by row.
struct Cells {
    int columns = 0, rows = 0;
    std::span<const std::uint8_t> kept;
    std::vector<std::uint8_t> still;

    std::size_t at(int column, int row) const {
        return std::size_t(row) * std::size_t(columns) + std::size_t(column);
    }
    bool has_left_out(const CellBox& box) const {
        for (int row = box.rows[0]; row <= box.rows[1]; ++row)
            for (int column = box.columns[0]; column <= box.columns[1]; ++column)
                if (!kept[at(column, row)]) return true;
        return false;
    }
    void mark(const CellBox& box) {
        for (int row = box.rows[0]; row <= box.rows[1]; ++row)
            for (int column = box.columns[0]; column <= box.columns[1]; ++column)
                if (!kept[at(column, row)]) still[at(column, row)] = 1;
    }
};

template <class Sample>
void mark_faint(const std::vector<Sample>& rgba, const Image& image, Cells& cells) {
    std::vector<std::array<int, 2>> across, across_reach;
    for (int x = 0; x < image.width; ++x) {
        across.push_back(cells_near(x, 0, cells.columns, image.width));
        across_reach.push_back(cells_near(x, filter_reach, cells.columns, image.width));
    }
    for (int y = 0; y < image.height; ++y) {
        const auto down = cells_near(y, 0, cells.rows, image.height);
        const auto down_reach = cells_near(y, filter_reach, cells.rows, image.height);
        const Sample* alpha = rgba.data() + std::size_t(y) * std::size_t(image.width) * 4 + 3;
        for (std::size_t x = 0; x < across.size(); ++x, alpha += 4)
            if (*alpha > 0 && cells.has_left_out({across[x], down}))
                cells.mark({across_reach[x], down_reach});
    }
}

/// The corners at the rectangle of some cells of one row: from column `first` to before `end`.
void add_rectangle(const Image& image, const Cells& cells, int row, int first, int end, StillCells& to) {
    const auto base = std::uint32_t(to.corners.size());
    // As the mesh's own vertices are placed, so that no seam shows between the two.
    const auto crossing = [&](int column, int line) {
        return glm::vec2(glm::dvec2(double(image.width) * column / cells.columns,
                                    double(image.height) * line / cells.rows));
    };
    to.corners.insert(to.corners.end(), {crossing(first, row), crossing(end, row), crossing(first, row + 1),
                                         crossing(end, row + 1)});
    for (const std::uint32_t corner : {0u, 3u, 1u, 0u, 2u, 3u}) to.triangles.push_back(base + corner);
}

}  // namespace

StillCells still_cells(const Image& image, const MeshSettings& settings, std::span<const std::uint8_t> kept) {
    if (!settings.from_alpha || settings.threshold == 0) return {};
    const auto [columns, rows] = grid_size(image.width, image.height, settings.cells);
    assert(kept.size() == std::size_t(columns) * std::size_t(rows));
    if (std::find(kept.begin(), kept.end(), 0) == kept.end()) return {};
    Cells cells{columns, rows, kept, std::vector<std::uint8_t>(kept.size())};
    std::visit([&](const auto& rgba) { mark_faint(rgba, image, cells); }, image.rgba);
    StillCells still;
    for (int row = 0; row < rows; ++row)
        for (int first = 0, end = 0; first < columns; first = end) {
            const bool is_still = cells.still[cells.at(first, row)] != 0;
            for (end = first + 1; end < columns && (cells.still[cells.at(end, row)] != 0) == is_still;) ++end;
            if (is_still) add_rectangle(image, cells, row, first, end, still);
        }
    return still;
}

}  // namespace probewarp
