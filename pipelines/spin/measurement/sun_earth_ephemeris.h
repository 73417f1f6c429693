/// @file
/// Directions of Sun and Earth from the spacecraft, at the times that the pipeline asks for.

#pragma once

#include "pipelines/core/expected.h"
#include "pipelines/ephemeris/orbit.h"
#include "pipelines/ephemeris/sun.h"
#include "pipelines/spin/measurement/measurement.h"
#include "pipelines/spin/types/sky.h"
#include "pipelines/time/tai_time.h"

namespace spindrift {

class SunEarthEphemeris {
 public:
  SunEarthEphemeris(Orbit orbit, double co2_altitude_km)
      : orbit_{std::move(orbit)}, co2_altitude_km_{co2_altitude_km} {}

  /// Returns the directions for one revolution: the Sun at sun1, the Earth half way between the
  /// chords; without sun1 or chords, at `t`.
  /// @return NoCoverage where the orbit does not reach; Unobservable below the horizon's height.
  Expected<SunEarthDirections> sun_earth(const RevolutionMeasurements& measured, TaiTime t);

  /// @return NoCoverage where the orbit does not reach.
  Expected<Sky> sky(TaiTime t);

 private:
  Orbit orbit_;
  ApparentSun sun_;
  double co2_altitude_km_;
};

}  // namespace spindrift
