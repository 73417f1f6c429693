/// @file
/// A small file as text, and what identifies it.

#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "pipelines/core/expected.h"

namespace spindrift {

/// @return InvalidConfiguration with the path and the reason for what is not a readable file.
Expected<std::string> read_text_file(const std::filesystem::path& path);

/// SHA-256 of the bytes, 64 lower-case hexadecimal digits.
/// @return Unavailable when the cryptographic library refuses.
Expected<std::string> sha256_hex(std::string_view bytes);

}  // namespace spindrift
