#include "services/console/archive_view.h"

#include <SQLiteCpp/Statement.h>
#include <fmt/format.h>

#include <algorithm>

namespace spindrift {

Expected<std::vector<SeriesPoint>> values_of(SQLite::Database& archive, const std::string& run_id,
                                             const Quantity& quantity, const Span& span) {
  SQLite::Statement rows{archive, quantity.sql};
  rows.bind(1, run_id);
  rows.bind(2, span.to_tai_ns);
  std::vector<SeriesPoint> points;
  while (rows.executeStep() && rows.getColumn(0).getInt64() >= span.from_tai_ns) {
    if (points.size() == kMostValuesRead) {
      return Unexpected{{ErrorCode::InvalidInput,
                         fmt::format("more than {} values of {} in the span: ask for a shorter one",
                                     kMostValuesRead, quantity.name)}};
    }
    SeriesPoint point{.t_tai_ns = rows.getColumn(0).getInt64(),
                      .value = rows.getColumn(1).getDouble()};
    if (const SQLite::Column accepted = rows.getColumn(2); !accepted.isNull()) {
      point.accepted = accepted.getInt() != 0;
    }
    if (const SQLite::Column by = rows.getColumn(3); !by.isNull()) {
      point.rejected_by = by.getString();
    }
    constexpr int kHeld = 4;
    if (rows.getColumnCount() > kHeld && !rows.getColumn(kHeld).isNull()) {
      point.held = HeldAgainst{.off = rows.getColumn(kHeld).getDouble(),
                               .limit = rows.getColumn(kHeld + 1).getDouble(),
                               .unit = rows.getColumn(kHeld + 2).getString()};
    }
    constexpr int kUsed = 7;
    if (rows.getColumnCount() > kUsed && !rows.getColumn(kUsed).isNull()) {
      point.used = rows.getColumn(kUsed).getInt() != 0;
    }
    points.push_back(std::move(point));
  }
  std::reverse(points.begin(), points.end());
  return points;
}

}  // namespace spindrift
