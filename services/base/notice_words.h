/// @file
/// The notices of a pass, and why a revolution gives no spin axis, as sentences for people.

#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

#include "pipelines/core/notice.h"

namespace spindrift {

/// Returns a name such as "late_edges".
std::string_view name_of(NoticeCode code);

/// Returns the notice's values by name, and those of the reason for a missing fix.
nlohmann::json values_of(const Notice& notice);

std::string sentence_of(const Notice& notice);
std::string sentence_of(const WhyNoFix& why);

}  // namespace spindrift
