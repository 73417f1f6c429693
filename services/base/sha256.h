/// @file
/// Identifies a file by the SHA-256 of its bytes, 64 lower-case hexadecimal digits.

#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <string_view>

#include "pipelines/core/expected.h"
#include "services/base/input_file.h"

namespace spindrift {

/// @return Unavailable when the cryptographic library refuses.
Expected<std::string> sha256_hex(std::string_view bytes);

/// Hashes `file` from its current position on. @return Also Unavailable when reading fails.
Expected<std::string> sha256_hex(InputFile& file);

/// Hashes the concatenation of the files. @return Also the errors of InputFile.
Expected<std::string> sha256_hex(std::span<const std::filesystem::path> files);

}  // namespace spindrift
