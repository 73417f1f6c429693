/// @file
/// Alters the texts of passes.

#pragma once

#include <gtest/gtest.h>

#include <sstream>
#include <string>
#include <utility>
#include <vector>

namespace spindrift {

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

}  // namespace spindrift
