/// @file
/// Instants. Everything in spindrift is stamped in TAI, integer nanoseconds; UTC is text.

#pragma once

#include <chrono>
#include <cstdint>

namespace spindrift {

/// International Atomic Time since 1970-01-01T00:00:00 TAI.
///
/// A clock without `now()`: a pipeline can compare and subtract instants but cannot read the wall
/// clock. (libstdc++ 12 has no `std::chrono::tai_clock`, whose epoch is 1958 besides.)
struct TaiClock {
  using duration = std::chrono::nanoseconds;
  using rep = duration::rep;
  using period = duration::period;
  using time_point = std::chrono::time_point<TaiClock>;
  static constexpr bool is_steady = false;
};
using TaiTime = TaiClock::time_point;

inline constexpr double kHour_s = 3600.0;

constexpr TaiTime tai_from_ns(std::int64_t t_tai_ns) {
  return TaiTime{std::chrono::nanoseconds{t_tai_ns}};
}
constexpr std::int64_t tai_ns(TaiTime t) { return t.time_since_epoch().count(); }

/// `later - earlier` in seconds. Exact subtraction first: a double cannot hold the epoch's
/// nanoseconds, but it holds any pass's.
constexpr double seconds_between(TaiTime earlier, TaiTime later) {
  return static_cast<double>((later - earlier).count()) * 1e-9;
}

/// `t` moved by `offset_s` seconds, to the nearest nanosecond.
constexpr TaiTime shifted(TaiTime t, double offset_s) {
  const double offset_ns = offset_s * 1e9;
  return t + std::chrono::nanoseconds{
                 static_cast<std::int64_t>(offset_ns < 0.0 ? offset_ns - 0.5 : offset_ns + 0.5)};
}

}  // namespace spindrift
