/// @file
/// Words of an alert for people, and its evidence as JSON.

#pragma once

#include <string>
#include <string_view>

#include "pipelines/supervision/condition_watch.h"

namespace spindrift {

/// Returns what, value, limit, UTC and advice, without the key: "sigma of the answer in force: 1.4
/// deg, limit 1 at 2026-11-20T03:00:00.000Z: wait ...".
std::string sentence_of(const ConditionChange& change);

/// Returns a JSON object.
std::string evidence_json(const Evidence& evidence, std::string_view config_sha256);

}  // namespace spindrift
