/// @file
/// The answer in force of a spinner: which of the estimators to report, and whether to act on it.

#pragma once

#include <map>
#include <optional>
#include <set>
#include <vector>

#include "pipelines/spin/types/products.h"
#include "pipelines/time/tai_time.h"

namespace spindrift {

/// Two answers that are OK, and how far their axes are from each other.
struct AxesApart {
  SpinEstimator one;
  SpinEstimator other;
  double apart_rad;
  double sigmas;  ///< Distance in sigmas of the difference.
};

struct SpinAnswer {
  TaiTime t = {};  ///< Time of the newest answer of any estimator by then.
  SpinEstimate estimate = {};
  /// That of the estimate; at best DOUBTFUL where answers contradict each other.
  Quality quality = Quality::Converging;
  std::vector<AxesApart> contradictions = {};
};

using LastEstimates = std::map<SpinEstimator, SpinEstimate>;

/// Compares all answers of now that are OK, two by two. An answer is of now until the newest one is
/// two minutes, two solutions of `batch` during a pass, ahead of it.
std::vector<AxesApart> axes_apart(const LastEstimates& last);

/// Selects the answer in force: of those that are OK the one with the smallest sigma, but for one
/// that contradicts a newer one, since the body may have moved between them. Where none is OK it is
/// that of the estimator that uses most of the edges. Answers that are not of now do not count.
/// @param contradiction_sigmas From here on, in sigmas of their difference, axes contradict each
///        other.
/// @return Empty when there is no answer.
std::optional<SpinAnswer> answer_in_force(const LastEstimates& last, double contradiction_sigmas);

/// Keeps the last answer of each estimator of a run. One from before a manoeuvre, or from before an
/// estimator was LOST, is of another axis. It is forgotten once an answer from after that comes.
class SpinAnswers {
 public:
  explicit SpinAnswers(double contradiction_sigmas) : limit_{contradiction_sigmas} {}

  /// Sets the limit by which what comes next is weighed.
  void set_contradiction_sigmas(double sigmas) { limit_ = sigmas; }
  double contradiction_sigmas() const { return limit_; }
  void note_manoeuvre(TaiTime t) { changes_.insert(t); }
  /// Notes that the computation failed: no answer is better than DOUBTFUL from now on.
  void note_fault();
  void take(const SpinEstimate& estimate);

  const std::optional<SpinAnswer>& in_force() const { return in_force_; }
  std::vector<AxesApart> apart() const { return axes_apart(last_); }

 private:
  void weigh();

  double limit_;
  bool has_failed_ = false;
  LastEstimates last_;
  std::set<TaiTime> changes_;  ///< Times at which the axis changed, or may have.
  std::optional<SpinAnswer> in_force_;
};

}  // namespace spindrift
