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

/// A channel is silent that has given edges, and none for so many of another one, while the axis in
/// force has it cross the Earth's disc or see the Sun with a degree and three sigma to spare. Where
/// the link is silent no other channel counts.
class ChannelPresence {
 public:
  ChannelPresence(const SpinConfig& config, Orbit orbit, int silent_revolutions);

  ConditionChanges see(const Pulse& edge, const std::optional<AxisSeen>& axis);

 private:
  bool should_see(PulseChannel channel, TaiTime t, const AxisSeen& axis) const;
  double missed(PulseChannel channel) const;

  struct Channel {
    ConditionWatch watch;
    int edges = 0;
    std::array<int, kPulseChannels> of_others = {};  ///< Edges since its last one.
  };
  SpinConfig config_;
  Orbit orbit_;
  double limit_;
  std::vector<Channel> channels_;  ///< By channel.
};

}  // namespace spindrift
