/// @file
/// Whether the gyro's rates are in another unit than rad/s: degrees taken for radians, or turned
/// into radians twice.

#pragma once

#include <Eigen/Geometry>
#include <array>
#include <optional>

#include "pipelines/frames/angle.h"
#include "pipelines/three_axis/mekf.h"
#include "pipelines/three_axis/samples.h"
#include "pipelines/time/tai_time.h"

namespace spindrift {

/// Compares turns between star fixes with those that the rates make as they are, and with those
/// that they would make in another unit: it is the one that alone agreed three times since
/// another did.
/// Lengths of turns do not tell: a body that turns once between two fixes has turned by nothing.
class GyroUnit {
 public:
  /// @param bias_sigma_rad_s Of each axis.
  explicit GyroUnit(double bias_sigma_rad_s) : bias_sigma_rad_s_{bias_sigma_rad_s} {}

  /// Every sample, whatever is made of it, in order of time with the fixes.
  void note(const GyroSample& sample);
  void note(TaiTime t, const ObservedAttitude& fix);

  /// So many times too large the rates are; empty: nothing says so.
  std::optional<double> factor() const {
    return factor_ == kFactors.front() ? std::nullopt : std::optional{factor_};
  }

 private:
  /// Of rates that are so many times too large; rad/s first.
  static constexpr std::array<double, 3> kFactors = {1.0, kDegPerRad, kRadPerDeg};

  void turn_to(TaiTime t, const Eigen::Vector3d& rate_rad_s);
  bool is_heard_at(TaiTime t) const;
  void begin(TaiTime t, const ObservedAttitude& fix);
  std::optional<double> factor_that_agrees(const Eigen::Quaterniond& seen, double sigma_rad) const;

  double bias_sigma_rad_s_;
  std::optional<GyroSample> last_;
  TaiTime reached_{};  ///< By `turned_`.
  TaiTime fixed_{};
  std::optional<Eigen::Quaterniond> fix_;                        ///< There; empty: none yet.
  std::array<Eigen::Quaterniond, kFactors.size()> turned_ = {};  ///< Since, by each factor.
  double factor_ = kFactors.front();
  int in_a_row_ = 0;  ///< That agree with another factor.
};

}  // namespace spindrift
