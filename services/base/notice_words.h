/// @file
/// The notices of a pass as sentences for people.

#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

#include "pipelines/core/notice.h"

namespace spindrift {

/// In words with underscores: "late_edges".
std::string_view name_of(NoticeCode code);

/// Its values by their names, and those of why there is no fix.
nlohmann::json values_of(const Notice& notice);

std::string sentence_of(const Notice& notice);

}  // namespace spindrift
