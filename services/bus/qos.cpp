#include "services/bus/qos.h"

namespace spindrift::bus {
namespace {

// Limit on blocking in one attempt to write, which bounds the reaction time to a stop request.
constexpr dds_duration_t kMaxBlocking_ns = DDS_MSECS(100);

// Enough per spacecraft for ten minutes at 100 samples per second.
constexpr std::int32_t kTelemetryHistory = 60'000;

Qos reliable_qos() {
  Qos qos{dds_create_qos()};
  dds_qset_reliability(qos.get(), DDS_RELIABILITY_RELIABLE, kMaxBlocking_ns);
  dds_qset_durability(qos.get(), DDS_DURABILITY_TRANSIENT_LOCAL);
  dds_qset_ownership(qos.get(), DDS_OWNERSHIP_SHARED);
  // Instances must stay valid after their writer exits.
  dds_qset_writer_data_lifecycle(qos.get(), false);
  return qos;
}

Qos telemetry_qos() {
  Qos qos = reliable_qos();
  dds_qset_history(qos.get(), DDS_HISTORY_KEEP_ALL, DDS_LENGTH_UNLIMITED);
  return qos;
}

}  // namespace

Qos telemetry_reader_qos(std::int32_t max_samples) {
  Qos qos = telemetry_qos();
  dds_qset_resource_limits(qos.get(), max_samples, DDS_LENGTH_UNLIMITED, DDS_LENGTH_UNLIMITED);
  return qos;
}

Qos telemetry_writer_qos() {
  Qos qos = telemetry_qos();
  dds_qset_durability_service(qos.get(), 0, DDS_HISTORY_KEEP_LAST, kTelemetryHistory,
                              DDS_LENGTH_UNLIMITED, DDS_LENGTH_UNLIMITED, DDS_LENGTH_UNLIMITED);
  return qos;
}

Qos results_qos() {
  Qos qos = reliable_qos();
  dds_qset_history(qos.get(), DDS_HISTORY_KEEP_LAST, 1);
  return qos;
}

Qos partition_qos(const std::string& partition) {
  Qos qos{dds_create_qos()};
  dds_qset_partition1(qos.get(), partition.c_str());
  return qos;
}

}  // namespace spindrift::bus
