/// @file
/// Series of values for the console: read from the archive, and thinned.

#pragma once

#include <SQLiteCpp/Database.h>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "pipelines/core/expected.h"
#include "services/console/quantities.h"

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

/// Limit on the values of one series, so that a request stays bounded.
inline constexpr std::size_t kMostValuesRead = 1'000'000;

struct Span {
  std::int64_t from_tai_ns;
  std::int64_t to_tai_ns;
};
/// Returns a run's values in a span, ends included, by time. Throws SQLite::Exception.
/// @return InvalidInput for more than kMostValuesRead.
Expected<std::vector<SeriesPoint>> values_of(SQLite::Database& archive, const std::string& run_id,
                                             const Quantity& quantity, const Span& span);

/// Returns at most `most` of the points, which are in order of time. Accepted and left-out points
/// are thinned apart, so that the latter, at most half of the result, stay visible. Of each it
/// keeps the newest, and the lowest and highest of equal shares of the others. When only one may be
/// kept it is the highest; of two, the lowest and the highest. @param most At least 1.
std::vector<SeriesPoint> decimate(std::span<const SeriesPoint> points, std::size_t most);

}  // namespace spindrift
