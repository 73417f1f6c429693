/// @file
/// What the doctor found, for a terminal and for programs.

#pragma once

#include <span>
#include <string>

#include "services/doctor/check.h"

namespace spindrift::doctor {

/// Ok when there are none.
Verdict worst_of(std::span<const Check> checks);

/// A list in columns, 100 wide where the words allow it, and a last line that sums it up.
/// @param verbose What is sound, too.
std::string to_text(std::span<const Check> checks, bool verbose);

/// One object on one line: "verdict", and "checks" of "name", "verdict", "found", "advice".
std::string to_json(std::span<const Check> checks);

}  // namespace spindrift::doctor
