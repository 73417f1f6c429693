#include "pipelines/spin/screening/screening.h"

#include "pipelines/frames/celestial.h"
#include "pipelines/spin/measurement/beam_view.h"
#include "pipelines/spin/measurement/mixed_azimuth.h"
#include "pipelines/spin/sensor_model/geometry.h"

namespace spindrift {
namespace {

/// Predicts the measured angles for a given axis.
class Prediction {
 public:
  Prediction(const SpinConfig& config, const RevolutionMeasurements& measured,
             const SunEarthDirections& sun_earth, const Eigen::Vector3d& axis_icrf)
      : sensor_{config.sun_sensor},
        angles_{predict_angles(axis_icrf, sun_earth.sun_icrf, sun_earth.earth_icrf)},
        beams_{views_of_horizon(config, measured, sun_earth, axis_icrf)} {}

  /// Returns the predicted angle; empty when the axis makes it impossible.
  std::optional<double> of_rad(SpinQuantity quantity, const EdgeNoise& noise_rad) const {
    if (quantity == SpinQuantity::SunAngle) {
      return angles_.sun_angle_rad;
    }
    for (const Side side : kSides) {
      if (quantity == kChords.at(index_of(side))) {
        return beams_.at(index_of(side)).chord_rad;
      }
    }
    const double dihedral_rad = angles_.dihedral_rad - lead_rad(beams_, noise_rad);
    return quantity == SpinQuantity::MixedAzimuth
               ? predict_mixed_azimuth_rad(sensor_, angles_.sun_angle_rad, dihedral_rad)
               : std::optional{dihedral_rad};
  }

 private:
  SunSensor sensor_;
  PredictedAngles angles_;
  BeamViews beams_;
};

}  // namespace

std::vector<AngleResidual> residuals(const SpinConfig& config,
                                     const RevolutionMeasurements& measured,
                                     const SunEarthDirections& sun_earth,
                                     const Eigen::Vector3d& axis_icrf) {
  const Prediction prediction{config, measured, sun_earth, axis_icrf};
  std::vector<AngleResidual> found;
  for (const SpinQuantity quantity : kMeasuredAngles) {
    const auto value = good_value_of(measured, quantity);
    if (!value) {
      continue;
    }
    if (const auto predicted = prediction.of_rad(quantity, value->noise_rad)) {
      found.push_back({.quantity = quantity,
                       .value_rad = wrapped_rad(value->value_rad - *predicted),
                       .sigma_rad = value->sigma_rad});
    }
  }
  return found;
}

ScreeningWindow::ScreeningWindow(const SpinScreening& screening)
    : sigma_{screening.sigma},
      channels_(kSpinQuantities,
                {.values_rad = SlidingRobustMean{static_cast<std::size_t>(screening.window)}}) {}

void ScreeningWindow::add(const AngleResidual& residual) {
  Channel& channel = channels_.at(static_cast<std::size_t>(residual.quantity));
  channel.values_rad.add(residual.value_rad);
  channel.mean = channel.values_rad.mean({.sigma = sigma_, .stated = residual.sigma_rad});
}

std::optional<Observation> ScreeningWindow::judged(TaiTime t, const AngleResidual& residual) const {
  const auto& mean = channels_.at(static_cast<std::size_t>(residual.quantity)).mean;
  return mean ? std::optional{Observation::of(t, source_of(residual.quantity),
                                              residual.value_rad - mean->mean, residual.sigma_rad,
                                              mean->limit, rejection_of(residual.quantity))}
              : std::nullopt;
}

}  // namespace spindrift
