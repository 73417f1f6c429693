/// @file
/// A body that turns smoothly at rates that somebody gives, and what the sensors of the ground
/// model read of it: independent of the code under test. The attitude is integrated by steps of
/// five milliseconds.

#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstdint>
#include <functional>
#include <random>
#include <vector>

#include "pipelines/three_axis/attitude_estimator.h"
#include "pipelines/three_axis/config.h"
#include "pipelines/three_axis/magnetic_field.h"
#include "pipelines/three_axis/samples.h"

namespace spindrift::testing {

Eigen::Vector3d normal_vector(std::mt19937_64& rng, double sigma);
Eigen::Quaterniond any_attitude(std::mt19937_64& rng);

/// Gyro 0.002 deg/s and bias 0.01 deg/s, sun sensor 0.5 deg, star tracker 20 arcsec, turned.
ThreeAxisConfig usual_three_axis();

/// The truth at steps of five milliseconds.
class TurningBody {
 public:
  using Rate = std::function<Eigen::Vector3d(double t_s)>;  ///< Body axes, rad/s.

  TurningBody(const Eigen::Quaterniond& q_icrf_body, double duration_s, Rate rate);

  /// Each axis by three sines of up to `most_rad_s` together, periods of 8 s and more.
  static TurningBody smooth(std::mt19937_64& rng, double duration_s, double most_rad_s);

  const Eigen::Quaterniond& q_icrf_body(double t_s) const;
  Eigen::Vector3d rate_rad_s(double t_s) const { return rate_(t_s); }

 private:
  Rate rate_;
  std::vector<Eigen::Quaterniond> q_icrf_body_;
};

/// Of a pass that starts at kStart.
inline constexpr std::int64_t kStart_tai_ns = 1'795'143'637'000'000'000;
TaiTime at_s(double t_s);

/// The sensors of one pass with their errors.
class Sensors {
 public:
  Sensors(const TurningBody& body, const ThreeAxisConfig& config, std::mt19937_64& rng);

  GyroSample gyro(double t_s);
  StarFix star(double t_s);
  /// @param ref_icrf Unit.
  Eigen::Vector3d direction(double t_s, const Eigen::Vector3d& ref_icrf, double sigma_rad);
  MagneticField field(double t_s, const Eigen::Vector3d& field_icrf_nt);

  const Eigen::Vector3d& bias_rad_s() const { return bias_rad_s_; }

 private:
  const TurningBody& body_;
  ThreeAxisConfig config_;
  std::mt19937_64& rng_;
  Eigen::Vector3d bias_rad_s_;
};

/// The small turn, body axes, from an estimate to the truth.
Eigen::Vector3d error_rad(const Eigen::Quaterniond& estimate, const Eigen::Quaterniond& truth);

}  // namespace spindrift::testing
