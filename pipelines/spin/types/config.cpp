#include "pipelines/spin/types/config.h"

#include <algorithm>
#include <cmath>

namespace spindrift {
namespace {

/// Returns the share of each error in a bias, whose product with errors_of() is 1; else zero.
SpinAlignmentVector shares_of(const SpinConfig& config, SensorBias bias) {
  const SpinAlignmentVector errors = errors_of(config, bias);
  return errors / std::max(errors.sum(), 1.0);
}

}  // namespace

SpinAlignmentVector errors_of(const SpinConfig& config, SensorBias bias) {
  using Errors = SpinAlignmentVector;
  switch (bias) {
    case SlitSeparationBias:
      return Errors::Unit(SlitSeparationError);
    case NorthMountAngleBias:
      return Errors::Unit(NorthMountAngleError);
    case SouthMountAngleBias:
      return Errors::Unit(SouthMountAngleError);
    case DihedralBias:
      return (config.north ? 1.0 : 0.0) * Errors::Unit(NorthAzimuthError) +
             (config.south ? 1.0 : 0.0) * Errors::Unit(SouthAzimuthError);
    case Co2HeightBias:
      return Errors::Unit(Co2AltitudeError);
    default:
      return Errors::Zero();
  }
}

SensorBiases bias_sigmas(const SpinConfig& config) {
  SensorBiases sigmas = suspected_sigmas();
  for (int i = 0; config.batch.biases && i < kSensorBiases; ++i) {
    const SpinAlignmentVector shares = shares_of(config, static_cast<SensorBias>(i));
    const double variance = shares.dot(config.alignment * shares);
    if (variance > 0.0) {
      sigmas[i] = std::sqrt(variance);
    }
  }
  return sigmas;
}

SpinAlignment alignment_beside(const SpinConfig& config, BiasSet estimated) {
  SpinAlignment left = config.alignment;
  for (int i = 0; i < kSensorBiases; ++i) {
    const SpinAlignmentVector shares = shares_of(config, static_cast<SensorBias>(i));
    const SpinAlignmentVector shared = left * shares;
    const double variance = shares.dot(shared);
    if (estimated[static_cast<std::size_t>(i)] && variance > 0.0) {
      left -= shared * shared.transpose() / variance;
    }
  }
  return left;
}

}  // namespace spindrift
