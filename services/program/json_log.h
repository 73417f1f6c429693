/// @file
/// The machine-readable log.

#pragma once

namespace spindrift {

/// Makes each later log message a JSON object on one line with `utc`, `level` and `text`.
void log_as_json();

}  // namespace spindrift
