// The Laplacian of a shape's cells with cotangent weights, its Cholesky factor, and solving for several right
// hand sides at once. Private to the harmonic and the biharmonic weights.
#pragma once

#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>

#include "model/weights_in_shape.h"

namespace probewarp {

using SparseMatrix = Eigen::SparseMatrix<double>;
using Cholesky = Eigen::SimplicialLLT<SparseMatrix>;

/// #grid vertices squared, symmetric, >= 0 definite; a row's sum is 0. Half the cotangents of the angles
/// opposite to an edge: dy/dx for a cell's two horizontal edges and dx/dy for its vertical ones, each halved;
/// none along its diagonal.
SparseMatrix laplacian(const Shape& shape);

/// #grid vertices: a quarter of the kept cells around each; in cells, not pixels.
Eigen::VectorXd lumped_areas(const Shape& shape);

/// Throws Error where a matrix could not be factored.
void check_factored(Eigen::ComputationInfo info);

/// Right-hand sides that are solved together: a row holds one vertex's.
inline constexpr int side_by_side = 8;
using Sides = Eigen::Array<double, Eigen::Dynamic, side_by_side, Eigen::RowMajor>;

/// Solves in place with the factor alone: the rows of `sides` stand in the factor's own order, which is
/// factor.permutationP() of the vertices'.
void solve_in_factor_order(const Cholesky& factor, Sides& sides);

}  // namespace probewarp
