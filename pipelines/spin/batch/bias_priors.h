/// @file
/// What the mission file's alignment says about the biases before any edge has come.

#pragma once

#include "pipelines/spin/batch/pass_model.h"
#include "pipelines/spin/types/alignment.h"
#include "pipelines/spin/types/config.h"
#include "pipelines/spin/types/sensor_biases.h"

namespace spindrift {

/// The priors of the biases about a state. A measured sun angle is as far off as cant and
/// separation of the slits make it at the state's sun angle; either end of a chord as far as the
/// azimuth of its beam.
class BiasPriors {
 public:
  BiasPriors(const SpinConfig& config, double sun_angle_rad)
      : config_{&config}, sun_angle_rad_{sun_angle_rad} {}
  BiasPriors(const PassModel& model, const SpinState& state)
      : BiasPriors{model.config(), model.sun_angle_rad(state)} {}

  /// Returns the sigmas that the mission file states; of a bias of which it states nothing that of
  /// its range.
  SensorBiases stated() const;
  /// Returns the sigmas of the biases that `batch` estimates. Without names a bias is estimated
  /// only where the edges show more than the mission file states, and has that of its range.
  SensorBiases of_estimated() const;
  /// Returns what is left of the alignment's covariance where biases are estimated, each of which
  /// takes up its own direction of the errors.
  SpinAlignment alignment_beside(BiasSet estimated) const;
  /// Returns the errors of the mission file that a value of a bias stands for; zero for those of
  /// chords and coning, which no key of it holds.
  SpinAlignmentVector errors_of(SensorBias bias) const;

 private:
  const SpinConfig* config_;
  double sun_angle_rad_;
};

}  // namespace spindrift
