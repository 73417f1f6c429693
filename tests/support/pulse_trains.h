/// @file
/// Passes whose pulse trains are doubled or halved: several receivers, edges that are lost one by
/// one, sensors that see something twice.

#pragma once

#include <functional>
#include <random>
#include <set>
#include <string>
#include <vector>

#include "pipelines/spin/types/pulse.h"

namespace spindrift::testing {

inline const std::set<PulseChannel> kEveryChannel = {PulseChannel::Sun1,    PulseChannel::Sun2,
                                                     PulseChannel::NorthIn, PulseChannel::NorthOut,
                                                     PulseChannel::SouthIn, PulseChannel::SouthOut};

struct Copying {
  double behind_s;
  double jitter_s = 0.0;  ///< Noise of the copy's own, one sigma.
  std::set<PulseChannel> channels = kEveryChannel;
  double from_share = 0.0;  ///< Of the pass's edges.
  double to_share = 1.0;
};

/// The edges and a copy of each of those channels, in order of time.
std::vector<Pulse> copied(const std::vector<Pulse>& pulses, const Copying& copying,
                          std::mt19937_64& rng);

/// Every other edge of a channel is lost.
std::vector<Pulse> halved(std::vector<Pulse> pulses, PulseChannel channel);

struct PulseTrains {
  std::string name;
  std::function<std::vector<Pulse>(const std::vector<Pulse>& pulses, double period_s,
                                   std::mt19937_64& rng)>
      of;
};

/// A copy of all, 1 ns to 20 ms behind; every other sun1 lost; a second sun1 half a turn later.
std::vector<PulseTrains> plain_trains();
/// Copies that jitter, of some channels, in a part of the pass, among other dirt.
std::vector<PulseTrains> mixed_trains();

/// Of random bodies at 40, 60, 75 and 100 rpm, 200 revolutions each: no row says OK beyond five of
/// its sigmas. Of plain trains there is an axis besides, OK or DOUBTFUL, within five of its sigmas.
void expect_the_axis_of(const std::vector<PulseTrains>& all_trains, bool are_plain, int first_seed,
                        int seeds);

}  // namespace spindrift::testing
