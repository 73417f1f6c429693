#include "services/mission/mission_spin.h"

#include <fmt/format.h>

#include <array>
#include <cstdint>
#include <optional>
#include <string>

#include "pipelines/frames/celestial.h"
#include "services/mission/mission_alignment.h"
#include "services/mission/values.h"

namespace spindrift {
namespace {

std::optional<InfraredSensor> infrared_sensor(const TomlValues& values, const std::string& table) {
  if (!values.contains(table + ".mount_angle_deg")) {
    return std::nullopt;
  }
  return InfraredSensor{.mount_angle_rad = radians(values, table + ".mount_angle_deg"),
                        .azimuth_rad = radians(values, table + ".azimuth_deg"),
                        .healthy = value_of<bool>(values, table + ".healthy")};
}

std::optional<SpinPrior> prior(const TomlValues& values) {
  if (!values.contains("spin.prior.ra_deg")) {
    return std::nullopt;
  }
  return SpinPrior{.axis_icrf = direction_icrf({.ra_rad = radians(values, "spin.prior.ra_deg"),
                                                .dec_rad = radians(values, "spin.prior.dec_deg")}),
                   .sigma_rad = radians(values, "spin.prior.sigma_deg")};
}

std::string batch_key(SensorBias bias) { return fmt::format("spin.batch.{}", range_of(bias).name); }

SpinBatch batch(const TomlValues& values) {
  SpinBatch batch;
  for (int i = 0; i < kSensorBiases; ++i) {
    if (const auto estimated = value_if<bool>(values, batch_key(static_cast<SensorBias>(i)))) {
      batch.biases = batch.biases.value_or(BiasSet{}).set(static_cast<std::size_t>(i), *estimated);
    }
  }
  return batch;
}

/// Names the values of the mission file whose alignment says how far a bias may be off.
struct StatedBy {
  SensorBias bias;
  SpinAlignmentError first;
  SpinAlignmentError second;  ///< Equal to `first` where one value says it all.
};

constexpr std::array<StatedBy, 8> kStatedBy = {{
    {SunAngleBias, SlitCantError, SlitSeparationError},
    {SlitSeparationBias, SlitSeparationError, SlitSeparationError},
    {NorthChordBias, NorthAzimuthError, NorthAzimuthError},
    {SouthChordBias, SouthAzimuthError, SouthAzimuthError},
    {NorthMountAngleBias, NorthMountAngleError, NorthMountAngleError},
    {SouthMountAngleBias, SouthMountAngleError, SouthMountAngleError},
    {DihedralBias, NorthAzimuthError, SouthAzimuthError},
    {Co2HeightBias, Co2AltitudeError, Co2AltitudeError},
}};

HorizonModel horizon_model(const std::string& name) {
  return name == "sphere" ? HorizonModel::Sphere : HorizonModel::Ellipsoid;
}

}  // namespace

SpinConfig spin_config(const TomlValues& values) {
  return {
      .sun_sensor = {.slit_cant_rad = radians(values, "spin.sun_sensor.slit_cant_deg"),
                     .slit_separation_rad = radians(values, "spin.sun_sensor.slit_separation_deg")},
      .north = infrared_sensor(values, "spin.ir.north"),
      .south = infrared_sensor(values, "spin.ir.south"),
      .noise = {.sun_s = number(values, "spin.noise.sun_pulse_s"),
                .infrared_s = number(values, "spin.noise.ir_pulse_s")},
      .horizon = {.model = horizon_model(value_of<std::string>(values, "spin.horizon.model")),
                  .co2_altitude_km = number(values, "spin.horizon.co2_altitude_km")},
      .screening = {.window =
                        static_cast<int>(value_of<std::int64_t>(values, "spin.screening.window")),
                    .sigma = number(values, "spin.screening.sigma"),
                    .interference_s = number(values, "spin.screening.interference_s")},
      .geometry = {.determinant_usable = number(values, "spin.geometry.determinant_usable"),
                   .determinant_ambiguous = number(values, "spin.geometry.determinant_ambiguous")},
      .prior = prior(values),
      .batch = batch(values),
      .alignment = spin_alignment(values)};
}

void check_estimated_biases(TomlDocument& document) {
  const SpinAlignment alignment = spin_alignment(document.values);
  const BiasSet estimated = batch(document.values).biases.value_or(BiasSet{});
  for (const auto& [bias, first, second] : kStatedBy) {
    if (estimated[bias] && alignment(first, first) + alignment(second, second) == 0.0) {
      const std::string key = batch_key(bias);
      add_problem(document, key,
                  fmt::format("{} = true: by the alignment {} is known exactly; state how far it "
                              "may be off in [spin.alignment], or leave the bias out",
                              key, kSpinAlignmentKeys.at(first)));
    }
  }
}

}  // namespace spindrift
