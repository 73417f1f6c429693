#include "services/mission/mission_orbit.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>

#include "pipelines/core/shown.h"
#include "pipelines/ephemeris/oem_holes.h"
#include "pipelines/ephemeris/orbit_steps.h"
#include "pipelines/ephemeris/state_jump.h"
#include "pipelines/frames/angle.h"
#include "pipelines/time/utc.h"
#include "services/base/file_lines.h"
#include "services/base/sha256.h"
#include "services/mission/values.h"

namespace spindrift {
namespace {

Expected<std::optional<OemLine>> next_line(FileLines& lines) {
  FileLine line{};
  return lines.next(line).and_then([&](bool there) -> Expected<std::optional<OemLine>> {
    if (!there) {
      return std::nullopt;
    }
    if (line.too_long) {
      return Unexpected{
          {ErrorCode::InvalidConfiguration, fmt::format("line {}: must be {} bytes long at most",
                                                        line.number, FileLines::kLongestLine)}};
    }
    return OemLine{.number = static_cast<int>(line.number), .text = line.text};
  });
}

/// Hashes and parses the same open file, so that both see the same bytes.
Expected<MissionOrbit> orbit_from(InputFile file) {
  auto sha256 = sha256_hex(file);
  if (!sha256) {
    return Unexpected{std::move(sha256.error())};
  }
  if (auto begun = file.rewind(); !begun) {
    return Unexpected{std::move(begun.error())};
  }
  FileLines lines{std::move(file)};
  return parse_oem([&lines] { return next_line(lines); }).map([&](OrbitEphemeris&& ephemeris) {
    return MissionOrbit{.orbit = Orbit{std::move(ephemeris)}, .file_sha256 = std::move(*sha256)};
  });
}

Expected<MissionOrbit> orbit_from_oem(const std::string& oem, const std::filesystem::path& folder) {
  return InputFile::open(folder / oem, kMostOrbitBytes)
      .and_then([](InputFile&& file) { return orbit_from(std::move(file)); })
      .map_error([&](const Error& error) {
        return Error{ErrorCode::InvalidConfiguration,
                     fmt::format("orbit.oem = \"{}\": {}", shown(oem), error.message)};
      });
}

Expected<MissionOrbit> orbit_from_elements(const TomlValues& values) {
  const auto element = [&](std::string_view key) {
    return number(values, fmt::format("orbit.elements.{}", key));
  };
  const auto orbit = KeplerOrbit::make(
      {.epoch = tai_from_ns(value_of<std::int64_t>(values, "orbit.elements.epoch_tai_ns")),
       .semi_major_axis_km = element("a_km"),
       .eccentricity = element("e"),
       .inclination_rad = element("i_deg") * kRadPerDeg,
       .raan_rad = element("raan_deg") * kRadPerDeg,
       .argument_of_perigee_rad = element("argp_deg") * kRadPerDeg,
       .mean_anomaly_rad = element("mean_anomaly_deg") * kRadPerDeg});
  if (!orbit) {
    return Unexpected{{ErrorCode::InvalidConfiguration,
                       fmt::format("[orbit.elements]: {}", orbit.error().message)}};
  }
  return MissionOrbit{.orbit = Orbit{*orbit}, .file_sha256 = std::nullopt};
}

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

std::string_view orbit_key(const TomlValues& values) {
  return values.contains("orbit.oem") ? "orbit.oem" : "orbit.elements";
}

Expected<MissionOrbit> load_orbit(const TomlValues& values, const std::filesystem::path& folder) {
  if (const auto oem = values.find("orbit.oem"); oem != values.end()) {
    return orbit_from_oem(std::get<std::string>(oem->second), folder);
  }
  static constexpr std::array<std::string_view, 7> kElements = {
      "orbit.elements.epoch_tai_ns",    "orbit.elements.a_km",     "orbit.elements.e",
      "orbit.elements.i_deg",           "orbit.elements.raan_deg", "orbit.elements.argp_deg",
      "orbit.elements.mean_anomaly_deg"};
  const bool complete = std::all_of(kElements.begin(), kElements.end(),
                                    [&](std::string_view key) { return values.contains(key); });
  return complete ? orbit_from_elements(values) : MissionOrbit{};
}

std::vector<std::string> orbit_doubts(const OrbitEphemeris& ephemeris, std::string_view file,
                                      std::string_view spacecraft_id) {
  std::vector<std::string> doubts = {
      doubt_about_name(ephemeris, spacecraft_id), doubt_about_jumps(ephemeris, file),
      doubt_about_steps(ephemeris, file), doubt_about_gaps(ephemeris, file)};
  std::erase(doubts, std::string{});
  return doubts;
}

}  // namespace spindrift
