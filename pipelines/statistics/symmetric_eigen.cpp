#include "pipelines/statistics/symmetric_eigen.h"

#include <Eigen/Eigenvalues>

namespace spindrift {

// For all sizes above 3: each of its own would take ten seconds to compile.
SymmetricEigen symmetric_eigen(const Eigen::Ref<const Eigen::MatrixXd>& matrix) {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver{matrix};
  return {.values = solver.eigenvalues(), .vectors = solver.eigenvectors()};
}

}  // namespace spindrift
