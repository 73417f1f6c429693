/// @file
/// Asking the program that holds an archive.

#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>

#include "pipelines/core/expected.h"

namespace spindrift {

/// Waits for the answer. @return Empty where nobody answers for the archive; Unavailable when who
/// does fails meanwhile.
Expected<std::optional<nlohmann::json>> ask_holder(const std::filesystem::path& archive,
                                                   const nlohmann::json& request);

}  // namespace spindrift
