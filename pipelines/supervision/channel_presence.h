/// @file
/// Detects channels of a spinner that should give edges and do not.
///
/// Silence is counted in edges of another channel, not in time, so that a silent link raises
/// nothing.

#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <vector>

#include "pipelines/ephemeris/orbit.h"
#include "pipelines/spin/types/config.h"
#include "pipelines/spin/types/pulse.h"
#include "pipelines/supervision/condition_watch.h"

namespace spindrift {

/// Holds the spin axis of the answer in force.
struct AxisSeen {
  Eigen::Vector3d axis_icrf;  ///< Unit vector.
  double sigma_rad;
};

/// Watches all channels. A channel is silent if it gives no edge during a number of edges of
/// another channel, while by the axis in force it should cross the Earth's disc or see the Sun,
/// with a margin of one degree and three sigma. A beam not marked healthy in the mission file is
/// watched once that many edges of one of its channels have come.
class ChannelPresence {
 public:
  ChannelPresence(SpinConfig config, Orbit orbit, int silent_revolutions);

  void set_silent_revolutions(int revolutions) { limit_ = revolutions; }

  ConditionChanges evaluate(const Pulse& edge, const std::optional<AxisSeen>& axis);

 private:
  bool is_silent(PulseChannel channel, TaiTime t, const AxisSeen& axis);
  bool is_in_view(PulseChannel channel, TaiTime t, const AxisSeen& axis) const;
  bool works(PulseChannel channel) const;
  double missed(PulseChannel channel) const;

  struct Channel {
    ConditionWatch watch;
    int edges = 0;
    bool was_in_view = false;  ///< The channel was in view at its last edge or at the last check.
    std::array<int, kPulseChannels> of_others = {};  ///< Edges of each other channel since then.
  };
  SpinConfig config_;
  Orbit orbit_;
  double limit_;
  std::vector<Channel> channels_;  ///< Indexed by PulseChannel.
};

}  // namespace spindrift
