/// @file
/// The good measurements of one revolution with their error sources, as input for solving the axis.

#pragma once

#include <array>
#include <optional>

#include "pipelines/spin/measurement/beam_view.h"
#include "pipelines/spin/measurement/measurement.h"
#include "pipelines/spin/measurement/uncertain.h"
#include "pipelines/spin/sensor_model/geometry.h"
#include "pipelines/spin/types/config.h"
#include "pipelines/spin/types/sky.h"

namespace spindrift {

/// Holds references to the objects that it was made from.
struct FixInput {
  const SpinConfig& config;
  const RevolutionMeasurements& measured;
  const SunEarthDirections& sun_earth;
  BeamViews beams;  ///< Views that correct azimuths.
  double sun_earth_rad;
  std::optional<Uncertain> sun_angle;
  std::optional<Uncertain> dihedral;  ///< Mean of north and south if both exist.
  std::optional<Uncertain> mixed_azimuth;
  std::array<std::optional<ChordOf<Uncertain>>, 2> chords;

  const std::optional<ChordOf<Uncertain>>& north() const { return chords[0]; }
  const std::optional<ChordOf<Uncertain>>& south() const { return chords[1]; }
  bool both_chords() const { return north() && south(); }
  const ChordOf<Uncertain>& lone_chord() const { return north() ? *north() : *south(); }
  /// Half-angle rho of the Earth's disc as the side's beam sees it.
  Uncertain disc_rad(Side side) const {
    return with_model_error(certain(beams.at(index_of(side)).disc_rad),
                            side == Side::North ? NorthLimb : SouthLimb);
  }
  Uncertain lone_disc_rad() const { return disc_rad(north() ? Side::North : Side::South); }
};

/// Beams whose mounting angles coincide count as one, the north beam.
FixInput fix_input(const SpinConfig& config, const RevolutionMeasurements& measured,
                   const SunEarthDirections& sun_earth, const BeamViews& beams);

}  // namespace spindrift
