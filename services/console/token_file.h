/// @file
/// The token of those who may change something, in a file that only the service's user can read.

#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "pipelines/core/expected.h"

namespace spindrift {

/// That of an archive: its path plus `.token`. Made, of mode 600, where there is none.
/// @return InvalidConfiguration for a file that others can read, or that holds no token;
///         Unavailable where it can be neither read nor made.
Expected<std::string> token_of(const std::filesystem::path& archive);

/// In a time that tells nothing of where they differ.
bool is_same_token(std::string_view token, std::string_view given);

}  // namespace spindrift
