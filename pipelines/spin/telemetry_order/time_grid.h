/// @file
/// Detection of the grid that the times of edges lie on when they were cut or rounded, as to a
/// millisecond: its width is the greatest common divisor of the delays of edges behind sun1, and of
/// the intervals between the edges of a channel. The former are needed since coded frames may count
/// intervals in coarser steps than the time of sun1, the latter where only some channels are cut.
///
/// A divisor is taken over each run of twenty differences, so that single edges of another clock
/// spoil one run only. A run without a grid has a divisor of k ns or more with a chance below
/// k^-19.
///
/// One divisor for the whole pass was rejected, since a single edge off the grid makes it a
/// nanosecond. Divisors of each channel's own times were rejected as the only ones: at a rate
/// commensurate with the grid they are whole periods.

#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <map>
#include <optional>

#include "pipelines/spin/types/config.h"
#include "pipelines/spin/types/pulse.h"
#include "pipelines/time/tai_time.h"

namespace spindrift {

class TimeGrid {
 public:
  /// @param noise Noise of the edges; a grid narrower than a thousandth of it is ignored.
  explicit TimeGrid(const PulseNoise& noise);

  /// @param edge Edges come in order of time.
  void learn(const Pulse& edge);

  /// Returns the widest grid that several runs have had; 0 when there is none.
  double width_s() const { return width_s_; }

 private:
  struct Run {
    std::int64_t divisor_ns = 0;
    std::int64_t smallest_ns = std::numeric_limits<std::int64_t>::max();
    int differences = 0;
  };
  void add(std::int64_t difference_ns, Run& run);
  void end(const Run& run);

  double least_ns_;
  std::array<std::optional<TaiTime>, kPulseChannels> last_ = {};
  Run behind_sun1_;
  std::array<Run, kPulseChannels> behind_each_other_ = {};
  std::map<std::int64_t, int> runs_;  ///< Number of runs with a grid, by its width, ns.
  double width_s_ = 0.0;
};

}  // namespace spindrift
