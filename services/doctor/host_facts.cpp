#include <sqlite3.h>
#include <sys/resource.h>
#include <sys/timex.h>

#include <chrono>
#include <fstream>
#include <limits>
#include <string>

#include "services/doctor/host.h"

namespace spindrift::doctor {
namespace {

int year_now() {
  using namespace std::chrono;
  return static_cast<int>(year_month_day{floor<days>(system_clock::now())}.year());
}

std::optional<std::int64_t> memory_available_bytes() {
  std::ifstream file{"/proc/meminfo"};
  for (std::string line; std::getline(file, line);) {
    if (line.starts_with("MemAvailable:")) {
      return std::stoll(line.substr(line.find(':') + 1)) * 1024;
    }
  }
  return std::nullopt;
}

std::uint64_t open_file_limit() {
  rlimit limit{};
  return getrlimit(RLIMIT_NOFILE, &limit) == 0 ? limit.rlim_cur
                                               : std::numeric_limits<std::uint64_t>::max();
}

}  // namespace

HostFacts host_facts() {
  HostFacts facts{.year = year_now(), .clock_synchronised = {}, .memory_bytes = {}};
  timex clock{};
  if (const int state = adjtimex(&clock); state >= 0) {
    facts.clock_synchronised = state != TIME_ERROR && (clock.status & STA_UNSYNC) == 0;
    facts.clock_error_s = static_cast<double>(clock.maxerror) * 1e-6;
  }
  facts.open_files = open_file_limit();
  facts.memory_bytes = memory_available_bytes();
  facts.sqlite_version = sqlite3_libversion_number();
  return facts;
}

}  // namespace spindrift::doctor
