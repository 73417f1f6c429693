#include "pipelines/spin/fix/fix_input.h"

#include "pipelines/frames/celestial.h"

namespace spindrift {
namespace {

/// Adds the azimuth errors of the beams to an azimuth that is their mean.
Uncertain with_azimuth_errors(Uncertain value, bool north, bool south) {
  const double share = north && south ? 0.5 : 1.0;
  value.derivatives()(kEdges + NorthAzimuth) += north ? share : 0.0;
  value.derivatives()(kEdges + SouthAzimuth) += south ? share : 0.0;
  return value;
}

/// Converts the azimuth of a chord's middle to that of the Earth's centre.
Uncertain of_centre(const Measured& azimuth, const BeamViews& beams) {
  return uncertain(azimuth) + lead_rad(beams, azimuth.noise_rad);
}

std::optional<Uncertain> dihedral_of(const RevolutionMeasurements& measured,
                                     const BeamViews& beams) {
  const auto north = good_value_of(measured, SpinQuantity::NorthDihedral);
  const auto south = good_value_of(measured, SpinQuantity::SouthDihedral);
  if (!north && !south) {
    return std::nullopt;
  }
  const Measured mean = north && south ? circular_mean(*north, *south) : (north ? *north : *south);
  return with_azimuth_errors(of_centre(mean, beams), north.has_value(), south.has_value());
}

}  // namespace

FixInput fix_input(const SpinConfig& config, const RevolutionMeasurements& measured,
                   const SunEarthDirections& sun_earth, const BeamViews& beams) {
  FixInput input{.config = config,
                 .measured = measured,
                 .sun_earth = sun_earth,
                 .beams = beams,
                 .sun_earth_rad = angle_between_rad(sun_earth.sun_icrf, sun_earth.earth_icrf),
                 .sun_angle = {},
                 .dihedral = dihedral_of(measured, beams),
                 .mixed_azimuth = {},
                 .chords = {}};
  if (const auto sun = good_value_of(measured, SpinQuantity::SunAngle)) {
    input.sun_angle = with_model_error(uncertain(*sun), SunAngleError);
  }
  if (const auto mixed = good_value_of(measured, SpinQuantity::MixedAzimuth)) {
    const auto takes_part = [&](Side side) {
      return good_value_of(measured, kChords.at(index_of(side))).has_value();
    };
    input.mixed_azimuth = with_azimuth_errors(of_centre(*mixed, beams), takes_part(Side::North),
                                              takes_part(Side::South));
  }
  for (const Side side : kSides) {
    const auto chord = good_value_of(measured, kChords.at(index_of(side)));
    const auto& sensor = sensor_of(config, side);
    if (chord && sensor) {
      input.chords.at(index_of(side)) = ChordOf<Uncertain>{
          .mount_angle_rad = sensor->mount_angle_rad, .chord_rad = uncertain(*chord)};
    }
  }
  if (input.both_chords() &&
      mount_angles_coincide(input.north()->mount_angle_rad, input.south()->mount_angle_rad)) {
    input.chords[1].reset();
  }
  return input;
}

}  // namespace spindrift
