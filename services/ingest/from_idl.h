/// @file
/// Telemetry of the bus as values of ours. The only place that reads the generated types of
/// telemetry.

#pragma once

#include <spindrift.h>

#include <string>

#include "pipelines/core/expected.h"
#include "services/ingest/sample_batch.h"

namespace spindrift {

/// Of any telemetry sample.
template <class Sample>
Origin origin_from_idl(const Sample& sample) {
  return {.source = sample.source, .session = sample.session, .seq = sample.seq};
}

/// @return InvalidInput naming field, value and what is allowed, when the sample cannot be true:
/// spacecraft or source no name, time outside telemetry_time.h, channel unknown.
Expected<PulseSample> from_idl(const spindrift_Pulse& pulse);

/// NaN becomes "not received". @return InvalidInput likewise; intervals: see coded_check.h.
Expected<CodedSample> from_idl(const spindrift_CodedFrame& frame);

/// What is stored in the place of a telemetry sample of `origin`.
RejectedInput rejected_from_idl(const Origin& origin, std::string reason);

}  // namespace spindrift
