/// @file
/// Eigenvalues of symmetric matrices.

#pragma once

#include <Eigen/Core>

namespace spindrift {

struct SymmetricEigen {
  Eigen::VectorXd values;   ///< Rising.
  Eigen::MatrixXd vectors;  ///< Columns of length 1, in the order of the values.
};

/// @param matrix Symmetric; its lower half is read.
SymmetricEigen symmetric_eigen(const Eigen::Ref<const Eigen::MatrixXd>& matrix);

}  // namespace spindrift
