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

struct SeriesPoint {
  std::int64_t t_tai_ns;
  double value;
  std::optional<bool> accepted = {};  ///< Empty: nothing of the kind is rejected.
  std::string rejected_by = {};

  bool operator==(const SeriesPoint&) const = default;
};

/// At most `most` of the points, which are in order of time: the newest, and of equal shares of
/// those before the lowest and the highest. What was rejected has shares of its own, at most half
/// of all, so that it is seen among what was accepted. @param most At least 1: then the highest of
/// what was accepted; of 2 the newest is not one.
std::vector<SeriesPoint> decimate(std::span<const SeriesPoint> points, std::size_t most);

}  // namespace spindrift
