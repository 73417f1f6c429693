/// @file
/// One turn of the body, as the edges show it.

#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "pipelines/spin/types/products.h"
#include "pipelines/spin/types/pulse.h"
#include "pipelines/spin/types/spin_period.h"
#include "pipelines/time/tai_time.h"

namespace spindrift {

/// All that was received of one turn of the body.
struct Revolution {
  std::int64_t number;
  std::array<std::optional<TaiTime>, kPulseChannels> edges;
  /// Why an edge that is there is not to be used: it lies where those of its channel do not.
  std::array<std::optional<Rejection>, kPulseChannels> edge_rejections = {};
  /// Another edge of the channel was left out as this one's copy.
  std::array<bool, kPulseChannels> has_copy = {};
  /// The interval that ends at its sun1, or what the spacecraft said of it; without sun1 at all,
  /// the interval that ends at the edge that the clock is set by.
  std::optional<PeriodCandidate> period_candidate;
  SpinPeriod period;  ///< At t_start.
  /// After a silence through which the turns could not be counted for certain: one standard
  /// deviation of the number.
  std::optional<double> count_sigma_turns = {};
  /// Its sun1 edge if good, else where that is expected; of a pass without sun1 likewise the edge
  /// that the clock is set by.
  TaiTime t_start = {};

  const std::optional<TaiTime>& edge(PulseChannel channel) const {
    return edges.at(index_of(channel));
  }
  /// The edge, if it is there and nothing speaks against it.
  std::optional<TaiTime> good_edge(PulseChannel channel) const {
    return edge_rejections.at(index_of(channel)) ? std::nullopt : edge(channel);
  }
  /// Spin rate at an instant.
  double rate_rad_s(TaiTime t) const;
  /// How far the body turns from one instant to another.
  double turned_rad(TaiTime from, TaiTime to) const;
};

}  // namespace spindrift
