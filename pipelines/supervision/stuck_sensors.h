/// @file
/// Detects sensors of a three-axis spacecraft that repeat themselves.

#pragma once

#include <map>
#include <string>
#include <string_view>

#include "pipelines/supervision/condition_watch.h"
#include "pipelines/three_axis/products.h"

namespace spindrift {

/// Watches the samples that were left out as frozen, in telemetry time.
class StuckSensors {
 public:
  explicit StuckSensors(double limit_s) : limit_s_{limit_s} {}

  void set_limit_s(double limit_s) { limit_s_ = limit_s; }
  /// Takes up the open alert about a sensor, which ends if the sensor does not repeat itself.
  void take_up(std::string_view sensor);
  ConditionChanges see_left_out(const RejectedSample& sample);
  /// @param t Time of an answer, to which all samples before it have contributed.
  ConditionChanges see_answer(TaiTime t);

 private:
  struct Sensor {
    explicit Sensor(SampleKind kind)
        : watch{AlertCode::SensorStuck, "s", {}, std::string{name_of(kind)}} {}
    ConditionWatch watch;
    TaiTime since = TaiTime::min();
    TaiTime last = TaiTime::min();  ///< Time of its last sample that was left out.
  };

  double limit_s_;
  std::map<SampleKind, Sensor> sensors_;
};

}  // namespace spindrift
