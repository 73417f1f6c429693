/// @file
/// Thins a series to fewer points with the same look.

#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace spindrift {

/// Deviation in a test, and the limit of the test.
struct HeldAgainst {
  double off;
  double limit;
  std::string unit;

  bool operator==(const HeldAgainst&) const = default;
};

struct SeriesPoint {
  std::int64_t t_tai_ns;
  double value;
  std::optional<bool> accepted = {};  ///< Empty when nothing of the kind is rejected.
  std::string rejected_by = {};
  std::optional<HeldAgainst> held = {};  ///< Empty when no test has a number.
  std::optional<bool> used = {};         ///< Whether the filter used it.

  bool is_left_out() const { return !accepted.value_or(true) || !used.value_or(true); }

  bool operator==(const SeriesPoint&) const = default;
};

/// Returns at most `most` of the points, which are in order of time. Accepted and left-out points
/// are thinned apart, so that the latter, at most half of the result, stay visible. Of each it
/// keeps the newest, and the lowest and highest of equal shares of the others. When only one may be
/// kept it is the highest; of two, the lowest and the highest. @param most At least 1.
std::vector<SeriesPoint> decimate(std::span<const SeriesPoint> points, std::size_t most);

}  // namespace spindrift
