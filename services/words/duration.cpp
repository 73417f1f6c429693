#include "services/words/duration.h"

#include <fmt/format.h>

#include <cmath>
#include <cstdint>
#include <string>
#include <string_view>

#include "services/words/counted.h"

namespace spindrift {
namespace {

constexpr std::int64_t kMinute_s = 60;
constexpr std::int64_t kHour_s = 3600;
constexpr std::int64_t kDay_s = 86'400;
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
  if (const auto s = rounded(seconds, 1); s < kHour_s) {
    return s < kMinute_s ? fmt::format("{} s", s)
                         : pair_of(fmt::format("{} min", s / kMinute_s), s % kMinute_s, "s");
  }
  if (const auto min = rounded(seconds, kMinute_s); min < kDay_s / kMinute_s) {
    return pair_of(fmt::format("{} h", min / 60), min % 60, "min");
  }
  const auto h = rounded(seconds, kHour_s);
  return pair_of(counted(h / 24, "days"), h % 24, "h");
}

}  // namespace spindrift
