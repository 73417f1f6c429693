/// @file
/// Whether anything stands against acting on what is known of a spacecraft.

#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "pipelines/supervision/limits.h"

namespace spindrift {

/// Unknown is never go.
/// @param shown The spacecraft as in /api/v1/state. @param alerts Its open ones, likewise.
/// @param trouble Why the service takes or stores nothing; empty: it does.
/// @return `is_go` and `against`: of each thing that stands against it `code` and `text`.
nlohmann::json go_no_go(const nlohmann::json& shown, const nlohmann::json& alerts,
                        const std::string& trouble, const AlertLimits& limits);

}  // namespace spindrift
