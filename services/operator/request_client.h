/// @file
/// Sends a request to the program that holds an archive.
///
/// Nobody answers on the socket of a killed program. The caller then does the work itself, and the
/// next holder of the archive removes the socket.

#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>

#include "pipelines/core/expected.h"

namespace spindrift {

/// Waits for the answer. @return Empty when no program holds the archive; Unavailable when the
/// holder fails while answering.
Expected<std::optional<nlohmann::json>> ask_holder(const std::filesystem::path& archive,
                                                   const nlohmann::json& request);

}  // namespace spindrift
