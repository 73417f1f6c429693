/// @file
/// Recognition of copies: a channel gives one leading edge per revolution. Where most revolutions
/// bring several within a twentieth of a turn, several receivers heard it, or a receiver rang.

#pragma once

#include <array>
#include <deque>
#include <optional>

#include "pipelines/spin/types/pulse.h"
#include "pipelines/time/tai_time.h"

namespace spindrift {

/// Edges of one channel nearer to each other than this are copies of one edge.
inline constexpr double kCopies_turns = 0.05;

/// An edge that is left out as another one's copy.
struct CopiedEdge {
  Pulse pulse;
  double apart_s;  ///< Absolute time to the edge that counts.
};

/// Tracks, channel by channel, which edges follow each other. It uses no phases, so that it works
/// for channels of which nothing is known yet.
class Copies {
 public:
  /// @param pulse Later than the previous one of its channel, unless all are gone through anew.
  /// @return How far the pulse is behind the first edge of its revolution; empty when it is the
  /// first, or when copies are not usual, so that either edge may be the right one.
  std::optional<double> behind_first_s(const Pulse& pulse, double period_s);

  /// Tells whether most of the channel's last revolutions brought several edges and some still do,
  /// or whether that holds for most channels.
  bool are_usual(PulseChannel channel) const;

  /// Records whether the later or the earlier of two edges of a revolution counts.
  void note_choice(PulseChannel channel, bool later);
  /// Tells whether the later copy counts on this channel and the earlier one on another: they come
  /// from two receivers that do not agree on the time.
  bool disagree_with_others(PulseChannel channel) const;

  /// Tells whether copies are usual and lie so far apart, beside the noise of an edge, that it
  /// matters which of them counts. An edge that comes alone may then be any of them.
  bool are_apart(PulseChannel channel, double noise_s) const;

  /// Tells whether the channel's copies come in random order: the earliest is then the one that
  /// noise made early, and all that rests on it is off by a part of the distance.
  bool are_in_any_order(PulseChannel channel, double noise_s) const;

 private:
  struct Channel {
    TaiTime first{};              ///< First edge of the last revolution.
    std::deque<bool> had_copies;  ///< Whether each of the last revolutions had copies.
    bool are_usual = false;
    std::deque<bool> later;       ///< Whether the later copy counted, for the last choices.
    std::deque<double> behind_s;  ///< Delays of the first copies, in the last revolutions with any.
  };
  /// Tells whether the later copy counts; empty where copies are unusual or choices were few.
  std::optional<bool> is_later(PulseChannel channel) const;

  std::array<Channel, kPulseChannels> channels_;
};

}  // namespace spindrift
