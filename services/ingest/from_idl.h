/// @file
/// Telemetry of the bus as values of ours. The only place that reads the generated types of
/// telemetry.

#pragma once

#include <spindrift.h>

#include <string>

#include "pipelines/core/expected.h"
#include "services/ingest/sample_batch.h"

namespace spindrift {

Origin origin_from_idl(const spindrift_Pulse& pulse);

/// @return InvalidInput naming field, value and what is allowed, when the sample cannot be true:
/// spacecraft or source no name, time outside telemetry_time.h, channel unknown.
Expected<PulseSample> from_idl(const spindrift_Pulse& pulse);

/// `pulse` as what is stored in its place.
RejectedInput rejected_from_idl(const spindrift_Pulse& pulse, std::string reason);

}  // namespace spindrift
