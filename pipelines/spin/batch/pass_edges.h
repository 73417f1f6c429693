/// @file
/// Collects what the estimator `batch` needs from the products of a pass as they arise.

#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <set>
#include <vector>

#include "pipelines/exclusions/exclusions.h"
#include "pipelines/spin/batch/pass_model.h"
#include "pipelines/spin/types/config.h"
#include "pipelines/spin/types/products.h"
#include "pipelines/spin/types/spin_action.h"

namespace spindrift {

/// Axes at which the estimator `batch` starts.
struct StartingAxes {
  std::vector<Eigen::Vector3d> axes_icrf;  ///< Unit vectors, likeliest first.
  /// True when the true axis is surely near one of them; otherwise the whole sky is searched.
  bool settled = true;
  /// Earlier choice of the pass; its other axis is compared with the solution, but is no start.
  std::optional<AxisChoice> of_pass = {};
};

class PassEdges {
 public:
  void collect(const SpinProduct& product);

  /// Applies an operator action valid from `t`: excluded edges are dropped, and at the first edge
  /// after a manoeuvre all earlier edges. @return Number of edges dropped now.
  std::size_t act(TaiTime t, const SpinAction& action);

  /// Bounds the memory to a day of six edges a turn at 100 rpm; beyond it the last edges are kept.
  static constexpr std::size_t kMost = 900'000;

  /// Keeps the edges of the last `revolutions` revolutions only.
  void keep_last(std::int64_t revolutions);

  /// Returns the time of the last edge, which is the time of the solution; empty without edges.
  std::optional<TaiTime> last() const;

  /// Returns whether another estimator reported CopiesInNoise.
  bool noise_chose_among_copies() const { return noise_chose_among_copies_; }

  /// Returns the contradiction that the sensors showed last; empty if they did not.
  const std::optional<SensorContradiction>& contradiction() const { return contradiction_; }

  /// Returns whether more than `kMost` edges came.
  bool forgot_some() const { return forgot_some_; }

  /// Returns all edges assigned to a revolution, in order of time. Edges of angles that failed
  /// their test are included, since an angle rests on several edges and the fit finds the bad one.
  std::vector<PassEdge> edges() &&;

  /// Returns the axes of the other estimators, and those of the last fix unless `sequential` is OK.
  /// If there are none, the axis that the mission expects.
  StartingAxes starts(const std::optional<SpinPrior>& prior) const;

 private:
  void keep(const PulseUse& use);
  void keep(const SpinFix& fix) { last_fix_ = fix; }
  void keep(const SensorsCompared& sensors) { contradiction_ = sensors.contradiction; }
  void keep(const SpinEstimate& estimate);
  template <class Other>
  void keep(const Other& /*product*/) {}

  void forget_before(TaiTime t);

  std::vector<PassEdge> edges_;
  Exclusions<PulseChannel> excluded_;
  std::set<TaiTime> manoeuvres_;  ///< Times of manoeuvres that no edge has passed yet.
  std::int64_t last_revolution_ = 0;
  bool forgot_some_ = false;
  bool noise_chose_among_copies_ = false;
  std::optional<SensorContradiction> contradiction_;
  std::optional<SpinEstimate> mean_;
  std::optional<SpinEstimate> sequential_;
  std::optional<SpinFix> last_fix_;
};

}  // namespace spindrift
