/// @file
/// Channels of a spinner that should give edges and do not.

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

/// The axis in force.
struct AxisSeen {
  Eigen::Vector3d axis_icrf;  ///< Unit.
  double sigma_rad;
};

/// A channel is silent that gives no edge for so many of another one, while the axis in force has
/// it cross the Earth's disc or see the Sun with a degree and three sigma to spare. Of a beam that
/// the mission does not call healthy so many edges must have come, by either of its channels. Where
/// the link is silent no other channel counts.
class ChannelPresence {
 public:
  ChannelPresence(SpinConfig config, Orbit orbit, int silent_revolutions);

  ConditionChanges see(const Pulse& edge, const std::optional<AxisSeen>& axis);

 private:
  bool is_silent(PulseChannel channel, TaiTime t, const AxisSeen& axis);
  bool is_in_view(PulseChannel channel, TaiTime t, const AxisSeen& axis) const;
  bool works(PulseChannel channel) const;
  double missed(PulseChannel channel) const;

  struct Channel {
    ConditionWatch watch;
    int edges = 0;
    bool was_in_view = false;  ///< At its last edge, or when it was last looked for in vain.
    std::array<int, kPulseChannels> of_others = {};  ///< Edges since then.
  };
  SpinConfig config_;
  Orbit orbit_;
  double limit_;
  std::vector<Channel> channels_;  ///< By channel.
};

}  // namespace spindrift
