/// @file
/// Detects sensors of a three-axis spacecraft that have stopped giving samples.

#pragma once

#include <optional>
#include <vector>

#include "pipelines/ephemeris/orbit.h"
#include "pipelines/ephemeris/sun.h"
#include "pipelines/supervision/condition_watch.h"
#include "pipelines/three_axis/products.h"
#include "pipelines/time/time_jump.h"

namespace spindrift {

/// Watches each sample kind. A kind that has come before is silent if no sample comes for a span of
/// telemetry time while other kinds come. Orbit states are irregular and not watched, nor is an
/// eclipsed Sun.
class KindPresence {
 public:
  /// @param kinds Kinds to watch; all others only tell how late it is.
  KindPresence(const std::vector<SampleKind>& kinds, std::optional<Orbit> orbit, double silent_s);

  void set_silent_s(double silent_s) { silent_s_ = silent_s; }

  ConditionChanges evaluate(SampleKind kind, TaiTime t);

 private:
  struct Channel {
    SampleKind kind;
    ConditionWatch watch;
    std::optional<TaiTime> last = {};  ///< Time of its newest sample.
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
