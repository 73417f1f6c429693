/// @file
/// A file of points that a command is asked about: a header, then a row each.

#pragma once

#include <filesystem>
#include <functional>
#include <string_view>

#include "pipelines/core/expected.h"
#include "services/base/file_lines.h"

namespace spindrift {

/// Calls `take` with each row behind the header, until it refuses one.
/// @return InvalidConfiguration naming file, line and what `take` says, or the header that is
///         missing; Unavailable when reading fails.
Expected<void> for_each_row(const std::filesystem::path& path, std::string_view header,
                            const std::function<Expected<void>(const FileLine&)>& take);

}  // namespace spindrift
