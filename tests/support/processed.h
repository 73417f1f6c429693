/// @file
/// Passes that `spindrift process` has put into archives of their own.

#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "tests/support/ran.h"
#include "tests/support/recorded_files.h"

namespace spindrift {

/// Runs `process`, which is expected to succeed.
struct Processed {
  TemporaryFolder folder;
  std::filesystem::path db = folder.path() / "out.db";
  std::string log;
  nlohmann::json answer;
  nlohmann::json run;  ///< Run object of the answer.

  /// @param pass Name of a recorded pass, or folder of another one.
  explicit Processed(const std::filesystem::path& pass, const Words& more = {}) {
    const std::filesystem::path files = kPasses / pass;
    const Ran program = succeeded(with(arguments(files / "mission.toml", files, db), more));
    log = program.log;
    answer = program.json();
    run = answer["runs"][0];
  }
};

/// Expects the nominal pass with this text in one of its files to be refused before it is stored.
inline void expect_refused(const std::string& file, const std::string& text, const Words& says) {
  const PassCopy pass{"nominal"};
  pass.folder.write(file, text);
  refused(pass.arguments_here(), says);
  EXPECT_FALSE(std::filesystem::exists(pass.db));
}

}  // namespace spindrift
