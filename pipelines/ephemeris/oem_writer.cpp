#include "pipelines/ephemeris/oem_writer.h"

#include <fmt/format.h>

#include <cassert>
#include <cstdint>
#include <iterator>

#include "pipelines/time/utc.h"

namespace spindrift {
namespace {

/// Formats a time without the final Z, as CCSDS leaves the time scale to TIME_SYSTEM.
std::string epoch(TaiTime t) {
  constexpr int kNanoseconds = 9;
  std::string text = format_utc(t, kNanoseconds);
  text.pop_back();
  return text;
}

}  // namespace

Expected<std::vector<EphemerisPoint>> sampled_orbit(const Orbit& orbit, TaiTime from, TaiTime to,
                                                    std::chrono::seconds step) {
  // Equal steps: two points close to each other would spoil the interpolation between them.
  const std::int64_t steps = (to - from + step - std::chrono::nanoseconds{1}) / step;
  std::vector<EphemerisPoint> points;
  for (std::int64_t i = 0; i <= steps; ++i) {
    const TaiTime t = i == steps ? to : from + (to - from) / steps * i;
    const auto state = orbit.at(t);
    if (!state) {
      return Unexpected{state.error()};
    }
    points.push_back({.t = t, .state = *state});
  }
  return points;
}

std::string oem_text(std::string_view object, TaiTime created,
                     const std::vector<EphemerisPoint>& points) {
  assert(points.size() >= 2);
  std::string text = fmt::format(
      "CCSDS_OEM_VERS = 2.0\n"
      "CREATION_DATE = {}\n"
      "ORIGINATOR = SPINDRIFT\n\n"
      "META_START\n"
      "OBJECT_NAME = {}\n"
      "OBJECT_ID = {}\n"
      "CENTER_NAME = EARTH\n"
      "REF_FRAME = EME2000\n"
      "TIME_SYSTEM = UTC\n"
      "START_TIME = {}\n"
      "STOP_TIME = {}\n"
      "INTERPOLATION = HERMITE\n"
      "INTERPOLATION_DEGREE = 7\n"
      "META_STOP\n\n",
      epoch(created), object, object, epoch(points.front().t), epoch(points.back().t));
  for (const EphemerisPoint& point : points) {
    const Eigen::Vector3d& r = point.state.position_icrf_km;
    const Eigen::Vector3d& v = point.state.velocity_icrf_km_s;
    fmt::format_to(std::back_inserter(text), "{} {:.9f} {:.9f} {:.9f} {:.12f} {:.12f} {:.12f}\n",
                   epoch(point.t), r.x(), r.y(), r.z(), v.x(), v.y(), v.z());
  }
  return text;
}

}  // namespace spindrift
