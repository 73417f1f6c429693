#include "services/words/duration.h"

#include <fmt/format.h>

#include <cmath>
#include <cstdint>
#include <string>
#include <string_view>

#include "services/words/counted.h"

namespace spindrift {
namespace {

constexpr std::int64_t kSeconds = 60;  // Of a minute, and so on.
constexpr std::int64_t kMinutes = 60;
constexpr std::int64_t kHours = 24;
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
  if (const auto s = rounded(seconds, 1); s < kMinutes * kSeconds) {
    return s < kSeconds ? fmt::format("{} s", s)
                        : pair_of(fmt::format("{} min", s / kSeconds), s % kSeconds, "s");
  }
  if (const auto min = rounded(seconds, kSeconds); min < kHours * kMinutes) {
    return pair_of(fmt::format("{} h", min / kMinutes), min % kMinutes, "min");
  }
  const auto h = rounded(seconds, kMinutes * kSeconds);
  return pair_of(counted(h / kHours, "days"), h % kHours, "h");
}

}  // namespace spindrift
