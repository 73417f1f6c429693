/// @file
/// Effects of noise, sensors and link on the true edges of a spinning spacecraft: lost, spoilt,
/// doubled and spurious edges, silences, and edges that spoil each other.

#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "pipelines/ground_model/link/silence.h"
#include "pipelines/ground_model/sensors/spin_edges.h"
#include "pipelines/spin/types/config.h"
#include "pipelines/spin/types/pulse.h"
#include "pipelines/time/tai_time.h"

namespace spindrift {

/// Fault probabilities, [0, 1], per edge; `spurious` per turn.
struct ChannelFaults {
  double lost = 0.0;
  double spoilt = 0.0;
  double doubled = 0.0;
  double spurious = 0.0;
  bool dead = false;  ///< True: the channel sends nothing, not even spurious edges.
};

struct PulseLink {
  std::uint64_t seed;
  PulseNoise noise;  ///< Standard deviations; 0: none.
  std::array<ChannelFaults, kPulseChannels> channels;
  /// A spoilt edge is early or late by a time uniformly distributed between the two.
  double spoilt_min_s = 0.0;
  double spoilt_max_s = 0.0;
  double doubled_max_s = 0.0;   ///< Longest delay of the second edge of a doubled one.
  double interference_s = 0.0;  ///< Edges of different channels closer than this spoil each other.
  std::vector<Silence> silences;
};

/// Kind of damage of a received edge.
enum class Damage { Spoilt, Spurious, Doubled, Interference };
/// Returns the name used in truth.json.
std::string_view name_of(Damage damage);

struct ReceivedPulse {
  Pulse pulse;
  std::optional<Damage> damage;
};

struct ReceivedPass {
  std::vector<ReceivedPulse> pulses;  ///< Pulses in order of time and channel.
  std::vector<Pulse> silenced;  ///< Edges seen on board but lost in a silence; in the same order.
  std::int64_t missing = 0;     ///< Number of true edges that did not arrive.
};

/// Sends `edges` (in order of time) over the link. The same link and edges give the same pass; the
/// random draws for an edge do not depend on what happens to the others. Spurious edges are
/// uniformly distributed over the pass of `duration_s` and its `revolutions` turns. Edges that
/// interfere are each displaced, uniformly, by up to half the interference time; silenced edges
/// neither are displaced nor displace others.
ReceivedPass receive(const PulseLink& link, const std::vector<TrueEdge>& edges, TaiTime start,
                     double duration_s, std::int64_t revolutions);

}  // namespace spindrift
