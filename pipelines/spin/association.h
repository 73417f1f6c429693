/// @file
/// Which edge belongs to which revolution: by spin phase, never by the order of arrival.
///
/// A clock counts spin phase in turns from the sun1 edges. Each other channel is expected at its
/// own phase, learnt from the edges themselves and followed as the Earth moves; an edge belongs to
/// the revolution whose expected phase it is nearest to. So a chord that straddles the next sun1,
/// or hovers about it, stays with one revolution. When the edges of a channel agree on another
/// place (the Earth moved during a silence, the spin rate stepped), they are believed.

#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

#include "pipelines/spin/config.h"
#include "pipelines/spin/products.h"
#include "pipelines/spin/pulse.h"
#include "pipelines/spin/spin_period.h"

namespace spindrift {

/// All that was received of one turn of the body.
struct Revolution {
  std::int64_t number;
  std::array<std::optional<TaiTime>, kPulseChannels> edges;
  /// Why an edge that is there is not to be used: it lies where those of its channel do not.
  std::array<std::optional<Rejection>, kPulseChannels> edge_rejections = {};
  std::optional<PeriodCandidate> period_candidate;  ///< The interval that ends at its sun1.
  SpinPeriod period;                                ///< In force when the revolution closed.

  const std::optional<TaiTime>& edge(PulseChannel channel) const {
    return edges.at(index_of(channel));
  }
  /// The edge, if it is there and nothing speaks against it.
  std::optional<TaiTime> good_edge(PulseChannel channel) const {
    return edge_rejections.at(index_of(channel)) ? std::nullopt : edge(channel);
  }
};

struct Association {
  std::vector<Revolution> closed;   ///< In order of number.
  std::vector<PulseUse> left_over;  ///< Edges that found no place.
};

class Associator {
 public:
  explicit Associator(const SpinConfig& config);

  /// @param pulse Not earlier than the one before.
  Association push(const Pulse& pulse);

  /// The pass has ended: closes what is open.
  Association finish();

 private:
  /// Spin phase is counted from here.
  struct Clock {
    TaiTime t_sun1;  ///< The last sun1 edge whose interval passed the period test.
    std::int64_t revolution;
    SpinPeriod period;
  };

  bool start_clock(std::size_t fewest_intervals);
  void restart_clock_after_step(const Pulse& sun1);
  void learn_phases();
  Association place_waiting();
  void place(const Pulse& pulse, Association& out);
  void close_before(double phase_turns, Association& out);
  void close(Revolution& revolution);
  Revolution* open_revolution(std::int64_t number);
  double phase_turns(TaiTime t) const;
  double unwrapped(PulseChannel channel, double phase_turns) const;
  bool found_again(const Pulse& pulse);
  void follow(const Revolution& revolution);

  SpinConfig config_;
  SpinPeriodWindow period_window_;
  std::vector<Pulse> waiting_;  ///< Until the period is known.
  std::optional<Clock> clock_;
  /// Where each channel's edge is expected, in turns behind sun1; empty until first seen.
  std::array<std::optional<double>, kPulseChannels> expected_turns_;
  /// Edges of each channel that were not where it is expected, since the last one that was.
  std::array<std::deque<TaiTime>, kPulseChannels> strays_;
  std::deque<TaiTime> recent_sun1_;
  std::deque<Revolution> open_;  ///< In order of number; only those with an edge.
  std::int64_t first_open_ = 0;  ///< Revolutions before this one are closed.
};

}  // namespace spindrift
