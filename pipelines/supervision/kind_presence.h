/// @file
/// Detects sensors of a three-axis spacecraft that have stopped giving samples.

#pragma once

#include <optional>
#include <vector>

#include "pipelines/ephemeris/orbit.h"
#include "pipelines/ephemeris/sun.h"
#include "pipelines/supervision/condition_watch.h"
#include "pipelines/three_axis/config.h"
#include "pipelines/three_axis/products.h"
#include "pipelines/time/time_jump.h"

namespace spindrift {

/// Watches each sample kind. A kind that has come before, or that nothing can blind, is silent if
/// no sample comes for a span of telemetry time while other kinds come. Orbit states are irregular
/// and not watched, nor is an eclipsed Sun.
class KindPresence {
 public:
  /// @param kinds Kinds to watch; all others only tell how late it is.
  /// @param config Sensors, of which gyro and magnetometer should come from the start.
  KindPresence(const std::vector<SampleKind>& kinds, const ThreeAxisConfig& config,
               std::optional<Orbit> orbit, double silent_s);

  void set_silent_s(double silent_s) { silent_s_ = silent_s; }

  ConditionChanges evaluate(SampleKind kind, TaiTime t);

 private:
  struct Channel {
    SampleKind kind;
    ConditionWatch watch;
    bool is_expected;                  ///< Whether it should come from the start.
    std::optional<TaiTime> last = {};  ///< Time of its newest sample, or from which it is expected.
  };

  bool is_hidden(SampleKind kind, TaiTime t);

  std::optional<Orbit> orbit_;
  ApparentSun sun_;
  double silent_s_;
  TaiTime newest_ = TaiTime::min();  ///< Time that two consecutive samples have reached.
  TaiTime before_ = TaiTime::min();  ///< Time of the previous sample.
  TimeJump jump_;
  std::vector<Channel> channels_;
};

}  // namespace spindrift
