#include "pipelines/spin/batch/pass_evidence.h"

#include <string>
#include <vector>

#include "pipelines/frames/angle.h"
#include "pipelines/spin/batch/bias_priors.h"
#include "pipelines/spin/batch/observability.h"

namespace spindrift {
namespace {

/// Holds one value of the mission file in the unit of its key.
struct FileValue {
  SpinAlignmentError error;
  double value;
  double unit;  ///< Size of the unit in that of alignment.h.
};

std::vector<FileValue> values_of(const SpinConfig& config) {
  const auto angle = [](SpinAlignmentError error, double angle_rad) {
    return FileValue{.error = error, .value = angle_rad / kRadPerDeg, .unit = kRadPerDeg};
  };
  std::vector<FileValue> values = {
      angle(SlitCantError, config.sun_sensor.slit_cant_rad),
      angle(SlitSeparationError, config.sun_sensor.slit_separation_rad)};
  if (config.north) {
    values.push_back(angle(NorthMountAngleError, config.north->mount_angle_rad));
    values.push_back(angle(NorthAzimuthError, config.north->azimuth_rad));
  }
  if (config.south) {
    values.push_back(angle(SouthMountAngleError, config.south->mount_angle_rad));
    values.push_back(angle(SouthAzimuthError, config.south->azimuth_rad));
  }
  values.push_back(
      {.error = Co2AltitudeError, .value = config.horizon.co2_altitude_km, .unit = 1.0});
  values.push_back({.error = TimeTagError, .value = 0.0, .unit = 1.0});
  return values;
}

/// Returns the errors that the estimated biases stand for.
SpinAlignmentVector estimated_errors(const BiasPriors& priors, const EvaluatedFit& found) {
  SpinAlignmentVector errors = SpinAlignmentVector::Zero();
  for (int i = 0; i < kSensorBiases; ++i) {
    if (found.estimated[static_cast<std::size_t>(i)]) {
      errors += found.fit.state.biases[i] * priors.errors_of(static_cast<SensorBias>(i));
    }
  }
  return errors;
}

BiasSet without_key(const BiasPriors& priors, BiasSet estimated) {
  for (int i = 0; i < kSensorBiases; ++i) {
    if (!priors.errors_of(static_cast<SensorBias>(i)).isZero()) {
      estimated.reset(static_cast<std::size_t>(i));
    }
  }
  return estimated;
}

}  // namespace

SpinAlignmentEvidence alignment_evidence(const PassModel& model, const EvaluatedFit& found) {
  const BiasPriors priors{model, found.fit.state};
  const PassInformation& pass = found.information;
  const Observability others{pass, without_key(priors, found.estimated)};
  // Other biases are held, with a zero in the step.
  const ConsideredVector score =
      pass.considered.score +
      pass.considered.shared.transpose() * others.step(pass, found.fit.state.biases);
  SpinAlignmentEvidence evidence =
      beside_offsets(pass.considered.own - others.taken(pass), score, found.considered);
  const double noise = found.excess_noise();
  evidence.information /= noise;
  evidence.score /= noise;
  evidence.score += evidence.information * estimated_errors(priors, found);
  return evidence;
}

NormalEquations normal_equations(const PassModel& model, const EvaluatedFit& found) {
  const SpinAlignmentEvidence evidence = alignment_evidence(model, found);
  const std::vector<FileValue> values = values_of(model.config());
  const auto count = static_cast<Eigen::Index>(values.size());
  NormalEquations equations{.names = {},
                            .b0 = Eigen::VectorXd(count),
                            .n = Eigen::MatrixXd(count, count),
                            .g = Eigen::VectorXd(count)};
  for (Eigen::Index i = 0; i < count; ++i) {
    const auto& [error, value, unit] = values[static_cast<std::size_t>(i)];
    equations.names.emplace_back(kSpinAlignmentKeys.at(error));
    equations.b0[i] = value;
    equations.g[i] = evidence.score[error] * unit;
    for (Eigen::Index j = 0; j < count; ++j) {
      const FileValue& other = values[static_cast<std::size_t>(j)];
      equations.n(i, j) = evidence.information(error, other.error) * unit * other.unit;
    }
  }
  return equations;
}

}  // namespace spindrift
