/// @file
/// A coming pass: what each sensor will see, when a fix is possible, how well the axis can be known
/// after a while.
///
/// The plan sends a revolution of predicted edges without noise through measurement and fix, so
/// that case, candidates and sigma are those that the pass will have. Formulas for each case were
/// rejected.

#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "pipelines/core/expected.h"
#include "pipelines/ephemeris/orbit.h"
#include "pipelines/spin/planning/pass_conditions.h"
#include "pipelines/spin/planning/pass_geometry.h"
#include "pipelines/spin/types/config.h"
#include "pipelines/time/tai_time.h"

namespace spindrift {

/// A condition and the interval in which it holds.
struct PassEvent {
  TaiTime from;
  TaiTime to;
  PassCondition condition;
};

/// Finds the intervals of a coming pass in which a condition holds.
class PassEvents {
 public:
  /// Adds the conditions that hold at a time later than the previous one.
  void advance_to(TaiTime t, const std::vector<PassCondition>& conditions);

  /// Returns all events by beginning; conditions that still hold end with the last time.
  std::vector<PassEvent> finish();

 private:
  TaiTime last_;
  std::vector<PassEvent> open_;
  std::vector<PassEvent> closed_;
};

struct PassRequest {
  TaiTime from;
  TaiTime to;                 ///< Later than `from`.
  double step_s;              ///< The value is positive.
  Eigen::Vector3d axis_icrf;  ///< Unit vector.
  double rate_rad_s;          ///< The value is positive.
};

struct PassStep {
  PassGeometry geometry;
  /// One standard deviation of the axis, both directions together, after all edges since the
  /// beginning of the pass. Empty: they do not determine it.
  std::optional<double> sigma_rad;
  /// The part of it that the noise of the edges leaves (Cramer-Rao bound with phase, rate and drift
  /// unknown): all of it where the mission file is exact.
  std::optional<double> noise_sigma_rad;
  /// The part of it that each error of the mission file alone would make; zero where it is empty.
  SpinAlignmentVector alignment_sigma_rad = SpinAlignmentVector::Zero();
};

struct PassPlan {
  std::vector<PassStep> steps;    ///< Steps at `from`, at every step, and at `to`.
  std::vector<PassEvent> events;  ///< Events by beginning.
};

/// Plans a pass. Edges are as noisy and the sensors as well known as the mission file says, and
/// no edge is lost, but edges of interfering channels are left out. Events, which are looked for
/// every second, and sigma do not depend on the step.
/// @return NoCoverage where the orbit does not reach from `from` to `to`; Unobservable where it
/// dips below the horizon's height.
Expected<PassPlan> plan_pass(const SpinConfig& config, const Orbit& orbit,
                             const PassRequest& request);

}  // namespace spindrift
