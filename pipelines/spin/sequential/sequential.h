/// @file
/// The estimator `sequential`: axis and rate after every revolution, from all its good edges.
///
/// A fix starts it. Where the fix is AMBIGUOUS one filter starts at each of its candidates, and at
/// those of later ones that are near none of them; all see the same edges, the likeliest is
/// published, and the others are dropped when a later fix settles the matter or the edges
/// themselves do (hypotheses.h). Likewise where only a PRIOR settled the fix: its candidate is
/// published, and the others stay until the edges beat them; where they beat the prior's, the axis
/// is theirs, and the assessment says so. Candidates known badly are averaged with those of the
/// following fixes, until all are known well enough (starting_points.h); near-tangent ones start
/// filters only where there are no others for long, and then nothing but an accepted fix settles
/// it. A filter that finds most edges where it does not expect them, or whose fixes name another
/// axis (contradiction.h), starts again at the next accepted fix, and says so; where the fixes name
/// several, it is AMBIGUOUS again.
///
/// Its quality is
///     OK         all is well
///     CONVERGING likewise, but it has seen too few revolutions for its edges to have shown what is
///                not (convergence.h)
///     AMBIGUOUS  another axis, named, fits as well or nearly so, or nothing has settled it; the
///                covariance is that of the candidate published, were it true. "or 2 more": so many
///                others do, which the fixes list among their alternates. "or none:
///                near-tangent", nearly all fixes are: where two branches touch, candidates are off
///                by more than their covariances and many fixes lack the true one, so that no
///                filter may follow it
///     DOUBTFUL   the edges scatter more than their noise, or show errors of the model beyond its
///                allowance, or of half a degree whatever they may be: the covariance is raised to
///                cover it (below that likewise, and it is OK, "model off by"); or most
///                edges of the channel named are not where this axis has them
///     LOST       most edges are not: the axis is no longer, or never was, the true one; the
///                covariance is that of an axis which may point anywhere

#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <span>

#include "pipelines/observation/ledger.h"
#include "pipelines/spin/mean/model_check.h"
#include "pipelines/spin/sequential/contradiction.h"
#include "pipelines/spin/sequential/hypotheses.h"
#include "pipelines/spin/sequential/model_evidence.h"
#include "pipelines/spin/sequential/start_confirmation.h"
#include "pipelines/spin/sequential/starting_points.h"
#include "pipelines/spin/types/config.h"
#include "pipelines/spin/types/known_axis.h"
#include "pipelines/spin/types/products.h"
#include "pipelines/spin/types/revolution.h"
#include "pipelines/spin/types/sky.h"
#include "pipelines/statistics/recent_mean.h"

namespace spindrift {

class SequentialEstimator {
 public:
  explicit SequentialEstimator(SpinConfig config);

  /// @param revolution Not earlier than the one before; only its good edges are used.
  /// @param settled The fixes that were settled since the revolution before, in any order.
  /// @return The estimate at the revolution's start; empty until the first fix.
  std::optional<SpinEstimate> update(const Revolution& revolution, const Sky& sky,
                                     std::span<const SpinFix> settled);

  /// What is known of the noise of the edges to come, and of the grid of their times.
  void hear(const PulseNoise& noise) { config_.noise = noise; }

  /// How often it gave up its axis for another.
  int restarts() const { return restarts_; }

  /// The edges have beaten the candidate that a prior had chosen.
  bool prior_refuted() const { return prior_refuted_; }

  /// What errors of the model, one radian each, move the axis by, all ways together, rad: of the
  /// geometry alone. Estimates include only what the edges show of such errors. There must be one.
  double model_leverage() const;
  /// Beyond it the assessment says so. Where beams cross the Earth well apart, an axis moves by
  /// three or four times the errors of the model; where both look across the same middle of it, by
  /// ten.
  static constexpr double kPoorLeverage = 6.0;

  /// What the edges of the last revolution said to the candidate published; empty where a filter
  /// began there.
  std::span<const Observation> observations() const {
    return hypotheses_.empty() ? std::span<const Observation>{}
                               : hypotheses_.published().said.edges();
  }

  /// Of the candidate published; there must be one.
  Eigen::Vector3d axis_icrf() const { return hypotheses_.published().filter.axis_icrf(); }
  bool has_begun() const { return !hypotheses_.empty(); }
  std::optional<Hypotheses::Rival> rival() const { return hypotheses_.rival(); }

  /// The axis that the edges settled beyond doubt among several.
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
  bool model_contradicts() const;
  Assessment assess_ambiguous() const;
  std::optional<Reason> doubt() const;
  Reason model_off() const;
  Assessment assess() const;

  SpinConfig config_;
  Hypotheses hypotheses_;  ///< None before the first fix.

  StartingPoints settled_starts_;  ///< Of fixes that are settled.
  StartingPoints open_starts_;     ///< Of those that leave several candidates open.
  StartingPoints near_tangent_starts_;
  RecentMean near_tangent_share_;  ///< Of the recent fixes.
  StartingPoints untracked_;       ///< Candidates that no filter follows, since the start.
  Contradiction contradiction_;    ///< By fixes, since the start.
  StartConfirmation start_confirmation_;

  Ledger ledger_;           ///< Of the published candidate.
  ModelEvidence evidence_;  ///< Over the restarts: the model stays what it is.
  ModelTest verdict_;       ///< Of both.
  /// The gate opens for noise that made the filter begin anew before: then it was not the axis.
  double noise_at_restart_ = 1.0;

  std::int64_t revolutions_before_start_ =
      0;  ///< Revolutions with fixes before the first that could start it.
  int restarts_ = 0;
  bool prior_refuted_ = false;
  std::optional<ReasonCode> restarted_;  ///< Why; empty: never.
};

}  // namespace spindrift
