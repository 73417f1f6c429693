/// @file
/// Where the spin clock begins: with the first edges of which most are whole periods apart.

#pragma once

#include <optional>
#include <span>
#include <vector>

#include "pipelines/spin/association/period_search.h"
#include "pipelines/spin/association/spin_clock.h"
#include "pipelines/spin/types/config.h"
#include "pipelines/spin/types/pulse.h"

namespace spindrift {

/// The phase of the edges of a channel that sets the clock where there is no sun1: sun2 at the slit
/// separation, an infrared one half way round, so that the others lie within half a turn of it.
double defined_phase_turns(const SpinConfig& config, PulseChannel channel);

struct ClockStart {
  PulseChannel reference;  ///< The channel that sets the clock.
  SpinClock clock;         ///< Phase 0 belongs to the first of its edges.
};

/// What a spacecraft says of its own period.
struct PeriodNote {
  TaiTime t_sun1;
  double period_s;
};

/// By a comb, with phase 0 on its first tooth. Its edges are still to be followed one by one, so
/// that the setting is left uncertain by what a drift may hide in their scatter.
SpinClock::Setting setting_of(const PulseTrain& comb, double noise_s);

/// Channels differ by so much only where one of them has half of its edges, or twice as many.
bool is_another_period(double one_s, double other_s);

/// What the edges of the channels but one say of the period that this one has.
struct OtherChannels {
  bool are_heard = false;              ///< Any gave enough edges to tell.
  std::vector<double> periods_s = {};  ///< Of those that are even trains.
};
OtherChannels other_channels(const SpinConfig& config, std::span<const Pulse> pulses,
                             PulseChannel channel, double period_s);

/// By sun1; by another channel, sun2 rather than an infrared one, only when that has gone on for
/// twenty edges without sun1, or with one that is outvoted.
/// @param waiting In order of time.
/// @param at_end Nothing more will come: three edges must do.
std::optional<ClockStart> start_clock(const SpinConfig& config, std::span<const Pulse> waiting,
                                      bool at_end);

/// By the notes: three that agree, at the end any.
std::optional<ClockStart> start_clock(const SpinConfig& config, std::span<const PeriodNote> notes,
                                      bool at_end);

/// Of a period taken from edges of this channel: an Earth-derived one carries the apparent motion
/// of the Earth, which association does not know, as large as in a low orbit.
double apparent_motion_s(PulseChannel channel, double period_s);

}  // namespace spindrift
