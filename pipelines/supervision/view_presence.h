/// @file
/// Detects sensors with a stated field of view that give nothing although they should see.

#pragma once

#include <optional>
#include <vector>

#include "pipelines/ephemeris/orbit.h"
#include "pipelines/supervision/condition_watch.h"
#include "pipelines/three_axis/config.h"
#include "pipelines/three_axis/products.h"

namespace spindrift {

/// Watches Sun sensor and star tracker, as far as their field of view is stated, whenever there is
/// an attitude, be it before their first sample. The Sun sensor sees a Sun within its field that
/// the Earth does not hide; the star tracker sees where neither Sun nor Earth stands in its field.
class ViewPresence {
 public:
  ViewPresence(const ThreeAxisConfig& config, std::optional<Orbit> orbit, double silent_s);

  void set_silent_s(double silent_s) { silent_s_ = silent_s; }
  /// Returns the kinds of samples that are not watched here.
  std::vector<SampleKind> others() const;

  void see_sample(SampleKind kind, TaiTime t);
  ConditionChanges see_answer(const AttitudeEstimate& estimate);

 private:
  struct Sensor {
    SampleKind kind;
    FieldOfView view;
    ConditionWatch watch;
    std::optional<TaiTime> last = {};  ///< When it gave a sample last, or could not.
  };

  bool is_blind(const Sensor& sensor, const AttitudeEstimate& estimate) const;

  std::optional<Orbit> orbit_;
  double silent_s_;
  std::vector<Sensor> sensors_;
};

}  // namespace spindrift
