#include "pipelines/spin/coning.h"

#include <Eigen/Dense>
#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include "pipelines/frames/celestial.h"

namespace spindrift {
namespace {

// Chi-square of two degrees of freedom: one in ten thousand.
constexpr double kSignificant = 18.42;
// One-sided, of a normal variable: 95 of 100.
constexpr double kSurely = 1.645;

}  // namespace

Eigen::Vector2d phase_per_coning(const PredictedEdge& edge, double azimuth_rad) {
  return Eigen::Rotation2Dd{-azimuth_rad} * edge.phase_per_rotation.head<2>();
}

ConingVerdict judge_coning(const Eigen::Vector2d& coning_rad,
                           const Eigen::Matrix2d& covariance_rad2) {
  const double hinge_rad = std::atan2(coning_rad.y(), coning_rad.x());
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> spectrum{covariance_rad2};
  const Eigen::Vector2d along = spectrum.eigenvectors().transpose() * coning_rad;
  const double chi_square = along.cwiseAbs2().cwiseQuotient(spectrum.eigenvalues()).sum();
  return {
      .tilt_rad = coning_rad.norm(),
      // It leans a quarter of a turn behind its hinge, and behind is counted to the right.
      .azimuth_rad = wrapped_rad(0.5 * std::numbers::pi - hinge_rad),
      .detected = chi_square > kSignificant,
      .detectable_rad = (std::sqrt(kSignificant) + kSurely) * std::sqrt(spectrum.eigenvalues()[1])};
}

}  // namespace spindrift
