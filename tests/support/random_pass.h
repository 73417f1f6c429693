/// @file
/// Passes drawn at random over the range of possible missions: orbit, Sun and axis directions,
/// sensor mounting, spin rate and dead channels.

#pragma once

#include <random>
#include <string>
#include <vector>

#include "pipelines/ephemeris/orbit.h"
#include "pipelines/spin/types/pulse.h"
#include "tests/support/spinning_body.h"

namespace spindrift::testing {

struct RandomPass {
  std::string name;  ///< Readable summary of what was drawn.
  Orbit orbit;
  SunEarthEphemeris around;  ///< Sun and Earth; time is counted from `kTransferStart`.
  SpinningBody body;
  std::vector<PulseChannel> dead;

  /// Returns the received pulses of this many revolutions, with the mission's noise.
  std::vector<Pulse> pulses(double revolutions, std::mt19937_64& rng) const;
};

/// Draws a pass at 5 to 200 rpm in which both slits see the Sun and a working beam crosses the
/// Earth in chords of 8 to 160 deg, far enough from the limb that noise cannot make them vanish.
/// The horizon is a sphere or an ellipsoid. Available are all channels, one infrared sensor only,
/// or all but sun2 or sun1.
RandomPass random_pass(std::mt19937_64& rng);

/// Draws such a pass with any geometry in which the Earth enters or leaves the view of a beam
/// within the first 300 revolutions.
RandomPass pass_across_the_limb(std::mt19937_64& rng);

}  // namespace spindrift::testing
