/// @file
/// Why one revolution gives no spin axis. Codes with values; the sentences are made of them in
/// services/words.

#pragma once

#include "pipelines/core/assessment.h"

namespace spindrift {

enum class NoFixCode {
  BothChordsAlone,      ///< - , a cone about the Earth
  SunAngleAlone,        ///< - , a cone about the Sun
  OneChordAlone,        ///< - , cones about the Earth
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
