/// @file
/// Eigenvalues of symmetric matrices.

#pragma once

#include <Eigen/Core>

namespace spindrift {

struct SymmetricEigen {
  Eigen::VectorXd values;   ///< Eigenvalues in rising order.
  Eigen::MatrixXd vectors;  ///< Unit columns, in the order of the values.
};

/// @param matrix Symmetric; only its lower half is read.
SymmetricEigen symmetric_eigen(const Eigen::Ref<const Eigen::MatrixXd>& matrix);

}  // namespace spindrift
