/// @file
/// The measured fields of a body that points at the Earth as commanded, nearly, until it departs.

#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <optional>
#include <random>
#include <utility>

#include "pipelines/geomagnetism/main_field.h"
#include "pipelines/three_axis/config.h"
#include "pipelines/three_axis/samples.h"
#include "services/mission/igrf.h"
#include "tests/support/low_orbit.h"
#include "tests/support/turning_body.h"

namespace spindrift::testing {

/// Returns the axes of the orbit frame as columns: x ahead, y against the orbit normal, z down.
inline Eigen::Matrix3d axes_of_orbit(const OrbitState& spacecraft) {
  const Eigen::Vector3d down = -spacecraft.position_icrf_km.normalized();
  const Eigen::Vector3d against =
      spacecraft.velocity_icrf_km_s.cross(spacecraft.position_icrf_km).normalized();
  Eigen::Matrix3d axes;
  axes << against.cross(down), against, down;
  return axes;
}

class CommandedFlight {
 public:
  /// @param pointing_rad Root mean square of the angle to the commanded attitude. The pointing
  ///        error is the same kind of random walk about each axis, which forgets in a minute.
  CommandedFlight(std::mt19937_64& rng, double pointing_rad, double noise_nt)
      : rng_{rng}, sigma_rad_{pointing_rad / std::sqrt(3.0)}, noise_nt_{noise_nt} {}

  const Orbit& orbit() const { return orbit_; }
  const MainFieldModel& model() const { return model_; }

  /// Returns the attitude commanded: body axes are those of the orbit, turned by 30 deg about x.
  static NominalAttitude commanded() {
    return {.frame = NominalAttitude::Frame::Orbit, .q_frame_body = kOrbitBody};
  }
  ThreeAxisConfig config() const {
    return {.gyro = {},
            .sun_sensor = DigitalSunSensor{.noise_rad = 0.5 * kRadPerDeg},
            .star_tracker = {},
            .magnetometer = Magnetometer{.noise_nt = noise_nt_},
            .inertia = {},
            .nominal = commanded()};
  }

  /// Returns the field measured so many seconds after the start; times must rise.
  /// @param departed_rad Angle by which the body has departed, so that the field turns by it.
  MagneticField field(double t_s, double departed_rad = 0.0) {
    const Eigen::Vector3d icrf_nt = field_icrf_nt(t_s);
    const Eigen::Vector3d expected_nt = q_icrf_body(t_s).conjugate() * icrf_nt;
    return {.t = at_s(t_s),
            .field_body_nt = Eigen::AngleAxisd{-departed_rad, expected_nt.unitOrthogonal()} *
                                 (q_icrf_body_true(t_s).conjugate() * icrf_nt) +
                             normal_vector(rng_, noise_nt_)};
  }
  Eigen::Quaterniond q_icrf_body(double t_s) const {
    const OrbitState spacecraft = orbit_.at(at_s(t_s)).value();
    return Eigen::Quaterniond{axes_of_orbit(spacecraft)} * kOrbitBody;
  }

 private:
  inline static const Eigen::Quaterniond kOrbitBody{
      Eigen::AngleAxisd{30.0 * kRadPerDeg, Eigen::Vector3d::UnitX()}};
  static constexpr double kForgets_s = 60.0;

  Eigen::Vector3d field_icrf_nt(double t_s) {
    const TaiTime t = at_s(t_s);
    return spindrift::field_icrf_nt(model_, t, orbit_.at(t).value().position_icrf_km, earth_)
        .value();
  }
  Eigen::Quaterniond q_icrf_body_true(double t_s) {
    const double left = off_rad_ ? std::exp(-(t_s - last_s_) / kForgets_s) : 0.0;
    off_rad_ = left * off_rad_.value_or(Eigen::Vector3d::Zero()) +
               normal_vector(rng_, sigma_rad_ * std::sqrt(1.0 - left * left));
    last_s_ = t_s;
    return q_icrf_body(t_s) *
           Eigen::Quaterniond{Eigen::AngleAxisd{off_rad_->norm(), off_rad_->stableNormalized()}};
  }

  std::mt19937_64& rng_;
  double sigma_rad_;
  double noise_nt_;
  Orbit orbit_ = low_orbit(at_s(0.0));
  MainFieldModel model_ = igrf().value();
  TurningEarth earth_;
  std::optional<Eigen::Vector3d> off_rad_;  ///< Pointing error at the last field.
  double last_s_ = 0.0;
};

}  // namespace spindrift::testing
