/// @file
/// What the columns of a row of telemetry say.

#pragma once

#include <span>
#include <string_view>

#include "pipelines/core/expected.h"
#include "pipelines/spin/types/coded_frame.h"
#include "pipelines/spin/types/pulse.h"

namespace spindrift {

using RowFields = std::span<const std::string_view>;

/// Of the columns of their kind, without `spacecraft`, all there.
/// @return InvalidInput naming column, value and what is allowed (telemetry_time.h,
///         coded_check.h).
Expected<void> parse_row(RowFields fields, Pulse& pulse);
Expected<void> parse_row(RowFields fields, CodedFrame& frame);

}  // namespace spindrift
