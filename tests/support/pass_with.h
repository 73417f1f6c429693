/// @file
/// Recorded passes with additions to their mission files.

#pragma once

#include <fstream>
#include <string>

#include "tests/support/recorded_files.h"

namespace spindrift {

struct PassWith : PassCopy {
  explicit PassWith(const std::string& addition) : PassCopy{"nominal"} { add(addition); }
  void add(const std::string& addition) const {
    std::ofstream{mission(), std::ios::app} << "\n" << addition;
  }
};

/// A target attitude far from the actual one.
inline constexpr const char* kOffTarget = "[spin.target]\nra_deg = 10.0\ndec_deg = 20.0\n";
/// A link that counts as silent after three seconds.
inline constexpr const char* kSoonSilent = "[alerts.\"link.silent\"]\nseconds = 3.0\n";

}  // namespace spindrift
