// The Laplacian of a shape's cells with cotangent weights. Private to the harmonic and the biharmonic
// weights.
#pragma once

#include <Eigen/SparseCore>

#include "model/weights_in_shape.h"

namespace probewarp {

using SparseMatrix = Eigen::SparseMatrix<double>;

/// #grid vertices squared, symmetric, >= 0 definite; a row's sum is 0. Half the cotangents of the angles
/// opposite to an edge: dy/dx for a cell's two horizontal edges and dx/dy for its vertical ones, each halved;
/// none along its diagonal.
SparseMatrix laplacian(const Shape& shape);

/// #grid vertices: a quarter of the kept cells around each; in cells, not pixels.
Eigen::VectorXd lumped_areas(const Shape& shape);

/// #vertices of a symmetric matrix: in which row each one is to be eliminated, so that the factor stays
/// sparse.
Eigen::PermutationMatrix<Eigen::Dynamic> elimination_order(const SparseMatrix& matrix);

/// Throws Error where a matrix could not be factored.
void check_factored(Eigen::ComputationInfo info);

}  // namespace probewarp
