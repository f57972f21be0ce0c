#include "model/shape_laplacian.h"

#include <Eigen/OrderingMethods>

#include "model/error.h"

namespace probewarp {

SparseMatrix laplacian(const Shape& shape) {
    const double along_x = shape.cell.y / shape.cell.x / 2, along_y = shape.cell.x / shape.cell.y / 2;
    const auto right_edge = [&](int column, int row) {
        return along_x * (shape.has_cell(column, row - 1) + shape.has_cell(column, row));
    };
    const auto lower_edge = [&](int column, int row) {
        return along_y * (shape.has_cell(column - 1, row) + shape.has_cell(column, row));
    };
    SparseMatrix matrix{Eigen::Index(shape.vertices), Eigen::Index(shape.vertices)};
    matrix.reserve(Eigen::Index(shape.vertices) * 5);
    for (int row = 0; row <= shape.rows; ++row)
        for (int column = 0; column <= shape.columns; ++column) {
            const std::uint32_t v = shape.grid[shape.crossing(column, row)];
            if (v == no_vertex) continue;
            matrix.startVec(Eigen::Index(v));
            const auto entry = [&](double weight, int c, int r) {
                if (weight != 0)
                    matrix.insertBack(Eigen::Index(shape.grid[shape.crossing(c, r)]), Eigen::Index(v)) =
                        -weight;
            };
            const double up = lower_edge(column, row - 1), left = right_edge(column - 1, row);
            const double right = right_edge(column, row), down = lower_edge(column, row);
            // Vertices are counted row by row, so this is their order.
            entry(up, column, row - 1);
            entry(left, column - 1, row);
            matrix.insertBack(Eigen::Index(v), Eigen::Index(v)) = up + left + right + down;
            entry(right, column + 1, row);
            entry(down, column, row + 1);
        }
    matrix.finalize();
    return matrix;
}

Eigen::VectorXd lumped_areas(const Shape& shape) {
    Eigen::VectorXd areas = Eigen::VectorXd::Zero(Eigen::Index(shape.vertices));
    for (int row = 0; row < shape.rows; ++row)
        for (int column = 0; column < shape.columns; ++column)
            if (shape.has_cell(column, row))
                for (const int r : {row, row + 1})
                    for (const int c : {column, column + 1})
                        areas[Eigen::Index(shape.grid[shape.crossing(c, r)])] += 0.25;
    return areas;
}

Eigen::PermutationMatrix<Eigen::Dynamic> elimination_order(const SparseMatrix& matrix) {
    Eigen::PermutationMatrix<Eigen::Dynamic> back;
    Eigen::AMDOrdering<int>()(matrix, back);
    return back.inverse();
}

void check_factored(Eigen::ComputationInfo info) {
    if (info != Eigen::Success)
        throw Error(
            "the weights cannot be worked out on this mesh; choose another scheme or another density");
}

}  // namespace probewarp
