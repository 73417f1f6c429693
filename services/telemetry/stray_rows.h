/// @file
/// Which rows of a file say another time than those around them.

#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "pipelines/time/tai_time.h"

namespace spindrift {

struct StrayRow {
  std::size_t row;
  std::size_t after;  ///< The row in order that stands before it.
};

/// A file keeps the order in which samples were received, and that tells what their times alone do
/// not: rows between two that go on from one another, and more than a minute apart from both, are
/// stray, however many there are. A block that stands in the wrong place is not: nothing goes on
/// around it. Nor is one recording behind another: its end is not apart. In a file most of whose
/// rows stand in no order none is.
/// @param times Of the rows of one spacecraft, in the order of the file.
/// @return in that order.
std::vector<StrayRow> find_stray_rows(std::span<const TaiTime> times);

}  // namespace spindrift
