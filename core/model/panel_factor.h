// A sparse Cholesky factor laid out in panels of columns alike: solving for several right-hand sides side by
// side, and adding to the matrix's diagonal without factoring anew. Private to the harmonic and the
// biharmonic weights.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "model/shape_laplacian.h"

namespace probewarp {

/// Where a factor L (lower triangular, in its own order) has its entries; the same for every matrix of one
/// pattern. A panel (a supernode) is a run of columns that have the same rows below it.
struct Panels {
    struct Panel {
        int first, columns;
        std::size_t below;  ///< of its rows below: the first one's place in `rows`
        int rows_below;
        /// Its first value's place. The values: (columns + rows_below) x columns, row-major, the panel's own
        /// rows first (0 above the diagonal, where 1 / L(j, j) stands instead of L(j, j)), then the rows
        /// below.
        std::size_t values;
        std::size_t value_count() const {
            return std::size_t(columns) * (std::size_t(columns) + std::size_t(rows_below));
        }
    };
    std::vector<Panel> panels;  ///< by their columns
    std::vector<int> rows;      ///< each panel's rows below it, ascending
    std::vector<int> panel_of;  ///< #columns
    std::size_t value_count = 0;
};

/// A rank-1 update: what is added to the matrix's diagonal at a row and column, in the factor's order; >= 0.
struct Raise {
    int at;
    float by;
};

/// Turns the factor of A into that of A with the raises added to its diagonal. Up to three at a time, which
/// cost little more than one where they are near each other.
/// (Gill, Golub, Murray & Saunders 1974, method C1, along the elimination tree: Davis & Hager 1999,
/// section 4.)
class DiagonalRaiser {
  public:
    explicit DiagonalRaiser(const Panels& panels);
    void raise(const std::array<Raise, 3>& raises, std::span<float> values);

  private:
    void raise_panel(const Panels::Panel& panel, std::span<float> values);
    const Panels& panels_;
    std::vector<std::array<float, 3>>
        update_;  ///< #columns: the columns that are still to be added; 0 between two calls
};

/// Right-hand sides that are solved together: a row holds one vertex's.
template <class T>
inline constexpr int side_by_side = sizeof(T) == 4 ? 12 : 8;
template <class T>
using Sides = Eigen::Array<T, Eigen::Dynamic, side_by_side<T>, Eigen::RowMajor>;

/// Solves in place; the rows of `sides` stand in the factor's order. For float and double.
template <class T>
void solve_by_panels(const Panels& panels, std::span<const T> values, Sides<T>& sides);

}  // namespace probewarp
