#include "pipelines/spin/screening.h"

#include "pipelines/frames/celestial.h"
#include "pipelines/spin/geometry.h"
#include "pipelines/spin/mixed_azimuth.h"

namespace spindrift {
namespace {

/// What a quantity should be if the axis were the one that `angles` belong to.
std::optional<double> predicted_rad(const SpinConfig& config, const PredictedAngles& angles,
                                    double disc_rad, SpinQuantity quantity) {
  using enum SpinQuantity;
  switch (quantity) {
    case SunAngle:
      return angles.sun_angle_rad;
    case NorthChord:
      return predict_chord_rad(config.north->mount_angle_rad, angles.earth_angle_rad, disc_rad);
    case SouthChord:
      return predict_chord_rad(config.south->mount_angle_rad, angles.earth_angle_rad, disc_rad);
    case NorthDihedral:
    case SouthDihedral:
      return angles.dihedral_rad;
    case MixedAzimuth:
      return predict_mixed_azimuth_rad(config.sun_sensor, angles.sun_angle_rad,
                                       angles.dihedral_rad);
    case Period:
      break;
  }
  return std::nullopt;
}

}  // namespace

std::vector<Residual> residuals(const SpinConfig& config, const RevolutionMeasurements& measured,
                                const Sightlines& sightlines, const Eigen::Vector3d& axis_icrf) {
  const PredictedAngles angles =
      predict_angles(axis_icrf, sightlines.sun_icrf, sightlines.earth_icrf);
  std::vector<Residual> found;
  for (const SpinQuantity quantity : kMeasuredAngles) {
    const auto value = good_value_of(measured, quantity);
    if (!value) {
      continue;
    }
    if (const auto predicted = predicted_rad(config, angles, sightlines.disc_rad, quantity)) {
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

void ScreeningWindow::add(const Residual& residual) {
  Channel& channel = channels_.at(static_cast<std::size_t>(residual.quantity));
  channel.values_rad.add(residual.value_rad);
  channel.mean = channel.values_rad.mean({.sigma = sigma_, .stated = residual.sigma_rad});
}

bool ScreeningWindow::keeps(const Residual& residual) const {
  const auto& mean = channels_.at(static_cast<std::size_t>(residual.quantity)).mean;
  return mean && mean->keeps(residual.value_rad);
}

}  // namespace spindrift
