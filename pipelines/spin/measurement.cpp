#include "pipelines/spin/measurement.h"

#include <cmath>
#include <numbers>

#include "pipelines/frames/celestial.h"

namespace spindrift {
namespace {

std::optional<EarthCrossing> crossing_of(const SpinConfig& config, const Revolution& revolution,
                                         Side side, double rate_rad_s) {
  const std::optional<InfraredSensor>& sensor = sensor_of(config, side);
  const std::optional<TaiTime>& in = revolution.edge(kInChannels.at(index_of(side)));
  const std::optional<TaiTime>& out = revolution.edge(kOutChannels.at(index_of(side)));
  if (!sensor || !in || !out) {
    return std::nullopt;
  }
  const double width_s = seconds_between(*in, *out);
  const double chord_rad = rate_rad_s * width_s;
  if (!(chord_rad > 0.0 && chord_rad < std::numbers::pi)) {
    return std::nullopt;
  }
  const double infrared_s = config.noise.infrared_s;
  EarthCrossing crossing{
      .t_mid = *in + (*out - *in) / 2,
      .chord = Measured{.value_rad = chord_rad,
                        .sigma_rad = rate_rad_s * std::numbers::sqrt2 * infrared_s},
      .dihedral = {}};
  if (const std::optional<TaiTime>& sun1 = revolution.edge(PulseChannel::Sun1)) {
    const double delay_s = seconds_between(*sun1, *in) + 0.5 * width_s;
    crossing.dihedral = Measured{
        .value_rad = wrapped_rad(rate_rad_s * delay_s - sensor->azimuth_rad),
        .sigma_rad = rate_rad_s * std::hypot(config.noise.sun_s, infrared_s / std::numbers::sqrt2)};
  }
  return crossing;
}

}  // namespace

const std::optional<InfraredSensor>& sensor_of(const SpinConfig& config, Side side) {
  return side == Side::North ? config.north : config.south;
}

std::optional<Measured> sun_angle(const SunSensor& sensor, double delay_s, double rate_rad_s,
                                  double sun_pulse_sigma_s) {
  const double lag_rad = wrapped_rad(rate_rad_s * delay_s - sensor.slit_separation_rad);
  if (!(std::abs(lag_rad) < 0.5 * std::numbers::pi)) {
    return std::nullopt;
  }
  const double tan_cant = std::tan(sensor.slit_cant_rad);
  const double sin_lag = std::sin(lag_rad);
  // d(theta_s)/d(lag) = -tan I cos(lag) / (tan^2 I + sin^2(lag)).
  const double slope = tan_cant * std::cos(lag_rad) / (tan_cant * tan_cant + sin_lag * sin_lag);
  return Measured{.value_rad = std::atan2(tan_cant, sin_lag),
                  .sigma_rad = slope * rate_rad_s * std::numbers::sqrt2 * sun_pulse_sigma_s};
}

std::optional<Measured> value_of(const RevolutionMeasurements& measured, SpinQuantity quantity) {
  if (quantity == SpinQuantity::SunAngle) {
    return measured.sun_angle;
  }
  for (const Side side : kSides) {
    if (const auto& crossing = measured.crossing(side)) {
      if (quantity == kChords.at(index_of(side))) {
        return crossing->chord;
      }
      if (quantity == kDihedrals.at(index_of(side))) {
        return crossing->dihedral;
      }
    }
  }
  return std::nullopt;
}

void remove(RevolutionMeasurements& measured, SpinQuantity quantity) {
  if (quantity == SpinQuantity::SunAngle) {
    measured.sun_angle.reset();
  }
  for (const Side side : kSides) {
    if (auto& crossing = measured.crossings.at(index_of(side))) {
      if (quantity == kChords.at(index_of(side))) {
        crossing->chord.reset();
      }
      if (quantity == kDihedrals.at(index_of(side))) {
        crossing->dihedral.reset();
      }
    }
  }
}

RevolutionMeasurements measure(const SpinConfig& config, const Revolution& revolution) {
  const double rate_rad_s = 2.0 * std::numbers::pi / revolution.period.period_s;
  RevolutionMeasurements measured{
      .t_sun1 = revolution.edge(PulseChannel::Sun1), .sun_angle = {}, .crossings = {}};
  const std::optional<TaiTime>& sun2 = revolution.edge(PulseChannel::Sun2);
  if (measured.t_sun1 && sun2) {
    measured.sun_angle = sun_angle(config.sun_sensor, seconds_between(*measured.t_sun1, *sun2),
                                   rate_rad_s, config.noise.sun_s);
  }
  for (const Side side : kSides) {
    measured.crossings.at(index_of(side)) = crossing_of(config, revolution, side, rate_rad_s);
  }
  return measured;
}

}  // namespace spindrift
