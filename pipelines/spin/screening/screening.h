/// @file
/// Rationality test of the measurements: each against what the mean attitude predicts.
///
/// All residuals of the window are taken against one axis, and anew for all when twice as many
/// fixes support it. Taking each against the mean of its own time was rejected: at 5 rpm that
/// rejected one good sun angle in twenty while the mean still moved.

#pragma once

#include <optional>
#include <vector>

#include "pipelines/spin/measurement/measurement.h"
#include "pipelines/spin/types/config.h"
#include "pipelines/spin/types/products.h"
#include "pipelines/spin/types/sky.h"
#include "pipelines/statistics/robust_mean.h"

namespace spindrift {

/// Measured minus predicted value of one quantity of one revolution.
struct AngleResidual {
  SpinQuantity quantity;
  double value_rad;
  double sigma_rad;
};

/// Returns one residual per good measurement. A measurement that the axis makes impossible (a chord
/// of a beam that misses the Earth, a pulse of a slit that cannot see the Sun) has none: the other
/// quantities decide then. Chords and dihedrals are those of the mission's horizon.
std::vector<AngleResidual> residuals(const SpinConfig& config,
                                     const RevolutionMeasurements& measured,
                                     const SunEarthDirections& sun_earth,
                                     const Eigen::Vector3d& axis_icrf);

/// A sliding window of residuals for every quantity. Deviations count from the window's mean, not
/// from zero: an error that all share (a misplaced sensor, the Earth's oblateness) is not an
/// outlier. Rejected residuals stay in the window, so the test follows when the attitude really
/// changes.
class ScreeningWindow {
 public:
  explicit ScreeningWindow(const SpinScreening& screening);

  void add(const AngleResidual& residual);
  /// Returns what a residual says against the mean after its quantity's last one; empty when there
  /// was none.
  std::optional<Observation> judged(TaiTime t, const AngleResidual& residual) const;

 private:
  struct Channel {
    SlidingRobustMean values_rad;
    std::optional<RobustMean> mean = {};  ///< Mean after the last value.
  };

  double sigma_;
  std::vector<Channel> channels_;  ///< Indexed by SpinQuantity.
};

}  // namespace spindrift
