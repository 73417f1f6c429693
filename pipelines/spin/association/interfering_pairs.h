/// @file
/// Pairs of channels expected to interfere, revolution by revolution: their edges come so near to
/// each other that they spoil each other.

#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "pipelines/spin/association/expected_phases.h"
#include "pipelines/spin/types/pulse.h"
#include "pipelines/time/tai_time.h"

namespace spindrift {

/// Two channels that come so near to each other that their edges spoil each other.
struct InterferingChannels {
  PulseChannel one;
  PulseChannel other;
  TaiTime first;  ///< Start of the first revolution in which they do.
  TaiTime last;
  std::int64_t revolutions = 0;
};

/// Fewest revolutions to report a pair: fewer may come from a phase learnt from a wrong edge.
inline constexpr std::int64_t kFewestInterfering = 3;

class InterferingPairs {
 public:
  /// @param window_s Edges nearer to each other than this spoil each other; 0: none do.
  explicit InterferingPairs(double window_s) : window_s_{window_s} {}

  /// Finds the pairs expected to interfere in the revolution that closes.
  /// @param t Start of that revolution.
  /// @return Pairs that have now interfered in `kFewestInterfering` revolutions.
  std::vector<InterferingChannels> expect(const ExpectedPhases& phases, double turn,
                                          double clock_sigma_turns, TaiTime t);

  /// Returns the expected gap to a channel that interferes in the revolution that closes; empty
  /// when none does.
  const std::optional<EdgeGap>& gap_of(PulseChannel channel) const {
    return gaps_.at(index_of(channel));
  }

  /// Returns the pairs so far in the pass.
  const std::vector<InterferingChannels>& interfering() const { return interfering_; }

  /// Returns one standard deviation of the displacement of an edge by interference, which is up to
  /// half the window either way.
  double displacement_s() const;

 private:
  const InterferingChannels& record(PulseChannel one, PulseChannel other, TaiTime t);

  double window_s_;
  std::array<std::optional<EdgeGap>, kPulseChannels> gaps_;
  std::vector<InterferingChannels> interfering_;
};

}  // namespace spindrift
