/// @file
/// The estimator `sequential`: estimates axis and rate after every revolution, from its good edges.
///
/// A fix starts it. If the fix is AMBIGUOUS, one filter starts at each of its candidates and at
/// those of later fixes that are near none of them. All filters see the same edges and the
/// likeliest is published; a later fix or the edges (hypotheses.h) eliminate the others. If only a
/// PRIOR settled the fix, its candidate is published until the edges beat it; the assessment then
/// says so. Badly known candidates are averaged over fixes until all are known well enough
/// (starting_points.h). Near-tangent candidates start filters only if there are no others for long,
/// and then only an accepted fix settles the
/// axis, or a prior whose candidate fits the edges. A filter that gates most edges, or whose axis
/// the fixes contradict (contradiction.h), restarts at the next accepted fix, and the assessment
/// says so; if the fixes name several axes, it is AMBIGUOUS again.
///
/// The qualities are
///     OK         none of the following applies
///     CONVERGING as OK, but from too few revolutions to show an error (convergence.h)
///     AMBIGUOUS  another axis, which is named, fits nearly as well, or nothing has settled it; the
///                covariance assumes that the published candidate is true. "or 2 more" counts
///                further candidates, listed as alternates of the fixes. FixesNearTangent
///                means that nearly all fixes are: where two branches touch, candidates are off by
///                more than their covariances and many fixes lack the true axis, so that perhaps no
///                filter follows it
///     DOUBTFUL   the edges scatter more than their noise, or show model errors beyond their
///                allowance or half a degree, which the covariance then covers (smaller errors are
///                covered, too, with quality OK and "model off"); or most edges of the named
///                channel are gated
///     LOST       most edges are gated, so the axis is wrong; the covariance is that of an axis
///                which may point anywhere

#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "pipelines/observation/ledger.h"
#include "pipelines/spin/mean/model_check.h"
#include "pipelines/spin/sequential/contradiction.h"
#include "pipelines/spin/sequential/hypotheses.h"
#include "pipelines/spin/sequential/starting_points.h"
#include "pipelines/spin/types/config.h"
#include "pipelines/spin/types/products.h"
#include "pipelines/spin/types/revolution.h"
#include "pipelines/spin/types/sky.h"
#include "pipelines/statistics/recent_mean.h"

namespace spindrift {

class SequentialEstimator {
 public:
  explicit SequentialEstimator(SpinConfig config);

  /// @param revolution Revolution not earlier than the one before; only its good edges are used.
  /// @param settled Fixes that were settled since the revolution before, in any order.
  /// @return The estimate at the revolution's start; empty until the first fix.
  std::optional<SpinEstimate> update(const Revolution& revolution, const Sky& sky,
                                     std::span<const SpinFix> settled);

  /// Sets the noise of the edges to come and the grid of their times.
  void hear(const PulseNoise& noise) { config_.noise = noise; }

  /// Sets what is known of the axis from now on; empty if nothing is.
  void expect(const std::optional<SpinPrior>& prior) { config_.prior = prior; }

  /// Number of times the estimator gave up its axis for another.
  int restarts() const { return restarts_; }

  /// Returns whether the edges have beaten the candidate that a prior had chosen.
  bool prior_refuted() const { return prior_refuted_; }

  /// Returns the axis motion for model errors of one radian each, all combined, rad. It depends on
  /// the geometry alone; estimates include only the errors that the edges show. A filter must
  /// exist.
  double model_leverage() const;
  /// Leverage beyond which the assessment warns. The axis moves by three or four times the model
  /// errors where beams cross the Earth well apart, and by ten where both cross the same middle of
  /// it.
  static constexpr double kPoorLeverage = 6.0;

  /// Returns the last revolution's observations of the published candidate; empty if its filter
  /// began there.
  std::span<const Observation> observations() const {
    return hypotheses_.empty() ? std::span<const Observation>{}
                               : hypotheses_.published().said.edges();
  }

  /// Axis of the published candidate, which must exist.
  Eigen::Vector3d axis_icrf() const { return hypotheses_.published().filter.axis_icrf(); }
  /// Returns how errors of the mission file move the axis of the published candidate.
  AxisShift shift_icrf() const {
    return hypotheses_.published().filter.axis_of_alignment_icrf() * alignment_root_;
  }
  bool has_begun() const { return !hypotheses_.empty(); }
  /// Returns the axes that filters follow, the published one first; empty before the first fix.
  std::vector<StartingPoint> followed() const { return hypotheses_.followed(); }
  std::optional<Hypotheses::Rival> rival() const { return hypotheses_.rival(); }

  /// Returns the axis if the edges settled it among several.
  std::optional<KnownAxis> settled_by_edges() const;

 private:
  bool apply_fix(const SpinFix& fix, const Revolution& revolution, const Sky& sky);
  void note_near_tangent(const SpinFix& fix);
  bool counts_as_near_tangent(const SpinFix& fix) const;
  StartingPoints* starting_points_for(const SpinFix& fix);
  bool superseded_by(const SpinFix& fix) const;
  bool begin(const SpinFix& fix, std::span<const StartingPoint> points,
             const Revolution& revolution, const Sky& sky);
  void select_hypothesis(const SpinFix& fix, const StartingPoint& axis);
  void join(std::span<const StartingPoint> points, const Revolution& revolution, const Sky& sky);
  bool fixes_contradict() const;
  ChannelNoise gate_noise() const;
  void test_model_and_noise();
  bool most_left_out() const;
  void work_in(const Revolution& revolution, const Sky& sky);
  Eigen::Matrix2d covariance_rad2() const;
  Eigen::Matrix2d grazing_rad2() const;
  Eigen::Matrix2d alignment_rad2() const;
  bool model_contradicts() const;
  Assessment assess_ambiguous() const;
  std::optional<Reason> doubt() const;
  Assessment assess() const;

  SpinConfig config_;
  SpinAlignment alignment_root_;
  Hypotheses hypotheses_;  ///< Empty before the first fix.

  StartingPoints settled_starts_;  ///< Candidates of settled fixes.
  StartingPoints open_starts_;     ///< Candidates of fixes that leave several open.
  StartingPoints near_tangent_starts_;
  RecentMean near_tangent_share_;  ///< Share of near-tangent fixes among the recent ones.
  StartingPoints untracked_;       ///< Candidates without a filter since the last start.
  Contradiction contradiction_;    ///< Contradiction by fixes since the last start.
  StartConfirmation start_confirmation_;

  Ledger ledger_;           ///< Innovations of the published candidate.
  ModelEvidence evidence_;  ///< Kept over restarts, as the model stays the same.
  ModelTest verdict_;       ///< Test of `ledger_` and `evidence_`.
  /// Excess noise at the last restart. The gate opens no further: only noise that is still there
  /// after a restart was not caused by a wrong axis.
  double noise_at_restart_ = 1.0;

  std::int64_t revolutions_before_start_ = 0;  ///< Revolutions with fixes before the first start.
  int restarts_ = 0;
  bool prior_refuted_ = false;
  std::optional<ReasonCode> restarted_;  ///< Reason of the last restart; empty if none.
};

}  // namespace spindrift
