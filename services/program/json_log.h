/// @file
/// The log for programs.

#pragma once

namespace spindrift {

/// From here on each message is an object on one line: `utc`, `level`, `text`.
void log_as_json();

}  // namespace spindrift
