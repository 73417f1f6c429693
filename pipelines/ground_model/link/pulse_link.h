/// @file
/// What noise, sensors and link make of the true edges of a spinning spacecraft: lost, spoilt,
/// doubled and spurious ones, silences, and edges that spoil each other.

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

/// Probabilities, [0, 1]: of each edge; `spurious` of each turn.
struct ChannelFaults {
  double lost = 0.0;
  double spoilt = 0.0;
  double doubled = 0.0;
  double spurious = 0.0;
  bool dead = false;  ///< Sends nothing, no spurious edges either.
};

struct PulseLink {
  std::uint64_t seed;
  PulseNoise noise;  ///< Standard deviations; 0: none.
  std::array<ChannelFaults, kPulseChannels> channels;
  /// A spoilt edge is off by this much, early or late, evenly distributed between the two.
  double spoilt_min_s = 0.0;
  double spoilt_max_s = 0.0;
  double doubled_max_s = 0.0;   ///< A doubled edge comes again within this.
  double interference_s = 0.0;  ///< Edges of different channels closer than this spoil each other.
  std::vector<Silence> silences;
};

/// What is wrong with a received edge.
enum class Damage { Spoilt, Spurious, Doubled, Interference };
/// As in truth.json.
std::string_view name_of(Damage damage);

struct ReceivedPulse {
  Pulse pulse;
  std::optional<Damage> damage;
};

struct ReceivedPass {
  std::vector<ReceivedPulse> pulses;  ///< In order of time and channel.
  std::vector<Pulse> silenced;        ///< Seen on board, swallowed by a silence; in the same order.
  std::int64_t missing = 0;           ///< True edges that did not arrive.
};

/// Sends `edges` (in order of time) over the link. The same link and edges give the same pass; the
/// chances of an edge do not depend on what befalls the others.
///
/// Spurious edges fall evenly over the pass of `duration_s` and its `revolutions` turns. Edges that
/// interfere are each displaced, evenly, by up to half the interference time; silenced ones neither
/// are nor do.
ReceivedPass receive(const PulseLink& link, const std::vector<TrueEdge>& edges, TaiTime start,
                     double duration_s, std::int64_t revolutions);

}  // namespace spindrift
