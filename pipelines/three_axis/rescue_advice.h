/// @file
/// What to tell of a body whose lost gate is open: which sensors still speak, the attitude that is
/// known, and whether control may restart.

#pragma once

#include <optional>

#include "pipelines/three_axis/attitude_gates.h"
#include "pipelines/three_axis/config.h"
#include "pipelines/three_axis/products.h"
#include "pipelines/time/tai_time.h"

namespace spindrift {

/// Advises when the body is lost, whenever the advice changes but for its numbers, and with new
/// numbers once a minute.
class RescueAdvice {
 public:
  /// A sensor without a sample for so long is silent, and an attitude that is older is none.
  static constexpr double kSilent_s = 60.0;
  /// A sensor of which so many samples in a row were left out is of no use.
  static constexpr int kLeftOutInARow = 10;
  static constexpr double kBetween_s = 60.0;

  /// Takes the attitude in force; one that is LOST is none.
  void see(const AttitudeEstimate& estimate);

  /// @param t Rises from call to call.
  /// @return Empty where there is nothing new to advise.
  std::optional<Advisory> advise(TaiTime t, const AttitudeGates& gates,
                                 const ThreeAxisConfig& config, const SensorHealths& sensors);

 private:
  std::optional<AttitudeEstimate> attitude_;
  std::optional<Advisory> given_;  ///< The last one, while the body is lost.
};

}  // namespace spindrift
