#include "pipelines/spin/screening.h"

#include <array>
#include <cmath>

#include "pipelines/frames/celestial.h"
#include "pipelines/spin/earth_motion.h"
#include "pipelines/spin/geometry.h"
#include "pipelines/spin/horizon.h"
#include "pipelines/spin/mixed_azimuth.h"

namespace spindrift {
namespace {

/// What a beam has of the Earth.
struct BeamView {
  std::optional<double> chord_rad;  ///< Empty: it misses the limb, or only grazes it.
  double lead_rad = 0.0;            ///< Of the chord's middle, before the Earth's centre.
};

/// Before an oblate Earth, which need not stand upright, the middle of a chord lies beside the
/// Earth's centre.
BeamView beam_on_ellipsoid(const Horizon& horizon, const Sightlines& sightlines,
                           const Eigen::Vector3d& axis_icrf, double mount_angle_rad) {
  const HorizonAxes axes = horizon_axes(horizon);
  Eigen::Matrix3d R_icrf_spin;
  R_icrf_spin << tangent_basis(axis_icrf), axis_icrf;
  const Eigen::Vector3d earth_spin = R_icrf_spin.transpose() * sightlines.earth_icrf;
  const double range_km = axes.equatorial_km / std::sin(sightlines.disc_rad);
  const EarthView earth{.spacecraft_spin_km = -range_km * earth_spin,
                        .pole_spin = R_icrf_spin.transpose() * sightlines.earth_pole_icrf};
  const auto in = limb_crossing(axes, earth, mount_angle_rad, Crossing::In);
  const auto out = limb_crossing(axes, earth, mount_angle_rad, Crossing::Out);
  if (!in || !out) {
    return {};
  }
  const double centre_rad = std::atan2(earth_spin.y(), earth_spin.x());
  const double before_rad = wrapped_rad(centre_rad - in->azimuth_rad);
  const double behind_rad = wrapped_rad(out->azimuth_rad - centre_rad);
  return {.chord_rad = before_rad + behind_rad, .lead_rad = 0.5 * (before_rad - behind_rad)};
}

/// What the measured angles should be if the axis were this one.
class Prediction {
 public:
  Prediction(const SpinConfig& config, const Sightlines& sightlines,
             const Eigen::Vector3d& axis_icrf)
      : sensor_{config.sun_sensor},
        angles_{predict_angles(axis_icrf, sightlines.sun_icrf, sightlines.earth_icrf)} {
    for (const Side side : kSides) {
      if (const auto& beam = sensor_of(config, side)) {
        beams_.at(index_of(side)) =
            config.horizon.model == HorizonModel::Sphere
                ? BeamView{.chord_rad = predict_chord_rad(
                               beam->mount_angle_rad, angles_.earth_angle_rad, sightlines.disc_rad)}
                : beam_on_ellipsoid(config.horizon, sightlines, axis_icrf, beam->mount_angle_rad);
      }
    }
  }

  /// Empty for what is impossible.
  std::optional<double> of_rad(SpinQuantity quantity, const EdgeNoise& noise_rad) const {
    if (quantity == SpinQuantity::SunAngle) {
      return angles_.sun_angle_rad;
    }
    for (const Side side : kSides) {
      if (quantity == kChords.at(index_of(side))) {
        return beams_.at(index_of(side)).chord_rad;
      }
    }
    const double dihedral_rad = angles_.dihedral_rad - lead_rad(noise_rad);
    return quantity == SpinQuantity::MixedAzimuth
               ? predict_mixed_azimuth_rad(sensor_, angles_.sun_angle_rad, dihedral_rad)
               : std::optional{dihedral_rad};
  }

 private:
  /// Of the beam, or the mean of the beams, that an azimuth rests on.
  double lead_rad(const EdgeNoise& noise_rad) const {
    double sum_rad = 0.0;
    int beams = 0;
    for (const Side side : kSides) {
      if (noise_rad(static_cast<Eigen::Index>(kInChannels.at(index_of(side)))) != 0.0) {
        sum_rad += beams_.at(index_of(side)).lead_rad;
        ++beams;
      }
    }
    return beams > 0 ? sum_rad / beams : 0.0;
  }

  SunSensor sensor_;
  PredictedAngles angles_;
  std::array<BeamView, 2> beams_;
};

}  // namespace

std::vector<Residual> residuals(const SpinConfig& config, const RevolutionMeasurements& measured,
                                const Sightlines& sightlines, const Eigen::Vector3d& axis_icrf) {
  const Prediction prediction{config, sightlines, axis_icrf};
  const EdgeNoise late = late_by_earth_motion(config, measured, sightlines, axis_icrf);
  std::vector<Residual> found;
  for (const SpinQuantity quantity : kMeasuredAngles) {
    const auto value = good_value_of(measured, quantity);
    if (!value) {
      continue;
    }
    if (const auto predicted = prediction.of_rad(quantity, value->noise_rad)) {
      found.push_back(
          {.quantity = quantity,
           .value_rad = wrapped_rad(value->value_rad - value->noise_rad.dot(late) - *predicted),
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
