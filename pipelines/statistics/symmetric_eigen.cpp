#include "pipelines/statistics/symmetric_eigen.h"

#include <Eigen/Eigenvalues>

namespace spindrift {

// One instance serves all sizes above 3: each fixed size would take ten seconds to compile.
SymmetricEigen symmetric_eigen(const Eigen::Ref<const Eigen::MatrixXd>& matrix) {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver{matrix};
  return {.values = solver.eigenvalues(), .vectors = solver.eigenvectors()};
}

}  // namespace spindrift
