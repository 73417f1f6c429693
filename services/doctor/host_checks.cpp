#include <fmt/format.h>

#include <algorithm>

#include "services/doctor/host.h"

namespace spindrift::doctor {
namespace {

// The program did not exist earlier, and 64-bit nanoseconds in the archive end in 2262.
constexpr int kFirstYear = 2026;
constexpr int kLastYear = 2261;
// Sockets, archive, log and libraries open about forty files.
constexpr std::uint64_t kFewFiles = 256;
constexpr std::int64_t kLittleMemory_bytes = 512LL << 20;
// Versions 3.7.0 to 3.51.2 have the WAL-reset bug.
constexpr int kFirstWithResetBug = 3007000;
constexpr int kFirstWithoutResetBug = 3051003;

Check check_clock(const HostFacts& facts) {
  const std::string name = "clock";
  if (facts.year < kFirstYear || facts.year > kLastYear) {
    return failure(name, fmt::format("the system clock says it is the year {}", facts.year),
                   "set the clock");
  }
  if (!facts.clock_synchronised) {
    return warning(name, "the kernel does not tell whether the clock is synchronised",
                   "look at it yourself: timedatectl, chronyc tracking");
  }
  return *facts.clock_synchronised
             ? ok(name, fmt::format("synchronised, error at most {:.3f} s by the kernel's estimate",
                                    facts.clock_error_s))
             : warning(name, "the system clock is not synchronised",
                       "start chrony or systemd-timesyncd: telemetry is stamped by the front-end, "
                       "but runs and health by this clock");
}

Check check_open_files(std::uint64_t limit) {
  const std::string found = fmt::format("{} may be open at once", limit);
  return limit < kFewFiles ? warning("open files", found, "raise it: ulimit -n 1024")
                           : ok("open files", found);
}

Check check_memory(std::int64_t available_bytes) {
  const std::string found = fmt::format("{} MiB available", available_bytes >> 20);
  return available_bytes < kLittleMemory_bytes
             ? warning("memory", found, "end other programs before the pass")
             : ok("memory", found);
}

Check check_sqlite(int version) {
  const std::string found =
      fmt::format("version {}.{}.{}", version / 1'000'000, version / 1000 % 1000, version % 1000);
  return version < kFirstWithResetBug || version >= kFirstWithoutResetBug
             ? ok("SQLite", found)
             : ok("SQLite", found + ", safe for spindrift, which writes by one connection",
                  "let no other program write an archive: this version of SQLite may damage a "
                  "file that two connections write or checkpoint");
}

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

std::vector<Check> check_host(const HostFacts& facts) {
  std::vector<Check> checks{check_clock(facts), check_open_files(facts.open_files)};
  if (facts.memory_bytes) {
    checks.push_back(check_memory(*facts.memory_bytes));
  }
  checks.push_back(check_sqlite(facts.sqlite_version));
  return checks;
}

Check check_leap_seconds(const LeapFacts& facts) {
  const std::string name = "leap seconds";
  std::string found = fmt::format("ERFA: {}", text_of(facts.erfa));
  if (facts.machine) {
    found += fmt::format("; leap-seconds.list: {}", text_of(*facts.machine));
  }
  const auto known_until =
      std::max(facts.erfa.complete_until,
               facts.machine ? facts.machine->complete_until : facts.erfa.complete_until);
  if (lacking_from(facts)) {
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
