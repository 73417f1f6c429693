/// @file
/// Edits the text of scenario files.

#pragma once

#include <string>
#include <vector>

#include "services/simulation/scenario.h"
#include "tests/support/matchers.h"
#include "tests/support/outcome.h"
#include "tests/support/temporary_folder.h"

namespace spindrift::testing {

inline Expected<Scenario> load(const std::string& text) {
  const TemporaryFolder folder;
  return load_scenario(folder.write("scenario.toml", text));
}

inline Scenario loaded(const std::string& text) { return value_or_throw(load(text)); }

inline std::string error_of(const std::string& text) {
  const auto scenario = load(text);
  return scenario ? "no error" : scenario.error().message;
}

/// Expects all of these problems in the refusal of a text.
inline void expect_problems(const std::string& text, const std::vector<std::string>& problems) {
  const std::string error = error_of(text);
  for (const std::string& problem : problems) {
    EXPECT_THAT(error, HasSubstr(problem));
  }
}

/// Replaces the first occurrence of `from`, which must exist.
inline std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const auto at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return at == std::string::npos ? text : text.replace(at, from.size(), to);
}

}  // namespace spindrift::testing
