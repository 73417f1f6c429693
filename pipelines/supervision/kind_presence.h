/// @file
/// Sensors of a three-axis spacecraft that gave samples and give none.

#pragma once

#include <optional>
#include <vector>

#include "pipelines/ephemeris/orbit.h"
#include "pipelines/ephemeris/sun.h"
#include "pipelines/supervision/condition_watch.h"
#include "pipelines/three_axis/products.h"
#include "pipelines/time/time_jump.h"

namespace spindrift {

/// A kind is silent that has come, and gave nothing for so long of telemetry time while others
/// came. Orbit states come as they like. Of a Sun that the Earth hides nothing is expected.
class KindPresence {
 public:
  KindPresence(std::optional<Orbit> orbit, double silent_s);

  ConditionChanges see(SampleKind kind, TaiTime t);

 private:
  struct Channel {
    SampleKind kind;
    ConditionWatch watch;
    std::optional<TaiTime> last = {};  ///< Its newest sample.
  };

  bool is_hidden(SampleKind kind, TaiTime t);

  std::optional<Orbit> orbit_;
  ApparentSun sun_;
  double silent_s_;
  TaiTime newest_ = TaiTime::min();  ///< That two samples one after the other have reached.
  TaiTime before_ = TaiTime::min();  ///< Of the sample before.
  TimeJump jump_;
  std::vector<Channel> channels_;
};

}  // namespace spindrift
