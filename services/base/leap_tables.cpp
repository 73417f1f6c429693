#include "services/base/leap_tables.h"

#include <erfa.h>

#include <charconv>
#include <string>

#include "pipelines/time/utc.h"
#include "services/base/input_file.h"

namespace spindrift {
namespace {

using std::chrono::days;
using std::chrono::floor;
using std::chrono::seconds;
using std::chrono::sys_days;
using std::chrono::sys_seconds;
using std::chrono::year;

constexpr const char* kMachineTable = "/usr/share/zoneinfo/leap-seconds.list";
constexpr seconds kFrom1900To1970{2'208'988'800};
// eraDat calls years dubious from this many years after the release of its table.
constexpr int kTrustedYears = 5;

std::optional<std::int64_t> number(std::string_view text) {
  text.remove_prefix(std::min(text.find_first_of("0123456789"), text.size()));
  std::int64_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc{} ? std::optional{value} : std::nullopt;
}

/// Returns the release year of ERFA's table, from the first year that eraDat calls dubious.
int erfa_release_year(year last_leap) {
  int dubious = static_cast<int>(last_leap);
  for (double offset_s = 0.0; eraDat(dubious, 1, 1, 0.0, &offset_s) == 0; ++dubious) {
  }
  return dubious - kTrustedYears - 1;
}

/// Holds only for times after the last leap second.
sys_days day_of(TaiTime t) {
  return floor<days>(sys_seconds{floor<seconds>(t.time_since_epoch()) -
                                 seconds{leap_seconds().back().tai_minus_utc_s}});
}

LeapTable erfa_table() {
  const LeapSecond last = leap_seconds().back();
  const int release = erfa_release_year(std::chrono::year_month_day{day_of(last.start)}.year());
  return {.tai_minus_utc_s = last.tai_minus_utc_s,
          .since = day_of(last.start),
          .complete_until = sys_days{year{release} / 12 / 31}};
}

}  // namespace

std::optional<LeapTable> machine_table(std::string_view text) {
  std::optional<std::int64_t> expires;
  std::optional<std::int64_t> since;
  std::optional<std::int64_t> offset;
  while (!text.empty()) {
    const std::string_view line = text.substr(0, text.find('\n'));
    text.remove_prefix(std::min(line.size() + 1, text.size()));
    if (line.starts_with("#@")) {
      expires = number(line);
    } else if (const std::size_t gap = line.find_first_of(" \t");
               !line.starts_with('#') && gap != std::string_view::npos) {
      since = number(line);
      offset = number(line.substr(gap));
    }
  }
  if (!expires || !since || !offset) {
    return std::nullopt;
  }
  const auto day = [](std::int64_t from_1900_s) {
    return floor<days>(sys_seconds{seconds{from_1900_s} - kFrom1900To1970});
  };
  return LeapTable{.tai_minus_utc_s = static_cast<int>(*offset),
                   .since = day(*since),
                   .complete_until = day(*expires)};
}

std::optional<sys_days> lacking_from(const LeapFacts& facts) {
  return facts.machine && facts.machine->since > facts.erfa.since
             ? std::optional{facts.machine->since}
             : std::nullopt;
}

LeapFacts leap_facts(TaiTime t) {
  return {.day = day_of(t),
          .erfa = erfa_table(),
          .machine = machine_table(read_text_file(kMachineTable).value_or(std::string{}))};
}

}  // namespace spindrift
