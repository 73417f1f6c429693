/// @file
/// Copies: a channel gives one leading edge a revolution. Where in most revolutions several lie
/// within a twentieth of a turn, several receivers heard the same one, or one rang.

#pragma once

#include <array>
#include <deque>
#include <optional>

#include "pipelines/spin/types/pulse.h"
#include "pipelines/time/tai_time.h"

namespace spindrift {

/// So near to each other edges of one channel are one.
inline constexpr double kCopies_turns = 0.05;

/// An edge that is left out as another one's copy.
struct CopiedEdge {
  Pulse pulse;
  double apart_s;  ///< From the edge that counts, either way.
};

/// What follows what, channel by channel; knows no phases, so that it holds for channels of which
/// nothing is known yet.
class Copies {
 public:
  /// @param pulse Later than the one before of its channel, or they are gone through anew.
  /// @return How far behind the first edge of its revolution it comes; empty: it is the first, or
  /// copies are not usual, so that one edge may be as good as the other.
  std::optional<double> behind_first_s(const Pulse& pulse, double period_s);

  /// Most of the channel's last revolutions brought several edges, and since then some still do; or
  /// those of most channels.
  bool are_usual(PulseChannel channel) const;

  /// Of two edges of a revolution the later counts, or the earlier.
  void note_choice(PulseChannel channel, bool later);
  /// The later of its edges count, of another channel the earlier: they are of two receivers, which
  /// do not agree on the time.
  bool disagree_with_others(PulseChannel channel) const;

  /// Likewise, and so far apart that it matters beside the noise of an edge which of them counts.
  /// One that comes alone may be either.
  bool are_apart(PulseChannel channel, double noise_s) const;

  /// The channel's edges come now in this order, now in that: the earliest is the one that noise
  /// made early, and all that rests on it is off by a part of the distance.
  bool are_in_any_order(PulseChannel channel, double noise_s) const;

 private:
  struct Channel {
    TaiTime first{};              ///< Of the last revolution.
    std::deque<bool> had_copies;  ///< The last revolutions.
    bool are_usual = false;
    std::deque<bool> later;       ///< The last choices.
    std::deque<double> behind_s;  ///< The first copies of the last revolutions with any.
  };
  /// Empty: nothing was chosen so far.
  std::optional<bool> is_later(PulseChannel channel) const;

  std::array<Channel, kPulseChannels> channels_;
};

}  // namespace spindrift
