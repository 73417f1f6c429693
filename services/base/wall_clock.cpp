#include "services/base/wall_clock.h"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <chrono>

#include "pipelines/time/utc.h"

namespace spindrift {

using std::chrono::system_clock;

namespace {

std::string utc_of(system_clock::time_point instant) {
  using namespace std::chrono;
  const auto whole_ms = floor<milliseconds>(instant);
  const auto whole_s = floor<seconds>(whole_ms);
  return fmt::format("{:%Y-%m-%dT%H:%M:%S}.{:03}Z", fmt::gmtime(system_clock::to_time_t(whole_s)),
                     (whole_ms - whole_s).count());
}

}  // namespace

std::string utc_now() { return utc_of(system_clock::now()); }

TaiTime tai_now() {
  const auto now = system_clock::now();
  const auto below_ms = now - std::chrono::floor<std::chrono::milliseconds>(now);
  // A clock set before 1972 has no UTC, so its own count is used.
  return parse_utc(utc_of(now))
      .map([&](TaiTime whole_ms) { return whole_ms + below_ms; })
      .value_or(TaiTime{now.time_since_epoch()});
}

}  // namespace spindrift
