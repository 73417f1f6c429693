#include "services/operator/known_spacecraft.h"

#include "pipelines/spin/measurement/edge_use.h"
#include "pipelines/three_axis/sample_kind.h"
#include "services/telemetry/telemetry_kinds.h"

namespace spindrift {
namespace {

std::vector<std::string_view> channels_of(const SpinConfig& config) {
  std::vector<std::string_view> channels;
  for (std::size_t i = 0; i < kPulseChannels; ++i) {
    const auto channel = static_cast<PulseChannel>(i);
    if (has_sensor(config, channel)) {
      channels.push_back(name_of(channel));
    }
  }
  return channels;
}

std::vector<std::string_view> sensors_of(const Mission& mission) {
  std::vector<std::string_view> sensors;
  TelemetryKinds::for_each([&]<class Value>(Kind<Value> /*kind*/) {
    if constexpr (requires(Value value) { kind_of(value); }) {
      if (mission.tables.contains(std::string{Telemetry<Value>::kSensor})) {
        sensors.push_back(name_of(kind_of(Value{})));
      }
    }
  });
  return sensors;
}

bool may_have(const Mission& mission, AlertCode code) {
  switch (code) {
    case AlertCode::AttitudeDoubtful:
    case AlertCode::AttitudeNoAnswer:
    case AlertCode::AttitudeDiverged:
    case AlertCode::SensorStuck:
      return mission.kind() == SpacecraftKind::ThreeAxis;
    case AlertCode::ReconstructionLauncher:
      return mission.separation.has_value();
    case AlertCode::ModelDeparture:
      return mission.ground_model.has_value();
    default:
      return mission.kind() == SpacecraftKind::Spin || !name_of(code).starts_with("spin.");
  }
}

Nameable nameable_of(const Mission& mission) {
  Nameable known{.kind = mission.kind(), .channels = {}, .alerts = {}};
  known.channels = mission.spin() != nullptr ? channels_of(*mission.spin()) : sensors_of(mission);
  for (int i = 0; i < kAlertCodes; ++i) {
    if (const auto code = static_cast<AlertCode>(i); may_have(mission, code)) {
      known.alerts.push_back(name_of(code));
    }
  }
  return known;
}

}  // namespace

KnownSpacecraft known_spacecraft(const std::vector<Mission>& missions) {
  KnownSpacecraft known;
  for (const Mission& mission : missions) {
    known.emplace(mission.spacecraft_id, nameable_of(mission));
  }
  return known;
}

}  // namespace spindrift
