/// @file
/// Finds the rows of a file whose times do not fit those around them.

#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "pipelines/time/tai_time.h"

namespace spindrift {

struct StrayRow {
  std::size_t row;
  std::size_t after;  ///< The last row in order before it.
};

/// A file keeps the order of reception, which reveals rows with wrong times. Any number of rows are
/// stray if they lie between two rows that follow on from one another and are more than a minute
/// from both. A misplaced block is not stray, since no rows follow on around it, nor is a second
/// recording, whose end has no row after it. A file whose rows are mostly unordered has no strays.
/// @param times Times of the rows of one spacecraft, in the order of the file.
/// @return The stray rows in that order.
std::vector<StrayRow> find_stray_rows(std::span<const TaiTime> times);

}  // namespace spindrift
