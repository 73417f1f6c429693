/// @file
/// Passes drawn at random over all that a mission may be: where orbit, Sun and axis stand, how the
/// sensors are mounted, how fast the body turns, which channels are dead.

#pragma once

#include <random>
#include <string>
#include <vector>

#include "pipelines/ephemeris/orbit.h"
#include "pipelines/spin/types/pulse.h"
#include "tests/support/spinning_body.h"

namespace spindrift::testing {

struct RandomPass {
  std::string name;  ///< What was drawn, to be read.
  Orbit orbit;
  SunEarthEphemeris around;  ///< Time from `kTransferStart`.
  SpinningBody body;
  std::vector<PulseChannel> dead;

  /// What is received of so many revolutions, with the noise that the mission states.
  std::vector<Pulse> pulses(double revolutions, std::mt19937_64& rng) const;
};

/// 5 to 200 rpm; both slits see the Sun; a beam that works crosses the Earth in chords of 8 to
/// 160 deg, far enough from its limb that no noise makes them vanish. Sphere or ellipsoid. One of:
/// all channels, either infrared sensor alone, no sun2, no sun1.
RandomPass random_pass(std::mt19937_64& rng);

/// Likewise, of any geometry in which the Earth comes into a beam's sight, or leaves it, within the
/// first 300 revolutions.
RandomPass pass_across_the_limb(std::mt19937_64& rng);

}  // namespace spindrift::testing
