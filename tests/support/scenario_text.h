/// @file
/// Edits the text of scenario files.

#pragma once

#include <gtest/gtest.h>

#include <string>

#include "services/simulation/scenario.h"
#include "tests/support/temporary_folder.h"

namespace spindrift::testing {

inline Expected<Scenario> loaded(const std::string& text) {
  const TemporaryFolder folder;
  return load_scenario(folder.write("scenario.toml", text));
}

inline std::string error_of(const std::string& text) {
  const auto scenario = loaded(text);
  return scenario ? "no error" : scenario.error().message;
}

/// Replaces the first occurrence of `from`, which must exist.
inline std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const auto at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return at == std::string::npos ? text : text.replace(at, from.size(), to);
}

}  // namespace spindrift::testing
