#include "pipelines/observation/sensor_contradiction.h"

namespace spindrift {

std::string sensor_name_of(SampleSource source) {
  return source == SampleSource::OrbitState ? "orbit" : std::string{name_of(source)};
}

std::string culprit_name_of(const SensorContradiction& contradiction) {
  return contradiction.culprit ? sensor_name_of(*contradiction.culprit)
                               : std::string{kUnknownCulprit};
}

std::vector<std::string> opponents_of(const SensorContradiction& contradiction) {
  std::vector<std::string> names;
  for (const SampleSource source : contradiction.with) {
    names.push_back(sensor_name_of(source));
  }
  return names;
}

std::string opponents_text(const SensorContradiction& contradiction) {
  std::string text;
  for (const std::string& name : opponents_of(contradiction)) {
    text += (text.empty() ? "" : ", ") + name;
  }
  return text;
}

Reason reason_of(const SensorContradiction& contradiction) {
  return {ReasonCode::Contradicted,
          {{"sensor", culprit_name_of(contradiction)},
           {"with", opponents_text(contradiction)},
           contradiction.off,
           {"sigmas", contradiction.sigmas},
           {"since_tai_ns", tai_ns(contradiction.since)}}};
}

}  // namespace spindrift
