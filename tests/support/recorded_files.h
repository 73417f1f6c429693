/// @file
/// Paths of the recorded passes and command lines that process them.

#pragma once

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "tests/support/program.h"
#include "tests/support/test_paths.h"

namespace spindrift {

inline const std::filesystem::path kPasses = recorded_passes();

inline std::vector<std::string> arguments(const std::filesystem::path& mission,
                                          const std::filesystem::path& telemetry,
                                          const std::filesystem::path& db) {
  return {"process",          "--mission", mission.string(), "--telemetry",
          telemetry.string(), "--db",      db.string(),      "--json"};
}

inline std::vector<std::string> arguments(const std::string& pass,
                                          const std::filesystem::path& db) {
  return arguments(kPasses / pass / "mission.toml", kPasses / pass, db);
}

/// Holds a copy of a mission folder that a test may corrupt.
struct PassCopy {
  TemporaryFolder folder;
  std::filesystem::path db = folder.path() / "out.db";

  explicit PassCopy(const std::string& pass) {
    for (const char* name : {"mission.toml", "orbit.oem", "pulses.csv"}) {
      std::filesystem::copy(kPasses / pass / name, folder.path() / name);
    }
  }
  std::filesystem::path mission() const { return folder.path() / "mission.toml"; }
  /// Replaces the first occurrence of `text` in the mission file.
  void replace(const std::string& text, const std::string& by) const {
    std::string mission_text = text_of(mission());
    mission_text.replace(mission_text.find(text), text.size(), by);
    std::ofstream{mission()} << mission_text;
  }
  /// Adds lines at the end of the mission file.
  void append(std::string_view lines) const { std::ofstream{mission(), std::ios::app} << lines; }
  std::vector<std::string> arguments_here() const {
    return arguments(mission(), folder.path(), db);
  }
};

}  // namespace spindrift
