/// @file
/// From when to when what holds in a coming pass.

#pragma once

#include <string>
#include <vector>

#include "pipelines/core/expected.h"
#include "pipelines/spin/pass_geometry.h"
#include "pipelines/time/tai_time.h"

namespace spindrift {

/// Something that holds for a while.
struct PassEvent {
  TaiTime from;
  TaiTime to;
  std::string what;  ///< In words (pass_conditions.h).
};

class PassEvents {
 public:
  /// Where something has begun or ceased to hold since the geometry before, the time is searched
  /// for, to a second.
  /// @param geometry Of that scene, later than the one before.
  /// @return As PassScene::at.
  Expected<void> add(PassScene& scene, const PassGeometry& geometry);

  /// All of them, by beginning; what holds still ends with the last geometry.
  std::vector<PassEvent> finish();

 private:
  TaiTime last_;
  std::vector<PassEvent> open_;
  std::vector<PassEvent> closed_;
};

}  // namespace spindrift
