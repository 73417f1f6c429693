/// @file
/// Parsing of times on the command line.

#pragma once

#include <string>
#include <string_view>

#include "pipelines/core/expected.h"
#include "pipelines/time/tai_time.h"

namespace spindrift {

/// @param option As "--from". @return InvalidConfiguration for text that is not UTC ending in Z.
Expected<TaiTime> utc_option(std::string_view option, const std::string& text);

}  // namespace spindrift
