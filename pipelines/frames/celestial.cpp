#include "pipelines/frames/celestial.h"

#include <cmath>
#include <numbers>

#include "pipelines/frames/angle.h"
#include "pipelines/frames/shortest_turn.h"

namespace spindrift {

Eigen::Vector3d direction_icrf(const RaDec& place) {
  const double cos_dec = std::cos(place.dec_rad);
  return {cos_dec * std::cos(place.ra_rad), cos_dec * std::sin(place.ra_rad),
          std::sin(place.dec_rad)};
}

RaDec ra_dec_of(const Eigen::Vector3d& direction_icrf) {
  const double equatorial = std::hypot(direction_icrf.x(), direction_icrf.y());
  const double ra_rad = equatorial > 0.0 ? std::atan2(direction_icrf.y(), direction_icrf.x()) : 0.0;
  // A right ascension just below zero plus a full turn rounds to the full turn itself.
  const double ra_positive_rad = ra_rad < 0.0 ? ra_rad + kTurn_rad : ra_rad;
  return {.ra_rad = ra_positive_rad < kTurn_rad ? ra_positive_rad : 0.0,
          .dec_rad = std::atan2(direction_icrf.z(), equatorial)};
}

double angle_between_rad(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

Eigen::Matrix<double, 3, 2> tangent_basis(const Eigen::Vector3d& axis_icrf) {
  const double equatorial = std::hypot(axis_icrf.x(), axis_icrf.y());
  // At a pole the right ascension is 0, as in `ra_dec_of`.
  const Eigen::Vector3d east = equatorial > 0.0 ? Eigen::Vector3d{-axis_icrf.y() / equatorial,
                                                                  axis_icrf.x() / equatorial, 0.0}
                                                : Eigen::Vector3d::UnitY();
  Eigen::Matrix<double, 3, 2> basis;
  basis.col(0) = east;
  basis.col(1) = axis_icrf.normalized().cross(east);
  return basis;
}

Eigen::Matrix2d tangent_from_tilts(const Eigen::Quaterniond& q_icrf_frame) {
  const Eigen::Matrix3d R_icrf_frame = q_icrf_frame.toRotationMatrix();
  Eigen::Matrix<double, 3, 2> moved_icrf;
  moved_icrf << -R_icrf_frame.col(1), R_icrf_frame.col(0);
  return tangent_basis(R_icrf_frame.col(2)).transpose() * moved_icrf;
}

Eigen::Quaterniond frame_about(const Eigen::Vector3d& axis_icrf) {
  return shortest_turn(Eigen::Vector3d::UnitZ(), axis_icrf);
}

Eigen::Matrix2d anywhere_covariance_rad2() {
  constexpr double kMeanSquare_rad2 = (std::numbers::pi * std::numbers::pi - 4.0) / 2.0;
  return Eigen::Matrix2d::Identity() * (0.5 * kMeanSquare_rad2);
}

double wrapped_rad(double angle_rad) {
  // Most angles are in range, and the remainder, which leaves these as they are, takes long.
  const double wrapped =
      std::abs(angle_rad) <= std::numbers::pi ? angle_rad : std::remainder(angle_rad, kTurn_rad);
  return wrapped <= -std::numbers::pi ? std::numbers::pi : wrapped;
}

}  // namespace spindrift
