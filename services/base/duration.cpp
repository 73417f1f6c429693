#include "services/base/duration.h"

#include <fmt/format.h>

#include <cmath>
#include <cstdint>
#include <string>
#include <string_view>

#include "services/base/counted.h"

namespace spindrift {
namespace {

constexpr std::int64_t kSecondsPerMinute = 60;
constexpr std::int64_t kMinutesPerHour = 60;
constexpr std::int64_t kSecondsPerHour = kSecondsPerMinute * kMinutesPerHour;
constexpr std::int64_t kHoursPerDay = 24;
constexpr double kShort_s = 10.0;

std::int64_t rounded(double seconds, std::int64_t unit_s) {
  return std::llround(seconds / static_cast<double>(unit_s));
}

std::string pair_of(const std::string& larger, std::int64_t rest, std::string_view smaller) {
  return rest == 0 ? larger : fmt::format("{} {} {}", larger, rest, smaller);
}

}  // namespace

std::string duration_text(double seconds) {
  if (seconds < kShort_s) {
    return fmt::format("{:.3g} s", seconds);
  }
  if (const auto s = rounded(seconds, 1); s < kSecondsPerHour) {
    return s < kSecondsPerMinute
               ? fmt::format("{} s", s)
               : pair_of(fmt::format("{} min", s / kSecondsPerMinute), s % kSecondsPerMinute, "s");
  }
  if (const auto min = rounded(seconds, kSecondsPerMinute); min < kHoursPerDay * kMinutesPerHour) {
    return pair_of(fmt::format("{} h", min / kMinutesPerHour), min % kMinutesPerHour, "min");
  }
  const auto h = rounded(seconds, kSecondsPerHour);
  return pair_of(counted(h / kHoursPerDay, "days"), h % kHoursPerDay, "h");
}

}  // namespace spindrift
