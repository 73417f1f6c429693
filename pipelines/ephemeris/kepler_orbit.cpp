#include "pipelines/ephemeris/kepler_orbit.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <numbers>

#include "pipelines/frames/angle.h"
#include "pipelines/frames/wgs84.h"

namespace spindrift {
namespace {

Unexpected refused(std::string message) {
  return Unexpected{{ErrorCode::InvalidConfiguration, std::move(message)}};
}

/// Solves E - e sin E = M.
///
/// On [0, pi] the left side is convex, so Newton's steps from M + e, which is never too small, only
/// ever descend: the first that does not is rounding, and the root is found. (No convergence limit
/// is needed at any e < 1.)
double eccentric_anomaly_rad(double mean_anomaly_rad, double eccentricity) {
  const double wrapped_rad = std::remainder(mean_anomaly_rad, kTurn_rad);
  const double mean_rad = std::abs(wrapped_rad);
  double eccentric_rad = std::min(mean_rad + eccentricity, std::numbers::pi);
  for (double next_rad = eccentric_rad;; eccentric_rad = next_rad) {
    next_rad = eccentric_rad - (eccentric_rad - eccentricity * std::sin(eccentric_rad) - mean_rad) /
                                   (1.0 - eccentricity * std::cos(eccentric_rad));
    if (!(next_rad < eccentric_rad)) {
      return std::copysign(eccentric_rad, wrapped_rad);
    }
  }
}

/// Returns the mean anomaly at a true anomaly; both grow without bound, turn by turn.
double mean_anomaly_of_rad(double true_rad, double eccentricity) {
  const double beta = eccentricity / (1.0 + std::sqrt((1.0 - eccentricity) * (1.0 + eccentricity)));
  const double eccentric_rad =
      true_rad - 2.0 * std::atan2(beta * std::sin(true_rad), 1.0 + beta * std::cos(true_rad));
  return eccentric_rad - eccentricity * std::sin(eccentric_rad);
}

/// Returns the inverse of `mean_anomaly_of_rad`.
double true_anomaly_of_rad(double mean_rad, double eccentricity) {
  const double beta = eccentricity / (1.0 + std::sqrt((1.0 - eccentricity) * (1.0 + eccentricity)));
  const double eccentric_rad = eccentric_anomaly_rad(mean_rad, eccentricity);
  const double turns_rad = mean_rad - std::remainder(mean_rad, kTurn_rad);
  return turns_rad + eccentric_rad +
         2.0 * std::atan2(beta * std::sin(eccentric_rad), 1.0 - beta * std::cos(eccentric_rad));
}

}  // namespace

Expected<KeplerOrbit> KeplerOrbit::make(const KeplerElements& elements) {
  for (const double angle_rad :
       {elements.raan_rad, elements.argument_of_perigee_rad, elements.mean_anomaly_rad}) {
    if (!std::isfinite(angle_rad)) {
      return refused("orbit: node, argument of perigee and mean anomaly must be numbers");
    }
  }
  if (!(elements.inclination_rad >= 0.0 && elements.inclination_rad <= std::numbers::pi)) {
    return refused(
        fmt::format("orbit: inclination {} rad must lie in [0, pi]", elements.inclination_rad));
  }
  if (!(elements.eccentricity >= 0.0 && elements.eccentricity < 1.0)) {
    return refused(fmt::format("orbit: eccentricity {} must lie in [0, 1)", elements.eccentricity));
  }
  const double perigee_km = elements.semi_major_axis_km * (1.0 - elements.eccentricity);
  if (!(std::isfinite(elements.semi_major_axis_km) && perigee_km > wgs84::kEquatorialRadius_km)) {
    return refused(fmt::format(
        "orbit: semi-major axis {} km with eccentricity {} puts the perigee at {:.3f} km from the "
        "Earth's centre; it must lie above {} km",
        elements.semi_major_axis_km, elements.eccentricity, perigee_km,
        wgs84::kEquatorialRadius_km));
  }
  return KeplerOrbit{elements};
}

KeplerOrbit::KeplerOrbit(const KeplerElements& elements)
    : epoch_{elements.epoch},
      eccentricity_{elements.eccentricity},
      mean_anomaly_rad_{elements.mean_anomaly_rad} {
  const double a_km = elements.semi_major_axis_km;
  const double e = elements.eccentricity;
  const Eigen::Matrix3d R_icrf_perifocal =
      (Eigen::AngleAxisd{elements.raan_rad, Eigen::Vector3d::UnitZ()} *
       Eigen::AngleAxisd{elements.inclination_rad, Eigen::Vector3d::UnitX()} *
       Eigen::AngleAxisd{elements.argument_of_perigee_rad, Eigen::Vector3d::UnitZ()})
          .toRotationMatrix();
  mean_motion_rad_s_ = std::sqrt(kEarthMu_km3_s2 / a_km) / a_km;
  semi_major_icrf_km_ = a_km * R_icrf_perifocal.col(0);
  semi_minor_icrf_km_ = a_km * std::sqrt((1.0 - e) * (1.0 + e)) * R_icrf_perifocal.col(1);
}

/// Takes the axes of the ellipse from the eccentricity vector; those of a circle are arbitrary.
Expected<KeplerOrbit> KeplerOrbit::through(TaiTime t, const OrbitState& state) {
  const Eigen::Vector3d& r_km = state.position_icrf_km;
  const Eigen::Vector3d& v_km_s = state.velocity_icrf_km_s;
  const Eigen::Vector3d momentum_km2_s = r_km.cross(v_km_s);
  const Eigen::Vector3d to_perigee =
      v_km_s.cross(momentum_km2_s) / kEarthMu_km3_s2 - r_km.normalized();
  const double e = to_perigee.norm();
  const double a_km = 1.0 / (2.0 / r_km.norm() - v_km_s.squaredNorm() / kEarthMu_km3_s2);
  if (!(e < 1.0 && a_km * (1.0 - e) > wgs84::kEquatorialRadius_km)) {
    return Unexpected{
        {ErrorCode::InvalidInput,
         fmt::format("orbit state ({}, {}, {}) km, ({}, {}, {}) km/s is on no ellipse above the "
                     "Earth's radius of {} km",
                     r_km.x(), r_km.y(), r_km.z(), v_km_s.x(), v_km_s.y(), v_km_s.z(),
                     wgs84::kEquatorialRadius_km)}};
  }
  constexpr double kCircle = 1e-12;
  const Eigen::Vector3d major = (e > kCircle ? to_perigee : r_km).normalized();
  const Eigen::Vector3d minor = momentum_km2_s.normalized().cross(major);
  const double b_km = a_km * std::sqrt((1.0 - e) * (1.0 + e));
  const double eccentric_rad = std::atan2(r_km.dot(minor) / b_km, r_km.dot(major) / a_km + e);
  KeplerOrbit orbit;
  orbit.epoch_ = t;
  orbit.eccentricity_ = e;
  orbit.mean_anomaly_rad_ = eccentric_rad - e * std::sin(eccentric_rad);
  orbit.mean_motion_rad_s_ = std::sqrt(kEarthMu_km3_s2 / a_km) / a_km;
  orbit.semi_major_icrf_km_ = a_km * major;
  orbit.semi_minor_icrf_km_ = b_km * minor;
  return orbit;
}

double KeplerOrbit::true_anomaly_at_epoch_rad() const {
  const double true_rad =
      std::fmod(true_anomaly_of_rad(mean_anomaly_rad_, eccentricity_), kTurn_rad);
  return true_rad < 0.0 ? true_rad + kTurn_rad : true_rad;
}

double KeplerOrbit::mean_anomaly_at_epoch_rad() const {
  const double mean_rad = std::fmod(mean_anomaly_rad_, kTurn_rad);
  return mean_rad < 0.0 ? mean_rad + kTurn_rad : mean_rad;
}

TaiTime KeplerOrbit::when_behind_epoch(double true_anomaly_rad) const {
  const double first_rad = true_anomaly_at_epoch_rad();
  const double mean_rad = mean_anomaly_of_rad(first_rad + true_anomaly_rad, eccentricity_) -
                          mean_anomaly_of_rad(first_rad, eccentricity_);
  return shifted(epoch_, mean_rad / mean_motion_rad_s_);
}

double KeplerOrbit::true_anomaly_behind_epoch_rad(TaiTime t) const {
  const double mean_rad = mean_anomaly_rad_ + mean_motion_rad_s_ * seconds_between(epoch_, t);
  return true_anomaly_of_rad(mean_rad, eccentricity_) -
         true_anomaly_of_rad(mean_anomaly_rad_, eccentricity_);
}

Expected<OrbitState> KeplerOrbit::at(TaiTime t) const {
  const double mean_rad = mean_anomaly_rad_ + mean_motion_rad_s_ * seconds_between(epoch_, t);
  const double eccentric_rad = eccentric_anomaly_rad(mean_rad, eccentricity_);
  const double cos_e = std::cos(eccentric_rad);
  const double sin_e = std::sin(eccentric_rad);
  const double eccentric_rate_rad_s = mean_motion_rad_s_ / (1.0 - eccentricity_ * cos_e);
  return OrbitState{.position_icrf_km =
                        (cos_e - eccentricity_) * semi_major_icrf_km_ + sin_e * semi_minor_icrf_km_,
                    .velocity_icrf_km_s = eccentric_rate_rad_s * (cos_e * semi_minor_icrf_km_ -
                                                                  sin_e * semi_major_icrf_km_)};
}

}  // namespace spindrift
