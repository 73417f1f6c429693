/// @file
/// Start of the spin clock, from the first edges most of which are whole periods apart.

#pragma once

#include <optional>
#include <span>
#include <vector>

#include "pipelines/spin/association/period_search.h"
#include "pipelines/spin/association/spin_clock.h"
#include "pipelines/spin/types/config.h"
#include "pipelines/spin/types/pulse.h"

namespace spindrift {

/// Returns the phase defined for a channel that sets the clock without sun1: the slit separation
/// for sun2; half a turn for infrared channels, so that the others lie within half a turn of it.
double defined_phase_turns(const SpinConfig& config, PulseChannel channel);

struct ClockStart {
  PulseChannel reference;  ///< The channel that sets the clock.
  SpinClock clock;         ///< Clock whose turn 0 is that of the first edge.
};

/// The spin period that a spacecraft states in coded telemetry.
struct PeriodNote {
  TaiTime t_sun1;
  double period_s;
};

/// Returns the clock setting of a comb, with phase 0 on its first tooth. The edges are still to be
/// followed one by one, so the sigmas cover what a drift may hide in their scatter.
SpinClock::Setting setting_of(const PulseTrain& comb, double noise_s);

/// Tells whether two periods differ as if one channel had half of its edges, or twice as many.
bool is_another_period(double one_s, double other_s);

/// What the edges of the other channels say of the period found on one channel.
struct OtherChannels {
  bool are_heard = false;              ///< Whether any channel gave enough edges to tell.
  std::vector<double> periods_s = {};  ///< Periods of the channels with even trains.
};
OtherChannels other_channels(const SpinConfig& config, std::span<const Pulse> pulses,
                             PulseChannel channel, double period_s);

/// Starts the clock by sun1, or by another channel (sun2 before an infrared one) once that has
/// given twenty edges while sun1 is silent or outvoted.
/// @param waiting Edges in order of time.
/// @param at_end No more edges will come, so that three are enough.
std::optional<ClockStart> start_clock(const SpinConfig& config, std::span<const Pulse> waiting,
                                      bool at_end);

/// Starts the clock by the spacecraft's notes: three that agree, or any at the end.
std::optional<ClockStart> start_clock(const SpinConfig& config, std::span<const PeriodNote> notes,
                                      bool at_end);

/// Returns one sigma of the error of a period taken from this channel, s: Earth edges carry the
/// apparent motion of the Earth, unknown to association and taken to be as large as in a low orbit.
double apparent_motion_s(PulseChannel channel, double period_s);

}  // namespace spindrift
