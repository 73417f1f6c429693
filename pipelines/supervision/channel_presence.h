/// @file
/// Detects channels of a spinner that should give edges and do not.
///
/// Silence is counted in edges of another channel, not in time, so that a silent link raises
/// nothing.

#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <span>
#include <vector>

#include "pipelines/ephemeris/orbit.h"
#include "pipelines/spin/types/config.h"
#include "pipelines/spin/types/pulse.h"
#include "pipelines/supervision/condition_watch.h"

namespace spindrift {

/// Holds a spin axis that may be true.
struct AxisSeen {
  Eigen::Vector3d axis_icrf;  ///< Unit vector.
  double sigma_rad;
};

/// Watches all channels. A channel is silent if it gives no edge during a number of edges of
/// another channel, be it from the start, while by every axis that may be true it should cross the
/// Earth's disc or see the Sun, with a margin of one degree and three sigma. Slit 1
/// should see the Sun, whatever the axis, where slit 2 does.
class ChannelPresence {
 public:
  ChannelPresence(SpinConfig config, Orbit orbit, int silent_revolutions);

  void set_silent_revolutions(int revolutions) { limit_ = revolutions; }

  ConditionChanges evaluate(const Pulse& edge, std::span<const AxisSeen> axes);
  /// Judges the last edges by the final answer, of a pass that may have had none before its end.
  ConditionChanges settle(const AxisSeen& axis);

 private:
  void report(PulseChannel channel, TaiTime t, ConditionChanges& changes);
  bool is_silent(PulseChannel channel, TaiTime t, std::span<const AxisSeen> axes);
  bool is_in_view(PulseChannel channel, TaiTime t, const AxisSeen& axis) const;
  double missed(PulseChannel channel) const;

  struct Channel {
    ConditionWatch watch;
    bool has_come = false;  ///< The count began with an edge of the channel.
    std::array<int, kPulseChannels> of_others = {};  ///< Edges of each other channel since then.
    /// When the count began, unless the channel was out of view then.
    std::optional<TaiTime> since = {};
  };
  SpinConfig config_;
  Orbit orbit_;
  double limit_;
  std::vector<Channel> channels_;  ///< Indexed by PulseChannel.
  std::optional<TaiTime> newest_ = {};
};

}  // namespace spindrift
