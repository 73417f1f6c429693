#include "services/console/series.h"

#include <SQLiteCpp/Statement.h>
#include <fmt/format.h>

#include <algorithm>
#include <iterator>

namespace spindrift {
namespace {

bool is_lower(const SeriesPoint& a, const SeriesPoint& b) { return a.value < b.value; }
bool is_earlier(const SeriesPoint& a, const SeriesPoint& b) { return a.t_tai_ns < b.t_tai_ns; }

/// Keeps the extremes of equal shares and, of three or more, the newest point.
void thin(std::span<const SeriesPoint> points, std::size_t most, std::vector<SeriesPoint>& kept) {
  if (points.size() <= most) {
    kept.insert(kept.end(), points.begin(), points.end());
    return;
  }
  if (most == 1) {
    kept.push_back(*std::max_element(points.begin(), points.end(), &is_lower));
    return;
  }
  const std::size_t newest = most > 2 ? 1 : 0;
  const auto before = points.first(points.size() - newest);
  const std::size_t shares = (most - newest) / 2;
  for (std::size_t i = 0; i < shares; ++i) {
    const std::size_t begin = before.size() * i / shares;
    const auto share = before.subspan(begin, before.size() * (i + 1) / shares - begin);
    const auto [low, high] = std::minmax_element(share.begin(), share.end(), &is_lower);
    kept.push_back(*std::min(low, high));
    if (low != high) {
      kept.push_back(*std::max(low, high));
    }
  }
  kept.insert(kept.end(), before.end(), points.end());
}

}  // namespace

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

std::vector<SeriesPoint> decimate(std::span<const SeriesPoint> points, std::size_t most) {
  if (points.size() <= most) {
    return {points.begin(), points.end()};
  }
  std::vector<SeriesPoint> taken;
  std::vector<SeriesPoint> left_out;
  std::partition_copy(points.begin(), points.end(), std::back_inserter(taken),
                      std::back_inserter(left_out),
                      [](const SeriesPoint& point) { return !point.is_left_out(); });
  const std::size_t of_left_out =
      std::min(left_out.size(), std::max(most / 2, most - std::min(most, taken.size())));
  std::vector<SeriesPoint> kept;
  thin(left_out, of_left_out, kept);
  thin(taken, most - of_left_out, kept);
  std::stable_sort(kept.begin(), kept.end(), &is_earlier);
  return kept;
}

}  // namespace spindrift
