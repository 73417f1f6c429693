/// @file
/// Whether the times of edges lie on a grid, as those do that were cut or rounded to a millisecond:
/// the greatest common divisor of how far the edges of a channel come behind sun1.
///
/// It is that of sixteen differences, one run after the other, so that single edges of another
/// clock spoil one run only. That such a run of times without a grid has a divisor of k ns or more
/// is less likely than k^-15. Behind sun1, because the intervals of coded frames may be counted in
/// coarser steps than their sun1.

#pragma once

#include <cstdint>
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

  /// @param edge Behind the last sun1.
  void note(const Pulse& edge);

  /// The widest that several runs have had; 0: none.
  double width_s() const { return width_s_; }

 private:
  double least_ns_;
  std::optional<TaiTime> reference_;  ///< The last sun1; before any, the first edge.
  std::int64_t divisor_ns_ = 0;       ///< Of the run.
  int differences_ = 0;               ///< In it.
  std::map<std::int64_t, int> runs_;  ///< That have had a grid, by its width.
  double width_s_ = 0.0;
};

}  // namespace spindrift
