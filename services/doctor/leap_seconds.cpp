#include "services/doctor/leap_seconds.h"

#include <fmt/format.h>

#include <algorithm>

namespace spindrift::doctor {
namespace {

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
    return failure(name, found,
                   "UTC will be wrong by the difference: install a newer liberfa1; Debian 12 has "
                   "none, a later Debian has");
  }
  return facts.day > known_until
             ? warning(name, fmt::format("{}; not known on {}", found, text_of(facts.day)),
                       "apt-get update && apt-get install --only-upgrade tzdata; where that brings "
                       "no newer table: UTC is right unless IERS Bulletin C has announced a leap "
                       "second meanwhile (https://hpiers.obspm.fr/iers/bul/bulc/bulletinc.dat)")
             : ok(name, found);
}

}  // namespace spindrift::doctor
