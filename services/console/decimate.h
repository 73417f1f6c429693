/// @file
/// Fewer points of a series that look like all of them.

#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace spindrift {

/// How far off something was, and what that was held against.
struct HeldAgainst {
  double off;
  double limit;
  std::string unit;

  bool operator==(const HeldAgainst&) const = default;
};

struct SeriesPoint {
  std::int64_t t_tai_ns;
  double value;
  std::optional<bool> accepted = {};  ///< Empty: nothing of the kind is rejected.
  std::string rejected_by = {};
  std::optional<HeldAgainst> held = {};  ///< Empty: no test has a number.
  std::optional<bool> used = {};         ///< By the filter, where that decides beside the test.

  bool is_left_out() const { return !accepted.value_or(true) || !used.value_or(true); }

  bool operator==(const SeriesPoint&) const = default;
};

/// At most `most` of the points, which are in order of time: of what was taken, and of what was
/// left out, the newest, and of equal shares of those before the lowest and the highest. What was
/// left out has at most half of all, so that it is seen among what was taken. One point of
/// either is the highest, two are the lowest and the highest. @param most At least 1.
std::vector<SeriesPoint> decimate(std::span<const SeriesPoint> points, std::size_t most);

}  // namespace spindrift
