/// @file
/// All quality of service of spindrift, in one place.

#pragma once

#include <dds/dds.h>

#include <cstdint>
#include <memory>
#include <string>

namespace spindrift::bus {

struct DeleteQos {
  void operator()(dds_qos_t* qos) const { dds_delete_qos(qos); }
};
using Qos = std::unique_ptr<dds_qos_t, DeleteQos>;

/// Samples that a telemetry reader holds before it pushes back on its writers.
inline constexpr std::int32_t kTelemetryReaderSamples = 8192;

/// RELIABLE, KEEP_ALL, TRANSIENT_LOCAL, SHARED: a reader that is not drained makes the writer wait
/// and loses nothing. Never max_instances: Cyclone 0.10.2 wedges a reader that reaches it.
Qos telemetry_reader_qos(std::int32_t max_samples = kTelemetryReaderSamples);

/// The same, with the last minutes kept for a reader that joins late or comes back.
Qos telemetry_writer_qos();

/// Results, alerts and health, both sides: RELIABLE, TRANSIENT_LOCAL, KEEP_LAST 1 per instance, so
/// that a late joiner sees the current state and a slow one never holds up the service.
Qos results_qos();

/// For publishers and subscribers.
Qos partition_qos(const std::string& partition);

}  // namespace spindrift::bus
