/// @file
/// Where each channel's edge is expected behind sun1, learnt from the edges themselves and followed
/// as the Earth moves.

#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <span>

#include "pipelines/spin/association/robust_line.h"
#include "pipelines/spin/types/config.h"
#include "pipelines/spin/types/pulse.h"
#include "pipelines/statistics/drift_filter.h"

namespace spindrift {

/// The Earth's apparent motion: from the lowest orbits it turns by so much, and about an axis far
/// from the orbit's pole faster.
inline constexpr double kEarthMotion_rad_s = 1.2e-3;
/// Edges so far beyond the interference window are biased by an eightieth of their noise: those
/// that came nearer are missing from them.
inline constexpr double kInterferenceSigmas = 2.5;
/// How far from its expectation an edge may lie to be counted with a turn. The Sun stands still, a
/// chord changes as the beam nears the limb.
constexpr double gate_turns(PulseChannel channel) {
  return channel == PulseChannel::Sun1 ? 0.1 : 0.2;
}
/// One sigma of the acceleration of a chord's edge from a low orbit, turns a second squared: near
/// the limb it is several times that of the nadir.
inline constexpr double kEarthAcceleration_per_s2 = 1e-6;
/// By how much the drift of a channel's phase wanders in a turn: the Earth of a low orbit turns
/// its apparent motion by as much as n^2.
double earth_wander_turns(PulseChannel channel, double period_s);

/// One tracker for each channel. Phases are in turns behind phase 0 of the spin clock.
class ExpectedPhases {
 public:
  explicit ExpectedPhases(const SpinConfig& config);

  /// The spin period in force: noise is stated in seconds.
  void set_period(double period_s) { period_s_ = period_s; }

  /// The channel that sets the clock: what moves it seems to move the others.
  void set_reference(PulseChannel channel) { reference_ = channel; }

  /// Places a channel by definition.
  void define(PulseChannel channel, std::int64_t turn, double phase_turns);
  bool knows(PulseChannel channel) const { return of(channel).known; }
  /// Of a channel that is known.
  double at(PulseChannel channel, double turn) const { return of(channel).phase->at(turn); }
  double drift(PulseChannel channel) const { return of(channel).phase->change(); }
  /// One sigma each.
  double phase_sigma(PulseChannel channel, double turn) const;
  double drift_sigma(PulseChannel channel, double turn) const;

  /// Learns a channel from what most of its edges agree on, where they do in so many turns: one
  /// edge alone may be a stray of a channel that is silent. Of a channel with edges at two places
  /// of a turn nothing is learnt, unless the Sun can be at one of them only.
  /// @param counts Phases of edges, with the turns counted by the spin clock; at least one.
  /// @param clock_sigma_turns One sigma of the count of the last, which they have in common.
  /// @return Whether they do.
  bool learn(PulseChannel channel, std::span<const double> counts, std::size_t fewest_turns,
             double clock_sigma_turns);

  /// @return Whether an edge of a known channel lies where it should.
  bool accepts(PulseChannel channel, std::int64_t turn, double phase_turns,
               double clock_sigma_turns) const;

  /// The same; if so it is followed.
  bool follow(PulseChannel channel, std::int64_t turn, double phase_turns,
              double clock_sigma_turns);

  /// An edge that is not where it should be, or of a channel that is not known. @return Whether it
  /// and those shortly before it agree on a place, which is then expected.
  /// @param displaced_turns Standard deviation of what interference may have moved it by.
  bool stray(PulseChannel channel, double count, double displaced_turns, double clock_sigma_turns);

  /// A revolution is over. Channels that have been silent for many are forgotten: that the next
  /// edge lies near enough to so old a place says little.
  void end_revolution();

  /// Whether the edges of two channels are expected so near to each other that some of them meet.
  bool interfere(PulseChannel one, PulseChannel other, double turn, double clock_sigma_turns) const;

  /// How many edges in a row were where they should be.
  int in_a_row(PulseChannel channel) const { return of(channel).in_a_row; }

  /// Puts the clock's phase 0 later by so much.
  void shift(std::int64_t turn, double phase_turns, double drift);
  /// A chord that has drifted round belongs to the next turn.
  void keep_chords_near();
  void forget_strays();

  /// The latest phase that any channel is expected at on that turn.
  double latest(double turn) const;

 private:
  struct Stray {
    double count;
    int revolution;  ///< At its arrival.
  };
  struct Channel {
    bool known = false;
    std::optional<DriftFilter> phase;  ///< Where it was last, once it is forgotten.
    std::deque<Stray> strays;  ///< Since the last edge that was where it should be, by their count.
    std::size_t accepted = 0;
    int in_a_row = 0;
    int last_seen = 0;  ///< The revolution in which one was where it should be.
  };
  const Channel& of(PulseChannel channel) const { return channels_.at(index_of(channel)); }
  Channel& of(PulseChannel channel) { return channels_.at(index_of(channel)); }
  /// Where most of the edges lie, in so many turns.
  std::optional<RobustLine> place_of(PulseChannel channel, std::span<const double> counts,
                                     std::size_t fewest_turns) const;
  bool strays_have_another_place(PulseChannel channel, double count, RobustLine line) const;
  /// One slit tells on which side of the body the Sun passes the other.
  bool can_be_at(PulseChannel channel, double count) const;
  double unwrapped(PulseChannel channel, double phase_turns, double turn) const;
  DriftNoise drift_noise(PulseChannel channel, double clock_sigma_turns) const;
  double noise_turns(PulseChannel channel) const;
  double sigma_turns(PulseChannel channel, double turn, double clock_sigma_turns) const;
  double most_drift(PulseChannel channel) const;
  double wander(PulseChannel channel) const;

  PulseNoise noise_;
  double gate_sigma_;
  double interference_s_;
  double slit_separation_turns_;
  double period_s_ = 1.0;
  PulseChannel reference_ = PulseChannel::Sun1;
  int revolution_ = 0;  ///< Of those that had edges.
  std::array<Channel, kPulseChannels> channels_;
};

}  // namespace spindrift
