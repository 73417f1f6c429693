/// @file
/// What the console reads in the archive.

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

/// More values than which a series is not read of.
inline constexpr std::size_t kMostValuesRead = 1'000'000;

struct Span {
  std::int64_t from_tai_ns;
  std::int64_t to_tai_ns;
};
/// All values of a run in a span, both ends included, in order of time. Throws SQLite::Exception.
/// @return InvalidInput for more than kMostValuesRead.
Expected<std::vector<SeriesPoint>> values_of(SQLite::Database& archive, const std::string& run_id,
                                             const Quantity& quantity, const Span& span);

}  // namespace spindrift
