#include "services/mission/orbit_doubts.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "pipelines/core/shown.h"
#include "pipelines/ephemeris/oem_holes.h"
#include "pipelines/ephemeris/orbit_steps.h"
#include "pipelines/ephemeris/state_jump.h"
#include "pipelines/frames/angle.h"
#include "pipelines/time/utc.h"

namespace spindrift {
namespace {

/// Returns empty without a doubt.
std::string doubt_about_name(const OrbitEphemeris& ephemeris, std::string_view spacecraft_id) {
  const auto& segments = ephemeris.segments();
  const auto other = std::find_if(segments.begin(), segments.end(), [&](const OemSegment& segment) {
    return segment.object_name != spacecraft_id && segment.object_id != spacecraft_id;
  });
  return other == segments.end()
             ? std::string{}
             : fmt::format(
                   "the orbit file says OBJECT_NAME = {}, OBJECT_ID = {}, the mission "
                   "file spacecraft.id = \"{}\"",
                   shown(other->object_name), shown(other->object_id), spacecraft_id);
}

/// Returns empty without a doubt.
std::string doubt_about_jumps(const OrbitEphemeris& ephemeris, std::string_view file) {
  const std::vector<OrbitJump> jumps = orbit_jumps(ephemeris);
  if (jumps.empty()) {
    return {};
  }
  const auto nadir_off_deg = [](const OrbitJump& jump) {
    return std::atan2(jump.off_km, jump.to.state.position_icrf_km.norm()) * kDegPerRad;
  };
  const OrbitJump& worst = *std::max_element(
      jumps.begin(), jumps.end(),
      [&](const OrbitJump& a, const OrbitJump& b) { return nadir_off_deg(a) < nadir_off_deg(b); });
  const OrbitJump& first = jumps.front();
  return fmt::format(
      "orbit.oem = \"{}\", line {}: the orbit jumps by {:.3g} km at {}{}: states of different "
      "solutions spliced? The nadir direction is off by up to {:.2g} deg there, the axis by "
      "several times that where the geometry is poor",
      shown(file), first.to.line, first.off_km, format_utc(first.to.t),
      jumps.size() == 1 ? std::string{} : fmt::format(", the first of {} such steps", jumps.size()),
      nadir_off_deg(worst));
}

/// Returns a doubt about segments that do not meet although nothing jumps; empty without one.
std::string doubt_about_steps(const OrbitEphemeris& ephemeris, std::string_view file) {
  std::vector<OrbitStep> steps = orbit_steps(ephemeris);
  for (const OrbitJump& jump : orbit_jumps(ephemeris)) {
    std::erase_if(steps, [&](const OrbitStep& step) { return step.line == jump.to.line; });
  }
  if (steps.empty()) {
    return {};
  }
  const OrbitStep& first = steps.front();
  return fmt::format(
      "orbit.oem = \"{}\", line {}: two segments do not meet at {}: by {:.3f} km and {:.2f} m/s{}: "
      "a manoeuvre, or segments of different solutions? Answers that rest on both are DOUBTFUL",
      shown(file), first.line, format_utc(first.to), first.off_km, 1e3 * first.off_km_s,
      steps.size() == 1 ? std::string{}
                        : fmt::format(", the first of {} such steps", steps.size()));
}

/// Returns empty without a doubt.
std::string doubt_about_gaps(const OrbitEphemeris& ephemeris, std::string_view file) {
  const std::vector<OrbitGap> gaps = orbit_gaps(ephemeris);
  if (gaps.empty()) {
    return {};
  }
  const auto longest = std::max_element(
      gaps.begin(), gaps.end(),
      [](const OrbitGap& a, const OrbitGap& b) { return a.to - a.from < b.to - b.from; });
  return fmt::format(
      "orbit.oem = \"{}\", line {}: no orbit for {:.9g} s before it, from {} to {}{}: the states "
      "there are too far apart or belong to different segments, and nothing is computed between",
      shown(file), longest->line, seconds_between(longest->from, longest->to),
      format_utc(longest->from), format_utc(longest->to),
      gaps.size() == 1 ? std::string{} : fmt::format(", the longest of {} gaps", gaps.size()));
}

}  // namespace

std::vector<std::string> orbit_doubts(const OrbitEphemeris& ephemeris, std::string_view file,
                                      std::string_view spacecraft_id) {
  std::vector<std::string> doubts = {
      doubt_about_name(ephemeris, spacecraft_id), doubt_about_jumps(ephemeris, file),
      doubt_about_steps(ephemeris, file), doubt_about_gaps(ephemeris, file)};
  std::erase(doubts, std::string{});
  return doubts;
}

}  // namespace spindrift
