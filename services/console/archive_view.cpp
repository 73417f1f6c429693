#include "services/console/archive_view.h"

#include <SQLiteCpp/Statement.h>
#include <fmt/format.h>

#include <algorithm>

namespace spindrift {

nlohmann::json verdict_of(SQLite::Database& archive, const std::string& run_id) {
  SQLite::Statement row{archive,
                        "SELECT estimator, verdict.quality AS quality, why, verdict.sigma_deg AS "
                        "sigma_deg, verdict.ra_deg AS ra_deg, verdict.dec_deg AS dec_deg, "
                        "spin_rate_rpm, sigma_rpm FROM pass_verdict AS verdict LEFT JOIN "
                        "pass_answer USING (run_id, estimator) WHERE run_id = ?"};
  row.bind(1, run_id);
  nlohmann::json verdict = nlohmann::json::object();
  if (row.executeStep()) {
    for (int i = 0; i < row.getColumnCount(); ++i) {
      const SQLite::Column value = row.getColumn(i);
      if (!value.isNull()) {
        verdict[value.getName()] =
            value.isText() ? nlohmann::json(value.getString()) : nlohmann::json(value.getDouble());
      }
    }
  }
  return verdict;
}

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
    points.push_back(std::move(point));
  }
  std::reverse(points.begin(), points.end());
  return points;
}

}  // namespace spindrift
