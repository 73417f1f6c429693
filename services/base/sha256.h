/// @file
/// What identifies a file: SHA-256 of its bytes, 64 lower-case hexadecimal digits.

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

/// Of what there is of `file` from where it is. @return Unavailable when reading fails, too.
Expected<std::string> sha256_hex(InputFile& file);

/// Of all bytes of the files, one behind the other. @return the errors of InputFile, too.
Expected<std::string> sha256_hex(std::span<const std::filesystem::path> files);

}  // namespace spindrift
