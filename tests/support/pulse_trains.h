/// @file
/// Passes with doubled or halved pulse trains, as from several receivers, from a channel that loses
/// every other edge, or from a sensor that sees something twice.

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
  double jitter_s = 0.0;  ///< Standard deviation of the copy's own timing noise, s.
  std::set<PulseChannel> channels = kEveryChannel;
  double from_share = 0.0;  ///< Share of the pass's edges after which the copy starts.
  double to_share = 1.0;
};

/// Returns the edges together with a copy of the given channels, in order of time.
std::vector<Pulse> copied(const std::vector<Pulse>& pulses, const Copying& copying,
                          std::mt19937_64& rng);

/// Returns the pulses without every other edge of a channel.
std::vector<Pulse> halved(std::vector<Pulse> pulses, PulseChannel channel);

struct PulseTrains {
  std::string name;
  std::function<std::vector<Pulse>(const std::vector<Pulse>& pulses, double period_s,
                                   std::mt19937_64& rng)>
      of;
};

/// Returns trains with a copy of all edges 1 ns to 20 ms later, without every other sun1, and with
/// a second sun1 half a turn later.
std::vector<PulseTrains> plain_trains();
/// Returns trains with jittering copies, with copies of some channels or of a part of the pass, and
/// with copies among other disturbances.
std::vector<PulseTrains> mixed_trains();

/// Runs random bodies at 40, 60, 75 and 100 rpm for 200 revolutions each and expects that no OK row
/// is more than five of its sigmas off. Plain trains must also yield an OK or DOUBTFUL axis within
/// five of its sigmas.
void expect_the_axis_of(const std::vector<PulseTrains>& all_trains, bool are_plain, int first_seed,
                        int seeds);

}  // namespace spindrift::testing
