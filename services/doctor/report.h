/// @file
/// Formats the results of the checks for a terminal and as JSON.

#pragma once

#include <span>
#include <string>

#include "services/doctor/check.h"

namespace spindrift::doctor {

/// Returns Ok when there are no checks.
Verdict worst_of(std::span<const Check> checks);

/// Returns a table, at most 100 wide where the words allow it, and a summary line.
/// @param verbose Whether passed checks are listed too.
std::string to_text(std::span<const Check> checks, bool verbose);

/// Returns one object on one line: "verdict", and "checks" of "name", "verdict", "found", "advice".
std::string to_json(std::span<const Check> checks);

}  // namespace spindrift::doctor
