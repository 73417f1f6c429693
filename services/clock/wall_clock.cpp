#include "services/clock/wall_clock.h"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <chrono>

#include "pipelines/time/utc.h"

namespace spindrift {

std::string utc_now() {
  using namespace std::chrono;
  const auto now = floor<milliseconds>(system_clock::now());
  const auto seconds = floor<std::chrono::seconds>(now);
  return fmt::format("{:%Y-%m-%dT%H:%M:%S}.{:03}Z", fmt::gmtime(system_clock::to_time_t(seconds)),
                     (now - seconds).count());
}

TaiTime tai_now() {
  const std::string now_utc = utc_now();
  // A clock set before 1972 has no UTC; its own count is then all there is.
  return parse_utc(now_utc).value_or(TaiTime{std::chrono::system_clock::now().time_since_epoch()});
}

}  // namespace spindrift
