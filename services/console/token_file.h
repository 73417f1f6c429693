/// @file
/// The token that authorises changes, in a file that only the service's user can read.

#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "pipelines/core/expected.h"

namespace spindrift {

/// Returns the token from the file "ARCHIVE.token", which it creates with mode 600 if needed.
/// @return InvalidConfiguration for a file that others can read, or that holds no token;
///         Unavailable where it can be neither read nor made.
Expected<std::string> token_of(const std::filesystem::path& archive);

/// Compares in a time that does not depend on where the tokens differ.
bool is_same_token(std::string_view token, std::string_view given);

}  // namespace spindrift
