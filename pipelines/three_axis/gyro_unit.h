/// @file
/// Detects gyro rates in a wrong unit: degrees sent as radians, or converted to radians twice.

#pragma once

#include <Eigen/Geometry>
#include <array>
#include <optional>

#include "pipelines/frames/angle.h"
#include "pipelines/three_axis/mekf.h"
#include "pipelines/three_axis/samples.h"
#include "pipelines/time/tai_time.h"

namespace spindrift {

/// Compares the turn between two star fixes with the turn integrated from the rates, taken as they
/// are and as if they were in another unit. A unit is adopted once it alone has agreed three times
/// since the current unit last did. Rotation angles alone would not tell, because a body that makes
/// one full turn between two fixes appears unturned.
class GyroUnit {
 public:
  /// @param bias_sigma_rad_s Standard deviation of the bias of each axis.
  explicit GyroUnit(double bias_sigma_rad_s) : bias_sigma_rad_s_{bias_sigma_rad_s} {}

  /// Adds a sample; rejected ones must be added too, all in time order with the fixes.
  void observe(const GyroSample& sample);
  void observe(TaiTime t, const ObservedAttitude& fix);

  /// Returns the factor by which the rates are too large; empty if they agree with rad/s.
  std::optional<double> factor() const {
    return factor_ == kFactors.front() ? std::nullopt : std::optional{factor_};
  }

 private:
  /// Factors by which rates in each candidate unit are too large; rad/s first.
  static constexpr std::array<double, 3> kFactors = {1.0, kDegPerRad, kRadPerDeg};

  void turn_to(TaiTime t, const Eigen::Vector3d& rate_rad_s);
  bool is_heard_at(TaiTime t) const;
  void begin(TaiTime t, const ObservedAttitude& fix);
  std::optional<double> factor_that_agrees(const Eigen::Quaterniond& seen, double sigma_rad) const;

  double bias_sigma_rad_s_;
  std::optional<GyroSample> last_;
  TaiTime reached_{};  ///< Epoch to which `turned_` is integrated.
  TaiTime fixed_{};
  std::optional<Eigen::Quaterniond> fix_;  ///< Star fix at `fixed_`; empty if there is none yet.
  std::array<Eigen::Quaterniond, kFactors.size()> turned_ =
      {};  ///< Turns since `fix_`, per factor.
  double factor_ = kFactors.front();
  int in_a_row_ = 0;  ///< Consecutive fixes that agree with another factor.
};

}  // namespace spindrift
