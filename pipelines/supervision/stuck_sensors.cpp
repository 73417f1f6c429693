#include "pipelines/supervision/stuck_sensors.h"

#include <cstddef>

#include "pipelines/time/time_span.h"

namespace spindrift {

void StuckSensors::take_up(std::string_view sensor) {
  for (std::size_t i = 0; i < kSampleKinds; ++i) {
    const auto kind = static_cast<SampleKind>(i);
    if (name_of(kind) == sensor) {
      sensors_.try_emplace(kind, kind);
    }
  }
}

ConditionChanges StuckSensors::see_left_out(const RejectedSample& sample) {
  ConditionChanges changes;
  if (sample.rejected_by == Rejection::Frozen) {
    Sensor& sensor = sensors_.try_emplace(sample.kind, sample.kind).first->second;
    if (elapsed_s(sensor.last, sample.t) >= limit_s_) {
      sensor.since = sample.t;
    }
    sensor.last = sample.t;
    add(sensor.watch.update(sample.t,
                            {.value = elapsed_s(sensor.since, sample.t), .limit = limit_s_}),
        changes);
  }
  return changes;
}

ConditionChanges StuckSensors::see_answer(TaiTime t) {
  ConditionChanges changes;
  for (auto& [kind, sensor] : sensors_) {
    if (elapsed_s(sensor.last, t) >= limit_s_) {
      add(sensor.watch.update(t, {.value = 0.0, .limit = limit_s_}), changes);
    }
  }
  return changes;
}

}  // namespace spindrift
