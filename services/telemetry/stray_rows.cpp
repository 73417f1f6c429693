#include "services/telemetry/stray_rows.h"

#include <algorithm>
#include <cstdint>
#include <limits>

#include "pipelines/time/time_jump.h"
#include "pipelines/time/time_span.h"

namespace spindrift {
namespace {

bool steps_far_back(std::span<const TaiTime> times) {
  TaiTime newest = TaiTime::min();
  return std::any_of(times.begin(), times.end(), [&newest](TaiTime t) {
    newest = std::max(newest, t);
    return span_between(t, newest) > TimeJump::kFar;
  });
}

/// Finds the largest set of ordered rows by patience sorting (Fredman 1975). Any order within a
/// second is accepted, since the pipelines wait that long.
std::vector<std::size_t> rows_in_order(std::span<const TaiTime> times) {
  constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();
  const auto second_of = [&](std::uint32_t row) { return tai_ns(times[row]) / 1'000'000'000; };
  std::vector<std::uint32_t> last;  // Earliest last row by length of the sequence.
  std::vector<std::uint32_t> before(times.size(), kNone);
  for (std::uint32_t row = 0; row < times.size(); ++row) {
    const auto place = std::upper_bound(
        last.begin(), last.end(), second_of(row),
        [&](std::int64_t second, std::uint32_t other) { return second < second_of(other); });
    before[row] = place == last.begin() ? kNone : *std::prev(place);
    if (place == last.end()) {
      last.push_back(row);
    } else {
      *place = row;
    }
  }
  std::vector<std::size_t> rows(last.size());
  std::uint32_t row = last.empty() ? kNone : last.back();
  for (auto place = rows.rbegin(); place != rows.rend(); ++place, row = before[row]) {
    *place = row;
  }
  return rows;
}

bool follow(TaiTime one, TaiTime other) {
  return span_between(std::min(one, other), std::max(one, other)) <= TimeJump::kFar;
}

/// Returns the end of the sequence of rows from `row` that follow one another, at most `end`.
std::size_t end_of_run(std::span<const TaiTime> times, std::size_t row, std::size_t end) {
  for (++row; row < end && follow(times[row - 1], times[row]); ++row) {
  }
  return row;
}

}  // namespace

std::vector<StrayRow> find_stray_rows(std::span<const TaiTime> times) {
  if (!steps_far_back(times)) {
    return {};
  }
  const std::vector<std::size_t> in_order = rows_in_order(times);
  std::vector<StrayRow> stray;
  if (2 * in_order.size() <= times.size()) {
    return stray;
  }
  for (std::size_t i = 1; i < in_order.size(); ++i) {
    const std::size_t before = in_order[i - 1];
    const std::size_t after = in_order[i];
    if (span_between(times[before], times[after]) > TimeJump::kFar) {
      continue;
    }
    for (std::size_t row = before + 1; row < after;) {
      const std::size_t end = end_of_run(times, row, after);
      // Rows that continue either neighbour belong to another recording.
      const bool goes_on =
          follow(times[before], times[row]) || follow(times[end - 1], times[after]);
      for (; row < end; ++row) {
        if (!goes_on) {
          stray.push_back({.row = row, .after = before});
        }
      }
    }
  }
  return stray;
}

}  // namespace spindrift
