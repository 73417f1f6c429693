#include "pipelines/frames/inertia.h"

#include <Eigen/Eigenvalues>

namespace spindrift {

bool is_inertia(const Eigen::Matrix3d& matrix) {
  constexpr double kTolerance = 1e-9;
  const double scale = matrix.cwiseAbs().maxCoeff();
  // Written so that NaN fails.
  if (!((matrix - matrix.transpose()).cwiseAbs().maxCoeff() <= kTolerance * scale)) {
    return false;
  }
  const Eigen::Vector3d moments =
      Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>{matrix, Eigen::EigenvaluesOnly}.eigenvalues();
  return moments[0] > 0.0 && moments[2] <= (moments[0] + moments[1]) * (1.0 + kTolerance);
}

}  // namespace spindrift
