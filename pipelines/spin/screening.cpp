#include "pipelines/spin/screening.h"

#include "pipelines/frames/celestial.h"
#include "pipelines/spin/geometry.h"

namespace spindrift {

std::vector<Residual> residuals(const SpinConfig& config, const RevolutionMeasurements& measured,
                                const Sightlines& sightlines, const Eigen::Vector3d& axis_icrf) {
  const PredictedAngles predicted =
      predict_angles(axis_icrf, sightlines.sun_icrf, sightlines.earth_icrf);
  std::vector<Residual> found;
  if (measured.sun_angle) {
    found.push_back({.quantity = SpinQuantity::SunAngle,
                     .value_rad = measured.sun_angle->value_rad - predicted.sun_angle_rad,
                     .sigma_rad = measured.sun_angle->sigma_rad});
  }
  for (const Side side : kSides) {
    const auto& crossing = measured.crossing(side);
    if (!crossing) {
      continue;
    }
    const auto chord_rad = predict_chord_rad(sensor_of(config, side)->mount_angle_rad,
                                             predicted.earth_angle_rad, sightlines.disc_rad);
    if (crossing->chord && chord_rad) {
      found.push_back({.quantity = kChords.at(index_of(side)),
                       .value_rad = crossing->chord->value_rad - *chord_rad,
                       .sigma_rad = crossing->chord->sigma_rad});
    }
    if (crossing->dihedral) {
      found.push_back(
          {.quantity = kDihedrals.at(index_of(side)),
           .value_rad = wrapped_rad(crossing->dihedral->value_rad - predicted.dihedral_rad),
           .sigma_rad = crossing->dihedral->sigma_rad});
    }
  }
  return found;
}

void ScreeningWindow::add(const Residual& residual) {
  Channel& channel = channels_.at(static_cast<std::size_t>(residual.quantity));
  channel.values_rad.push_back(residual.value_rad);
  if (channel.values_rad.size() > static_cast<std::size_t>(screening_.window)) {
    channel.values_rad.pop_front();
  }
  const std::vector<double> values(channel.values_rad.begin(), channel.values_rad.end());
  channel.mean = robust_mean(values, {.sigma = screening_.sigma, .stated = residual.sigma_rad});
}

bool ScreeningWindow::keeps(const Residual& residual) const {
  const auto& mean = channels_.at(static_cast<std::size_t>(residual.quantity)).mean;
  return mean && mean->keeps(residual.value_rad);
}

}  // namespace spindrift
