/// @file
/// Runs `spindrift process` on recorded, simulated and altered passes.

#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "tests/support/program.h"
#include "tests/support/test_paths.h"

namespace spindrift {

struct Outcome {
  int status;
  nlohmann::json run;  ///< Run object of the JSON summary.
  std::string log;
  std::filesystem::path db;
  nlohmann::json warnings = {};
};

inline Outcome process(const TemporaryFolder& folder, const std::filesystem::path& pass) {
  const auto db = folder.path() / "out.db";
  Program program{{"process", "--mission", (pass / "mission.toml").string(), "--telemetry",
                   pass.string(), "--db", db.string(), "--json"}};
  const int status = program.exit_status();
  const auto answer = nlohmann::json::parse(program.out());
  return {.status = status,
          .run = answer.contains("runs") ? answer["runs"][0] : answer,
          .log = program.log(),
          .db = db,
          .warnings = answer["warnings"]};
}

using Replacements = std::vector<std::pair<std::string, std::string>>;

inline std::string replaced(std::string text, const Replacements& replacements) {
  for (const auto& [from, to] : replacements) {
    const auto at = text.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    text.replace(at, from.size(), to);
  }
  return text;
}

/// Returns a pulse file without the rows of channels whose name starts with `channel`.
inline std::string without_channel(const std::string& channel, const std::string& csv) {
  std::istringstream lines{csv};
  std::string kept;
  for (std::string line; std::getline(lines, line);) {
    if (line.find("," + channel) == std::string::npos) {
      kept += line + "\n";
    }
  }
  return kept;
}

/// Simulates deploy/scenarios/gto-nominal.toml with these replacements and returns its folder.
inline std::filesystem::path simulated_pass(const TemporaryFolder& folder,
                                            const Replacements& replacements) {
  const auto nominal = scenarios() / "gto-nominal.toml";
  const auto scenario = folder.write("scenario.toml", replaced(text_of(nominal), replacements));
  const auto pass = folder.path() / "pass";
  Program simulate{{"simulate", scenario.string(), "--out", pass.string()}};
  EXPECT_EQ(simulate.exit_status(), 0) << simulate.log();
  return pass;
}

/// Simulates a pass and processes it without the channels that start with `dead_channels`.
inline Outcome process_simulated(const TemporaryFolder& folder, const Replacements& replacements,
                                 const std::vector<std::string>& dead_channels = {}) {
  const auto pass = simulated_pass(folder, replacements);
  std::string csv = text_of(pass / "pulses.csv");
  for (const std::string& channel : dead_channels) {
    csv = without_channel(channel, csv);
  }
  std::ofstream{pass / "pulses.csv"} << csv;
  return process(folder, pass);
}

}  // namespace spindrift
