#include "services/telemetry/likely_cause.h"

#include <array>
#include <charconv>
#include <cmath>
#include <system_error>

#include "services/telemetry/csv.h"
#include "services/telemetry/telemetry_time.h"

namespace spindrift {
namespace {

/// Dates are written as 2026-11-20T03:00:00Z.
bool is_date(std::string_view field) {
  constexpr std::size_t kDay = 10;
  return field.size() >= kDay && field[4] == '-' && field[7] == '-';
}

}  // namespace

std::string_view likely_time(std::string_view field) {
  struct Unit {
    double ns;
    std::string_view says;
  };
  constexpr std::array<Unit, 4> kUnits{
      {{1e9, "; looks like s, not ns"},
       {1e6, "; looks like ms, not ns"},
       {1e3, "; looks like us, not ns"},
       {1.0, "; looks rounded by a spreadsheet: all digits are needed"}}};
  if (is_date(field)) {
    return "; looks like a date, not ns of TAI since 1970";
  }
  double number = 0.0;
  const char* const end = field.data() + field.size();
  const auto [stop, failure] = std::from_chars(field.data(), end, number);
  if (failure != std::errc{} || stop != end || !std::isfinite(number)) {
    return {};
  }
  for (const auto& [ns, says] : kUnits) {
    const double t_tai_ns = number * ns;
    if (t_tai_ns >= static_cast<double>(tai_ns(kEarliestTelemetry)) &&
        t_tai_ns < static_cast<double>(tai_ns(kLatestTelemetry))) {
      return says;
    }
  }
  return {};
}

std::string_view likely_separator(std::string_view line, std::size_t columns) {
  if (line.find(';') != std::string_view::npos) {
    return "; looks separated by semicolons, not commas";
  }
  if (line.ends_with(',')) {
    return "; a comma too many stands at its end";
  }
  return CsvFields{line}.count() > columns ? "; looks like decimal commas, not points"
                                           : std::string_view{};
}

}  // namespace spindrift
