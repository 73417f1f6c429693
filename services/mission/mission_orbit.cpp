#include "services/mission/mission_orbit.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>

#include "pipelines/core/shown.h"
#include "pipelines/frames/angle.h"
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

}  // namespace spindrift
