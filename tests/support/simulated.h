/// @file
/// Passes that `spindrift simulate` has written from the delivered scenarios.

#pragma once

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "tests/support/altered_text.h"
#include "tests/support/ran.h"

namespace spindrift {

/// Runs `simulate`, which is expected to succeed.
struct Simulated {
  TemporaryFolder folder;
  std::filesystem::path pass = folder.path() / "pass";
  std::string scenario;  ///< Path of the scenario as changed.

  /// @param name File of the scenario.
  /// @param addition Text at the end of the scenario.
  explicit Simulated(const std::string& name, const Replacements& changes = {},
                     const std::string& addition = "")
      : scenario{folder.write("scenario.toml",
                              replaced(text_of(scenarios() / name), changes) + addition)} {
    succeeded({"simulate", scenario, "--out", pass});
  }

  /// Takes away the pulses of the channels whose names start with each of `channels`.
  const Simulated& without(const std::vector<std::string>& channels) const {
    for (const std::string& channel : channels) {
      const std::string csv = without_channel(channel, text_of(pass / "pulses.csv"));
      std::ofstream{pass / "pulses.csv"} << csv;
    }
    return *this;
  }
  std::filesystem::path mission() const { return pass / "mission.toml"; }
  /// Returns the command that publishes the pass.
  Words publish() const { return {"simulate", scenario, "--publish", "--speed", "0"}; }
};

}  // namespace spindrift
