/// @file
/// All QoS settings of spindrift.

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

/// Number of samples that a telemetry reader holds before it blocks its writers.
inline constexpr std::int32_t kTelemetryReaderSamples = 8192;

/// RELIABLE, KEEP_ALL, TRANSIENT_LOCAL, SHARED: a full reader blocks the writer and loses nothing.
/// Never max_instances: Cyclone 0.10.2 wedges a reader that reaches it.
Qos telemetry_reader_qos(std::int32_t max_samples = kTelemetryReaderSamples);

/// The same, and keeps the last minutes for a reader that joins late or returns.
Qos telemetry_writer_qos();

/// Results, alerts and health, for both sides: RELIABLE, TRANSIENT_LOCAL, KEEP_LAST 1 per instance,
/// so that a late joiner sees the current state and a slow one never blocks the service.
Qos results_qos();

/// Returns the QoS of publishers and subscribers.
Qos partition_qos(const std::string& partition);

}  // namespace spindrift::bus
