/// @file
/// One turn of the body, as the edges show it.

#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "pipelines/spin/types/products.h"
#include "pipelines/spin/types/pulse.h"
#include "pipelines/spin/types/spin_rate.h"
#include "pipelines/time/tai_time.h"

namespace spindrift {

/// All that was received of one turn of the body.
struct Revolution {
  std::int64_t number;
  std::array<std::optional<TaiTime>, kPulseChannels> edges;
  /// Why a received edge is not used: it lies where those of its channel do not. Empty: it is good.
  std::array<std::optional<Rejection>, kPulseChannels> edge_rejections = {};
  /// Observations that the edges rejected by `phase` gave to the clock.
  std::array<std::optional<Observation>, kPulseChannels> edge_places = {};
  /// Gaps that rejected the edges by `interference`.
  std::array<std::optional<EdgeGap>, kPulseChannels> edge_gaps = {};
  /// Whether another edge of the channel came so near that one is a copy.
  std::array<bool, kPulseChannels> has_copy = {};
  /// The interval that ends at its sun1, or the period that the spacecraft stated; in a pass
  /// without sun1, the interval that ends at the edge of the channel that sets the clock.
  std::optional<PeriodCandidate> period_candidate;
  SpinPeriod period;  ///< Spin period at t_start.
  /// One sigma of `number`, set after a silence too long to count the turns for certain.
  std::optional<double> count_sigma_turns = {};
  /// Its sun1 edge if good, else the expected time of that edge; in a pass without sun1, the same
  /// for the channel that sets the clock.
  TaiTime t_start = {};

  const std::optional<TaiTime>& edge(PulseChannel channel) const {
    return edges.at(index_of(channel));
  }
  /// The edge, if it is there and nothing speaks against it.
  std::optional<TaiTime> good_edge(PulseChannel channel) const {
    return edge_rejections.at(index_of(channel)) ? std::nullopt : edge(channel);
  }
  double rate_rad_s(TaiTime t) const;
  double turned_rad(TaiTime from, TaiTime to) const;
};

}  // namespace spindrift
