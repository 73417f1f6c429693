/// @file
/// Expected phase of each channel's edge behind sun1, learnt from edges and followed as the Earth
/// moves.

#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <span>

#include "pipelines/spin/association/robust_line.h"
#include "pipelines/spin/types/config.h"
#include "pipelines/spin/types/products.h"
#include "pipelines/spin/types/pulse.h"
#include "pipelines/statistics/drift_filter.h"

namespace spindrift {

/// The Earth's apparent angular rate from the lowest orbits; about an axis far from the orbit's
/// pole it is faster.
inline constexpr double kEarthMotion_rad_s = 1.2e-3;
/// Edges this many sigmas beyond the interference window are biased by an eightieth of their noise,
/// since those that came nearer are missing from their mean.
inline constexpr double kInterferenceSigmas = 2.5;
/// Returns how far from its expectation an edge may lie to count with a turn: the Sun stands still,
/// a chord changes as the beam nears the limb.
constexpr double gate_turns(PulseChannel channel) {
  return channel == PulseChannel::Sun1 ? 0.1 : 0.2;
}
/// One sigma of the acceleration of a chord's edge from a low orbit, turns a second squared: near
/// the limb it is several times that of the nadir.
inline constexpr double kEarthAcceleration_per_s2 = 1e-6;
/// Returns one sigma of the change of a channel's phase drift in one turn: from a low orbit, the
/// Earth's apparent motion changes by as much as n^2 (n: mean motion).
double earth_wander_turns(PulseChannel channel, double period_s);

/// Tracks the expected phase of each channel, in turns behind phase 0 of the spin clock.
class ExpectedPhases {
 public:
  explicit ExpectedPhases(const SpinConfig& config);

  /// Sets the spin period that converts noise from seconds to turns.
  void set_period(double period_s) { period_s_ = period_s; }

  /// Sets the channel that sets the clock: a motion of its edge shows as one of the others.
  void set_reference(PulseChannel channel) { reference_ = channel; }

  /// Sets the phase of a channel by definition, without learning it.
  void define(PulseChannel channel, std::int64_t turn, double phase_turns);
  bool knows(PulseChannel channel) const { return of(channel).known; }
  /// Returns the phase of a known channel, turns; `drift` is its change per turn.
  double at(PulseChannel channel, double turn) const { return of(channel).phase->at(turn); }
  double drift(PulseChannel channel) const { return of(channel).phase->change(); }
  /// Returns one sigma of the phase, turns; `drift_sigma` is that of its change per turn.
  double phase_sigma(PulseChannel channel, double turn) const;
  double drift_sigma(PulseChannel channel, double turn) const;

  /// Learns a channel from the place that most of its edges agree on, in at least `fewest_turns`
  /// turns: a single edge may be a stray of a silent channel. A channel with edges at two places of
  /// a turn is not learnt, unless the Sun can be at only one of them.
  /// @param counts Phases of edges, with the turns counted by the spin clock; at least one.
  /// @param clock_sigma_turns One sigma of the count at the last edge, common to all edges.
  /// @return Whether the channel is learnt.
  bool learn(PulseChannel channel, std::span<const double> counts, std::size_t fewest_turns,
             double clock_sigma_turns);

  /// Tests whether an edge of a known channel lies where it should.
  /// @return In turns.
  DriftTest test(PulseChannel channel, std::int64_t turn, double phase_turns,
                 double clock_sigma_turns) const;

  /// Does what `test` does, and follows an edge that passes.
  DriftTest follow(PulseChannel channel, std::int64_t turn, double phase_turns,
                   double clock_sigma_turns);

  /// Takes an edge that is not where it should be, or whose channel is not known.
  /// @param displaced_turns Standard deviation of its displacement by interference.
  /// @return Whether it and the strays shortly before it agree on a place, which is then expected.
  bool stray(PulseChannel channel, double count, double displaced_turns, double clock_sigma_turns);

  /// Ends a revolution. Channels silent for many revolutions are forgotten: an edge near so old a
  /// place says little.
  void end_revolution();

  /// Returns the expected gap between the edges of two channels, and the least in which none of
  /// them meet; empty when one of the channels is not known.
  std::optional<EdgeGap> gap(PulseChannel one, PulseChannel other, double turn,
                             double clock_sigma_turns) const;
  /// Returns one sigma of the next edge of a known channel, turns.
  double sigma_turns(PulseChannel channel, double turn, double clock_sigma_turns) const;

  /// How many edges in a row were where they should be.
  int in_a_row(PulseChannel channel) const { return of(channel).in_a_row; }

  /// Adapts the phases to a clock shifted as by SpinClock::shift.
  void shift(std::int64_t turn, double phase_turns, double drift);
  /// Moves a chord that has drifted round to the neighbouring turn.
  void keep_chords_near();
  void forget_strays();

  /// The latest phase that any channel is expected at on that turn.
  double latest(double turn) const;

 private:
  struct Stray {
    double count;
    int revolution;  ///< Revolution of its arrival.
  };
  struct Channel {
    bool known = false;
    std::optional<DriftFilter> phase;  ///< Kept as the last known phase once forgotten.
    std::deque<Stray> strays;          ///< Strays since the last accepted edge, by count.
    std::size_t accepted = 0;
    int in_a_row = 0;
    int last_seen = 0;  ///< Revolution of the last accepted edge.
  };
  const Channel& of(PulseChannel channel) const { return channels_.at(index_of(channel)); }
  Channel& of(PulseChannel channel) { return channels_.at(index_of(channel)); }
  /// Returns the line that most edges lie on; empty when that holds in too few turns.
  std::optional<RobustLine> place_of(PulseChannel channel, std::span<const double> counts,
                                     std::size_t fewest_turns) const;
  bool strays_have_another_place(PulseChannel channel, double count, RobustLine line) const;
  /// Tells whether a sun edge may be at `count`, given the side that the other slit sees the Sun
  /// on.
  bool can_be_at(PulseChannel channel, double count) const;
  double unwrapped(PulseChannel channel, double phase_turns, double turn) const;
  DriftNoise drift_noise(PulseChannel channel, double clock_sigma_turns) const;
  double noise_turns(PulseChannel channel) const;
  double most_drift(PulseChannel channel) const;
  double wander(PulseChannel channel) const;

  PulseNoise noise_;
  double gate_sigma_;
  double interference_s_;
  double slit_separation_turns_;
  double period_s_ = 1.0;
  PulseChannel reference_ = PulseChannel::Sun1;
  int revolution_ = 0;  ///< Number of revolutions with edges so far.
  std::array<Channel, kPulseChannels> channels_;
};

}  // namespace spindrift
