/// @file
/// Gyro samples that repeat: the gyro is frozen, altogether or about one axis, or its noise is
/// below the step of the telemetry.

#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <span>

namespace spindrift {

class FrozenGyro {
 public:
  /// While no rate has ever changed nobody knows the step: so many in a row are frozen.
  static constexpr int kFrozenInARow = 10;

  explicit FrozenGyro(double noise_rad_s) : noise_rad_s_{noise_rad_s} {}

  /// What the step of the telemetry is about each axis: the least change between neighbours.
  void learn(const Eigen::Vector3d& earlier_rad_s, const Eigen::Vector3d& later_rad_s);

  /// The next sample.
  /// @return How many up to this one are the same, all three rates or one, where they are five and
  ///         more than noise makes once in a thousand million times; else 0.
  int repeated(const Eigen::Vector3d& rate_rad_s);

  /// Of the axis where it is coarsest; 0: no rate ever changed.
  double step_rad_s() const;

 private:
  using Axes = std::span<const Eigen::Index>;
  double step_of_rad_s(Eigen::Index axis) const;
  double longest_by_chance(Axes axes) const;

  double noise_rad_s_;
  std::array<std::optional<double>, 3> steps_rad_s_;  ///< Empty: it never changed.
  std::optional<Eigen::Vector3d> last_rad_s_;
  std::array<int, 4> in_a_row_ = {};  ///< All axes, then each.
};

}  // namespace spindrift
