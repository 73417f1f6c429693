/// @file
/// Reads a file into a string.

#pragma once

#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

namespace spindrift {

inline std::string text_of(const std::filesystem::path& path) {
  std::ostringstream text;
  text << std::ifstream{path, std::ios::binary}.rdbuf();
  return text.str();
}

}  // namespace spindrift
