/// @file
/// Reads data series from the archive for the console.

#pragma once

#include <SQLiteCpp/Database.h>

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "pipelines/core/expected.h"
#include "services/console/decimate.h"
#include "services/console/quantities.h"

namespace spindrift {

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

}  // namespace spindrift
