#include "pipelines/spin/measurement/measurement.h"

#include <cmath>
#include <initializer_list>
#include <vector>

#include "pipelines/frames/angle.h"
#include "pipelines/frames/celestial.h"

namespace spindrift {
namespace {

using enum PulseChannel;

Measured measured_from(double value_rad, const EdgeNoise& noise_rad) {
  return {.value_rad = value_rad, .sigma_rad = noise_rad.norm(), .noise_rad = noise_rad};
}

/// Adds the noise that the period's uncertainty causes in an angle turned.
Measured with_period_noise(Measured measured, const SpinPeriod& period, double turned_rad) {
  const double period_rad = std::abs(turned_rad) * period.sigma_s / period.period_s;
  measured.noise_rad *= std::hypot(1.0, period_rad / measured.sigma_rad);
  measured.sigma_rad = measured.noise_rad.norm();
  return measured;
}

/// Returns the first rejection among these edges.
std::optional<Rejection> rejection_of(const Revolution& revolution,
                                      std::initializer_list<PulseChannel> edges) {
  for (const PulseChannel channel : edges) {
    if (const auto& rejected_by = revolution.edge_rejections.at(index_of(channel))) {
      return rejected_by;
    }
  }
  return std::nullopt;
}

/// Returns the azimuth of a crossing's middle behind a sun slit's pulse, less that of the beam. The
/// revolution must have all three edges.
Measured azimuth_behind(PulseChannel slit, Side side, const Revolution& revolution,
                        const SpinConfig& config) {
  const TaiTime t_slit = *revolution.edge(slit);
  const double middle_rad =
      0.5 * (revolution.turned_rad(t_slit, *revolution.edge(kInChannels.at(index_of(side)))) +
             revolution.turned_rad(t_slit, *revolution.edge(kOutChannels.at(index_of(side)))));
  const double rate_rad_s = revolution.rate_rad_s(t_slit);
  EdgeNoise noise_rad = EdgeNoise::Zero();
  noise_rad(static_cast<Eigen::Index>(slit)) = -rate_rad_s * edge_sigma_s(config.noise, slit);
  for (const PulseChannel channel :
       {kInChannels.at(index_of(side)), kOutChannels.at(index_of(side))}) {
    noise_rad(static_cast<Eigen::Index>(channel)) =
        0.5 * rate_rad_s * edge_sigma_s(config.noise, channel);
  }
  return with_period_noise(
      measured_from(wrapped_rad(middle_rad - sensor_of(config, side)->azimuth_rad), noise_rad),
      revolution.period, middle_rad);
}

std::optional<EarthCrossing> crossing_of(const SpinConfig& config, const Revolution& revolution,
                                         Side side) {
  const PulseChannel in_channel = kInChannels.at(index_of(side));
  const PulseChannel out_channel = kOutChannels.at(index_of(side));
  const std::optional<TaiTime>& in = revolution.edge(in_channel);
  const std::optional<TaiTime>& out = revolution.edge(out_channel);
  if (!sensor_of(config, side) || !in || !out) {
    return std::nullopt;
  }
  const double chord_rad = revolution.turned_rad(*in, *out);
  if (!(chord_rad > 0.0 && chord_rad < kTurn_rad)) {
    return std::nullopt;
  }
  const double rate_rad_s = revolution.rate_rad_s(*in);
  EdgeNoise noise_rad = EdgeNoise::Zero();
  noise_rad(static_cast<Eigen::Index>(in_channel)) =
      -rate_rad_s * edge_sigma_s(config.noise, in_channel);
  noise_rad(static_cast<Eigen::Index>(out_channel)) =
      rate_rad_s * edge_sigma_s(config.noise, out_channel);
  EarthCrossing crossing{
      .t_in = *in, .t_out = *out, .chord = measured_from(chord_rad, noise_rad), .dihedral = {}};
  crossing.chord->rejected_by = rejection_of(revolution, {in_channel, out_channel});
  if (revolution.edge(Sun1)) {
    crossing.dihedral = azimuth_behind(Sun1, side, revolution, config);
    crossing.dihedral->rejected_by = rejection_of(revolution, {Sun1, in_channel, out_channel});
  }
  return crossing;
}

/// Returns the sensors with a usable crossing, or if there is none, those with any crossing.
std::vector<Side> sides_to_use(const RevolutionMeasurements& measured) {
  std::vector<Side> good;
  std::vector<Side> all;
  for (const Side side : kSides) {
    if (const auto& crossing = measured.crossing(side)) {
      all.push_back(side);
      if (!crossing->chord->rejected_by) {
        good.push_back(side);
      }
    }
  }
  return good.empty() ? all : good;
}

std::optional<Measured> mixed_azimuth_of(const SpinConfig& config, const Revolution& revolution,
                                         const RevolutionMeasurements& measured) {
  const std::vector<Side> sides = sides_to_use(measured);
  if (!revolution.edge(Sun2) || sides.empty()) {
    return std::nullopt;
  }
  std::vector<Measured> found;
  for (const Side side : sides) {
    found.push_back(azimuth_behind(Sun2, side, revolution, config));
    found.back().rejected_by = rejection_of(
        revolution, {Sun2, kInChannels.at(index_of(side)), kOutChannels.at(index_of(side))});
  }
  Measured mean = circular_mean(found.front(), found.back());
  mean.rejected_by = found.front().rejected_by;
  return mean;
}

/// Returns the member that holds a quantity; null if there is none.
template <class Measurements>
auto slot_of(Measurements& measured, SpinQuantity quantity) -> decltype(&measured.sun_angle) {
  if (quantity == SpinQuantity::SunAngle) {
    return &measured.sun_angle;
  }
  if (quantity == SpinQuantity::MixedAzimuth) {
    return &measured.mixed_azimuth;
  }
  for (const Side side : kSides) {
    auto& crossing = measured.crossings.at(index_of(side));
    if (crossing && quantity == kChords.at(index_of(side))) {
      return &crossing->chord;
    }
    if (crossing && quantity == kDihedrals.at(index_of(side))) {
      return &crossing->dihedral;
    }
  }
  return nullptr;
}

}  // namespace

Measured circular_mean(const Measured& one, const Measured& other) {
  return measured_from(
      wrapped_rad(one.value_rad + 0.5 * wrapped_rad(other.value_rad - one.value_rad)),
      0.5 * (one.noise_rad + other.noise_rad));
}

std::optional<Measured> sun_angle(const SunSensor& sensor, double delay_s, double rate_rad_s,
                                  double sun_pulse_sigma_s) {
  const double lag_rad = wrapped_rad(rate_rad_s * delay_s - sensor.slit_separation_rad);
  if (!(std::abs(lag_rad) < kQuarter_rad)) {
    return std::nullopt;
  }
  const double tan_cant = std::tan(sensor.slit_cant_rad);
  const double sin_lag = std::sin(lag_rad);
  // d(theta_s)/d(lag) = -tan I cos(lag) / (tan^2 I + sin^2(lag)).
  const double slope = -tan_cant * std::cos(lag_rad) / (tan_cant * tan_cant + sin_lag * sin_lag);
  EdgeNoise noise_rad = EdgeNoise::Zero();
  noise_rad(static_cast<Eigen::Index>(Sun1)) = -slope * rate_rad_s * sun_pulse_sigma_s;
  noise_rad(static_cast<Eigen::Index>(Sun2)) = slope * rate_rad_s * sun_pulse_sigma_s;
  return measured_from(std::atan2(tan_cant, sin_lag), noise_rad);
}

std::optional<Measured> value_of(const RevolutionMeasurements& measured, SpinQuantity quantity) {
  const std::optional<Measured>* const slot = slot_of(measured, quantity);
  return slot != nullptr ? *slot : std::nullopt;
}

std::optional<Measured> good_value_of(const RevolutionMeasurements& measured,
                                      SpinQuantity quantity) {
  const std::optional<Measured> found = value_of(measured, quantity);
  return found && !found->rejected_by ? found : std::nullopt;
}

void reject(RevolutionMeasurements& measured, SpinQuantity quantity, Rejection why) {
  std::optional<Measured>* const slot = slot_of(measured, quantity);
  if (slot != nullptr && *slot && !(*slot)->rejected_by) {
    (*slot)->rejected_by = why;
  }
}

void judge(RevolutionMeasurements& measured, SpinQuantity quantity, const Observation& said) {
  std::optional<Measured>* const slot = slot_of(measured, quantity);
  if (slot != nullptr && *slot) {
    (*slot)->said = said;
  }
  if (said.rejected_by) {
    reject(measured, quantity, *said.rejected_by);
  }
}

RevolutionMeasurements measure(const SpinConfig& config, const Revolution& revolution) {
  RevolutionMeasurements measured{.noise = config.noise,
                                  .t_sun1 = revolution.good_edge(Sun1),
                                  .sun_angle = {},
                                  .mixed_azimuth = {},
                                  .crossings = {},
                                  .silent = {}};
  const std::optional<TaiTime>& sun1 = revolution.edge(Sun1);
  const std::optional<TaiTime>& sun2 = revolution.edge(Sun2);
  if (sun1 && sun2) {
    measured.sun_angle = sun_angle(config.sun_sensor, seconds_between(*sun1, *sun2),
                                   revolution.rate_rad_s(*sun1 + (*sun2 - *sun1) / 2),
                                   edge_sigma_s(config.noise, Sun1));
    if (measured.sun_angle) {
      measured.sun_angle->rejected_by = rejection_of(revolution, {Sun1, Sun2});
    }
  }
  for (const Side side : kSides) {
    measured.crossings.at(index_of(side)) = crossing_of(config, revolution, side);
    measured.silent.at(index_of(side)) = !revolution.edge(kInChannels.at(index_of(side))) &&
                                         !revolution.edge(kOutChannels.at(index_of(side)));
  }
  if (!measured.t_sun1) {
    measured.mixed_azimuth = mixed_azimuth_of(config, revolution, measured);
  }
  return measured;
}

}  // namespace spindrift
