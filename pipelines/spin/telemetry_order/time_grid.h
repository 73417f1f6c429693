/// @file
/// Whether the times of edges lie on a grid, as those do that were cut or rounded to a millisecond:
/// the greatest common divisor of how far the edges of a channel come behind sun1, and behind each
/// other. The first is needed since coded frames may count their intervals in coarser steps than
/// the time of sun1, the second where some channels are cut only.
///
/// A divisor is that of twenty differences, one run after the other, so that single edges of
/// another clock spoil one run only. That such a run of times without a grid has a divisor of k ns
/// or more is less likely than k^-19.

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
  /// @param noise Of the edges. What is narrower than a thousandth of it is no grid.
  explicit TimeGrid(const PulseNoise& noise);

  /// @param edge In order of time.
  void note(const Pulse& edge);

  /// The widest that several runs have had; 0: none.
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
  std::map<std::int64_t, int> runs_;  ///< That have had a grid, by its width.
  double width_s_ = 0.0;
};

}  // namespace spindrift
