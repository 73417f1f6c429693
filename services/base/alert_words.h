/// @file
/// What an alert says to people, and its evidence for programs.

#pragma once

#include <string>
#include <string_view>

#include "pipelines/supervision/condition_watch.h"

namespace spindrift {

/// "sigma of the answer in force: 1.4 deg, limit 1 at 2026-11-20T03:00:00.000Z: wait ...": what,
/// value, limit, UTC and what to do. The key stands beside it.
std::string sentence_of(const ConditionChange& change);

/// A JSON object.
std::string evidence_json(const Evidence& evidence, std::string_view config_sha256);

}  // namespace spindrift
