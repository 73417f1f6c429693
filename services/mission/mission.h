/// @file
/// The mission file: all that must be known of a spacecraft before its telemetry arrives.

#pragma once

#include <filesystem>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "pipelines/core/expected.h"
#include "pipelines/ephemeris/orbit.h"
#include "pipelines/spin/types/config.h"
#include "pipelines/supervision/limits.h"
#include "pipelines/three_axis/config.h"
#include "services/mission/mission_alignment.h"
#include "services/mission/mission_reconstruction.h"
#include "services/mission/scalar.h"
#include "services/mission/spacecraft_kind.h"

namespace spindrift {

struct Mission {
  std::string spacecraft_id;
  std::variant<SpinConfig, ThreeAxisConfig> config;  ///< In the order of SpacecraftKind.
  std::optional<SeparationPlan> separation;          ///< [reconstruction], if present.
  std::optional<Orbit> orbit;                        ///< Always set for a spinner.
  std::string toml_text;                             ///< Text of the mission file.
  std::string sha256;                                ///< Hash of toml_text, hexadecimal.
  std::optional<std::string> orbit_sha256;           ///< Hash of the orbit file, if named.
  std::set<std::string> tables;                      ///< Non-empty tables, "three_axis.gyro".
  std::vector<std::string> orbit_doubts;             ///< Orbit file sentences (mission_orbit.h).
  AlertLimits alerts = {};
  TomlValues alert_values = {};  ///< Values that `alerts` is made of.
  std::optional<SpinTarget> target = {};
  std::optional<Contact> contact = {};
  std::string preferred_source = {};                       ///< Value of [sources] prefer, or empty.
  double host_within_s = 60.0;                             ///< Value of [time] host_within_s.
  bool stores_residuals = true;                            ///< Value of [archive] residuals.
  std::optional<std::filesystem::path> ground_model = {};  ///< Path of the scenario file.
  std::vector<DefaultSigma> default_sigmas = {};  ///< Keys of alignment that the file does not say.
  std::filesystem::path path = {};                ///< Absolute; an orbit file is relative to it.

  SpacecraftKind kind() const { return static_cast<SpacecraftKind>(config.index()); }
  /// Returns null for any other spacecraft, as does `three_axis`.
  const SpinConfig* spin() const { return std::get_if<SpinConfig>(&config); }
  const ThreeAxisConfig* three_axis() const { return std::get_if<ThreeAxisConfig>(&config); }
};

/// Reads a mission file, and the orbit file that it names, by the rules of
/// schemas/mission.schema.toml.
/// @return InvalidConfiguration with every problem, one a line: "FILE:LINE: KEY = VALUE: what is
///         allowed", with the line if one is known.
Expected<Mission> load_mission(const std::filesystem::path& path);

/// Parses the text of a mission file.
/// @param path Path for messages; an orbit file is relative to it.
Expected<Mission> mission_of(const std::filesystem::path& path, std::string text);

/// Reads the mission file of a spinner. @return Also InvalidConfiguration for any other spacecraft.
Expected<Mission> load_spinner(const std::filesystem::path& path);

/// Returns when the geomagnetic model that the mission needs ends.
/// @return Empty for a spacecraft without a magnetometer.
std::optional<TaiTime> field_end(const Mission& mission);

}  // namespace spindrift
