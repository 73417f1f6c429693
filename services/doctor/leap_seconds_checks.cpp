#include <fmt/format.h>

#include <algorithm>

#include "services/doctor/leap_seconds.h"

namespace spindrift::doctor {
namespace {

// A leap second is announced about half a year before, at the end of June or December.
constexpr std::chrono::days kSoon{30};

std::string text_of(std::chrono::sys_days day) {
  const std::chrono::year_month_day date{day};
  return fmt::format("{:04}-{:02}-{:02}", static_cast<int>(date.year()),
                     static_cast<unsigned>(date.month()), static_cast<unsigned>(date.day()));
}

std::string text_of(const LeapTable& table) {
  return fmt::format("TAI - UTC = {} s, complete until {}", table.tai_minus_utc_s,
                     text_of(table.complete_until));
}

}  // namespace

Check check_leap_seconds(const LeapFacts& facts) {
  const std::string name = "leap seconds";
  std::string found = fmt::format("ERFA: {}", text_of(facts.erfa));
  if (facts.machine) {
    found += fmt::format("; leap-seconds.list: {}", text_of(*facts.machine));
  }
  const auto known_until =
      std::max(facts.erfa.complete_until,
               facts.machine ? facts.machine->complete_until : facts.erfa.complete_until);
  if (facts.machine && facts.machine->complete_until > facts.erfa.complete_until &&
      facts.machine->tai_minus_utc_s != facts.erfa.tai_minus_utc_s) {
    return failure(name, found, "UTC will be wrong by the difference: install a newer liberfa1");
  }
  const std::string advice =
      "see whether IERS Bulletin C has announced a leap second; apt-get install --only-upgrade "
      "tzdata liberfa1";
  if (facts.today > known_until) {
    return warning(name, fmt::format("{}; both are out of date", found), advice);
  }
  return facts.today + kSoon > known_until ? warning(name, found, advice) : ok(name, found);
}

}  // namespace spindrift::doctor
