/// @file
/// Words of an alert for people, and its evidence as JSON.

#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "pipelines/supervision/condition_watch.h"

namespace spindrift {

/// Returns what, value, worst value, limit, UTC and advice, without the key: "sigma of the answer
/// in force: 1.4 deg, limit 1 at 2026-11-20T03:00:00.000Z: wait ...".
/// @param count How often the condition has begun so far.
std::string sentence_of(const ConditionChange& change, std::int64_t count = 1);

/// Returns what an alert is about, in a few words: "nothing from sun2".
/// @param key Key of an alert; returned as it is where it is unknown.
std::string words_of(const std::string& key);

/// Returns a JSON object.
std::string evidence_json(const Evidence& evidence, std::string_view config_sha256,
                          std::int64_t count = 1);

}  // namespace spindrift
