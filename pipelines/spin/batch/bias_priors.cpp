#include "pipelines/spin/batch/bias_priors.h"

#include <algorithm>
#include <cmath>

#include "pipelines/spin/measurement/errors_of_alignment.h"

namespace spindrift {
namespace {

/// Returns how much a bias changes per error of the mission file.
SpinAlignmentVector per_error(const SpinConfig& config, SensorBias bias, double sun_angle_rad) {
  using Errors = SpinAlignmentVector;
  switch (bias) {
    case SunAngleBias:
      return sun_angle_per_error(config.sun_sensor, sun_angle_rad);
    case SlitSeparationBias:
      return Errors::Unit(SlitSeparationError);
    case NorthMountAngleBias:
      return Errors::Unit(NorthMountAngleError);
    case SouthMountAngleBias:
      return Errors::Unit(SouthMountAngleError);
    case DihedralBias: {
      const Errors azimuths = (config.north ? 1.0 : 0.0) * Errors::Unit(NorthAzimuthError) +
                              (config.south ? 1.0 : 0.0) * Errors::Unit(SouthAzimuthError);
      return azimuths / std::max(azimuths.sum(), 1.0);
    }
    case Co2HeightBias:
      return Errors::Unit(Co2AltitudeError);
    default:
      return Errors::Zero();
  }
}

/// Returns the errors of the mission file that either end of a chord may be off by, as an azimuth.
SpinAlignmentVector of_chord_end(SensorBias bias) {
  switch (bias) {
    case NorthChordBias:
      return SpinAlignmentVector::Unit(NorthAzimuthError);
    case SouthChordBias:
      return SpinAlignmentVector::Unit(SouthAzimuthError);
    default:
      return SpinAlignmentVector::Zero();
  }
}

}  // namespace

SensorBiases BiasPriors::stated() const {
  SensorBiases sigmas = range_sigmas();
  for (int i = 0; i < kSensorBiases; ++i) {
    const auto bias = static_cast<SensorBias>(i);
    const SpinAlignmentVector slopes =
        per_error(*config_, bias, sun_angle_rad_) + 2.0 * of_chord_end(bias);
    const double variance = slopes.dot(config_->alignment * slopes);
    if (variance > 0.0) {
      sigmas[i] = std::sqrt(variance);
    }
  }
  return sigmas;
}

SensorBiases BiasPriors::of_estimated() const {
  return config_->batch.biases ? stated() : range_sigmas();
}

SpinAlignment BiasPriors::alignment_beside(BiasSet estimated) const {
  SpinAlignment left = config_->alignment;
  for (int i = 0; i < kSensorBiases; ++i) {
    const SpinAlignmentVector slopes =
        per_error(*config_, static_cast<SensorBias>(i), sun_angle_rad_);
    const SpinAlignmentVector shared = left * slopes;
    const double variance = slopes.dot(shared);
    if (estimated[static_cast<std::size_t>(i)] && variance > 0.0) {
      left -= shared * shared.transpose() / variance;
    }
  }
  return left;
}

SpinAlignmentVector BiasPriors::errors_of(SensorBias bias) const {
  const SpinAlignmentVector slopes = per_error(*config_, bias, sun_angle_rad_);
  const double square = slopes.squaredNorm();
  return square > 0.0 ? SpinAlignmentVector{slopes / square} : slopes;
}

}  // namespace spindrift
