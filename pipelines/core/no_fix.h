/// @file
/// The reasons why a revolution gives no spin axis; services/base turns them into sentences.

#pragma once

#include "pipelines/core/assessment.h"

namespace spindrift {

/// The comments list the values that a code carries, then the locus of the axis where there is one.
enum class NoFixCode {
  BothChordsAlone,      ///< - ; cone about the Earth
  SunAngleAlone,        ///< - ; cone about the Sun
  OneChordAlone,        ///< - ; cones about the Earth
  NothingMeasured,      ///< -
  SunEarthInLine,       ///< sun_earth_deg
  ChordTooWide,         ///< chord_deg, disc_deg, mount_angle_deg
  NoEarthAngle,         ///< -
  OneChordContradicts,  ///< -
  ConesApart,           ///< sun_angle_deg, earth_angle_deg, sun_earth_deg
  NoSunAngle,           ///< -
  NoSunAngleOfSlit2,    ///< -
  LostInNoise,          ///< -
};
inline constexpr int kNoFixCodes = static_cast<int>(NoFixCode::LostInNoise) + 1;

using WhyNoFix = Coded<NoFixCode>;

}  // namespace spindrift
