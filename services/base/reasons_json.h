/// @file
/// Reasons as in the archive: a JSON array of objects with `code` and the values by name.

#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "pipelines/core/assessment.h"

namespace spindrift {

std::string to_json_text(std::span<const Reason> reasons);

/// Parses the array and skips reasons unknown to this program.
std::vector<Reason> reasons_of(std::string_view text);

}  // namespace spindrift
