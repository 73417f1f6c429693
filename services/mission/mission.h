/// @file
/// The mission file: everything that must be known of a spacecraft before its telemetry arrives.

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
#include "services/mission/mission_reconstruction.h"
#include "services/mission/spacecraft_kind.h"

namespace spindrift {

struct Mission {
  std::string spacecraft_id;
  std::variant<SpinConfig, ThreeAxisConfig> config;  ///< In the order of SpacecraftKind.
  std::optional<SeparationPlan> separation;          ///< [reconstruction], where there is one.
  std::optional<Orbit> orbit;                        ///< Always there for a spinner.
  std::string toml_text;                             ///< The file as read.
  std::string sha256;                                ///< Of toml_text, hexadecimal.
  std::optional<std::string> orbit_sha256;           ///< Of the orbit file, if one is named.
  std::set<std::string> tables;                      ///< That have values, "three_axis.gyro".
  std::vector<std::string> orbit_doubts;  ///< About that file, for people (orbit_doubts.h).
  AlertLimits alerts = {};
  std::optional<SpinTarget> target = {};
  std::optional<Contact> contact = {};
  std::string preferred_source = {};                       ///< [sources] prefer; empty: none.
  bool stores_residuals = true;                            ///< [archive] residuals.
  std::optional<std::filesystem::path> ground_model = {};  ///< The scenario's file.
  std::filesystem::path path = {};  ///< Absolute; an orbit file is relative to it.

  SpacecraftKind kind() const { return static_cast<SpacecraftKind>(config.index()); }
  /// Null for any other spacecraft.
  const SpinConfig* spin() const { return std::get_if<SpinConfig>(&config); }
  const ThreeAxisConfig* three_axis() const { return std::get_if<ThreeAxisConfig>(&config); }
};

/// Reads a mission file, and the orbit file that it names, by the rules of
/// schemas/mission.schema.toml.
/// @return InvalidConfiguration with every problem, one a line:
///         "FILE:LINE: KEY = VALUE: what is allowed"; the line where one is to blame.
Expected<Mission> load_mission(const std::filesystem::path& path);

/// Likewise of a text that was read before.
/// @param path Named in problems; an orbit file is relative to it.
Expected<Mission> mission_of(const std::filesystem::path& path, std::string text);

/// That of a spinner. @return InvalidConfiguration for any other, too.
Expected<Mission> load_spinner(const std::filesystem::path& path);

/// When the model of the Earth's magnetic field ends that the mission needs.
/// @return Empty where the spacecraft has no magnetometer.
std::optional<TaiTime> field_end(const Mission& mission);

}  // namespace spindrift
