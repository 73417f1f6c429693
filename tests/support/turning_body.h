/// @file
/// A body that rotates at given rates, and readings of the ground model's sensors on it,
/// independent of the code under test. The attitude is integrated in steps of 5 ms.

#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstdint>
#include <functional>
#include <random>
#include <vector>

#include "pipelines/three_axis/attitude_estimator.h"
#include "pipelines/three_axis/config.h"
#include "pipelines/three_axis/samples.h"

namespace spindrift::testing {

Eigen::Vector3d normal_vector(std::mt19937_64& rng, double sigma);
Eigen::Quaterniond any_attitude(std::mt19937_64& rng);

/// Returns a configuration with gyro noise 0.002 deg/s and bias 0.01 deg/s, sun sensor noise 0.5
/// deg, star tracker noise 20 arcsec, and a rotated tracker mounting.
ThreeAxisConfig usual_three_axis();

/// Holds the true attitude at steps of 5 ms.
class TurningBody {
 public:
  using Rate = std::function<Eigen::Vector3d(double t_s)>;  ///< Rate in body axes, rad/s.

  TurningBody(const Eigen::Quaterniond& q_icrf_body, double duration_s, Rate rate);

  /// Returns a body whose rate about each axis is a sum of three sines with periods of 8 s and more
  /// and a total of up to `most_rad_s`.
  static TurningBody smooth(std::mt19937_64& rng, double duration_s, double most_rad_s);

  const Eigen::Quaterniond& q_icrf_body(double t_s) const;
  Eigen::Vector3d rate_rad_s(double t_s) const { return rate_(t_s); }

 private:
  Rate rate_;
  std::vector<Eigen::Quaterniond> q_icrf_body_;
};

/// Start of the pass; at_s() counts from it.
inline constexpr std::int64_t kStart_tai_ns = 1'795'143'637'000'000'000;
TaiTime at_s(double t_s);

/// Simulates the sensors of one pass with their errors.
class Sensors {
 public:
  Sensors(const TurningBody& body, const ThreeAxisConfig& config, std::mt19937_64& rng);

  GyroSample gyro(double t_s);
  StarFix star(double t_s);
  /// @param ref_icrf Unit vector, ICRF.
  Eigen::Vector3d direction(double t_s, const Eigen::Vector3d& ref_icrf, double sigma_rad);
  MagneticField field(double t_s, const Eigen::Vector3d& field_icrf_nt);

  const Eigen::Vector3d& bias_rad_s() const { return bias_rad_s_; }

 private:
  const TurningBody& body_;
  ThreeAxisConfig config_;
  std::mt19937_64& rng_;
  Eigen::Vector3d bias_rad_s_;
};

/// Returns the small rotation about body axes from the estimate to the truth.
Eigen::Vector3d error_rad(const Eigen::Quaterniond& estimate, const Eigen::Quaterniond& truth);

}  // namespace spindrift::testing
