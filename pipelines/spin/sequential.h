/// @file
/// The estimator `sequential`: axis and rate after every revolution, from all its good edges.
///
/// A fix starts it. Where the fix is AMBIGUOUS one filter starts at each of its candidates, and at
/// those of later ones that are near none of them; all see the same edges, the likeliest is
/// published, and the others are dropped when a later fix settles the matter or the edges
/// themselves do. Likewise where only a PRIOR settled the fix: its candidate is published, and the
/// others stay until the edges beat them; where they beat the prior's, the axis is theirs, and
/// the status says so. Candidates known badly are averaged with those of the following fixes, until
/// all are known well enough; grazing ones start filters only where there are no others for long,
/// and then nothing but an accepted fix or a prior settles it. A filter that finds most edges
/// where it does not expect them, or whose fixes name another axis, starts again at the next
/// accepted fix, and says so.
///
/// The status begins with
///     OK         all is well
///     AMBIGUOUS  another axis, named, fits as well or nearly so, or nothing has settled it; the
///                covariance is that of the candidate published, were it true. "or 2 more": so many
///                others do, which the fixes list among their alternates. "or none: all fixes
///                graze": where two branches touch, candidates are off by more than their
///                covariances and many fixes lack the true one, so that no filter may follow it
///     DOUBTFUL   the edges scatter more than their noise, or show errors of the model beyond its
///                allowance: the covariance is raised to cover it (within the allowance likewise,
///                and the status is OK, "model off by"); or most edges of the channel named are not
///                where this axis has them
///     LOST       most edges are not: the axis is no longer, or never was, the true one; the
///                covariance is that of an axis which may point anywhere

#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "pipelines/spin/association.h"
#include "pipelines/spin/config.h"
#include "pipelines/spin/innovation_watch.h"
#include "pipelines/spin/known_axis.h"
#include "pipelines/spin/mean_axis.h"
#include "pipelines/spin/products.h"
#include "pipelines/spin/sky.h"
#include "pipelines/spin/spin_filter.h"
#include "pipelines/spin/starting_points.h"

namespace spindrift {

class SequentialEstimator {
 public:
  explicit SequentialEstimator(SpinConfig config) : config_{std::move(config)} {}

  /// @param revolution Not earlier than the one before; only its good edges are used.
  /// @param settled The fixes that were settled since the revolution before, in any order.
  /// @return The estimate at the revolution's start; empty until the first fix.
  std::optional<SpinEstimate> update(const Revolution& revolution, const Sky& sky,
                                     std::span<const SpinFix> settled);

  /// How often it gave up its axis for another.
  int restarts() const { return restarts_; }

  /// The edges have beaten the candidate that a prior had chosen.
  bool prior_refuted() const { return prior_refuted_; }

  /// What errors of the model, one radian each, move the axis by, all ways together, rad: of the
  /// geometry alone. Estimates include only what the edges show of such errors. There must be one.
  double model_leverage() const;

  /// The axis that the edges settled beyond doubt among several.
  std::optional<KnownAxis> settled_by_edges() const;

 private:
  /// One candidate for the axis and what speaks for it.
  struct Hypothesis {
    SpinFilter filter;
    bool favoured = false;  ///< By a prior.
    double edges = 0.0;
    double log_likelihood = 0.0;  ///< Of them.
    double squared_innovations =
        0.0;               ///< Normalised, their sum: as many as edges when all is well.
    EdgeTally tally = {};  ///< Of the last revolution.
  };

  Eigen::Matrix2d covariance_rad2() const;
  void add_unlike(std::span<const SpinFix> settled, const Revolution& revolution, const Sky& sky);
  bool fixes_contradict() const;
  bool begin(std::span<const SpinFix> settled, const Revolution& revolution, const Sky& sky);
  bool start(const SpinFix& fix, std::span<const StartingPoint> points,
             const Revolution& revolution, const Sky& sky);
  void follow(const SpinFix& fix, std::vector<Hypothesis> started);
  bool restart_is_due(std::span<const SpinFix> settled);
  void note_contradiction(const SpinFix& fix);
  void take_side(const SpinFix& fix);
  bool prior_stands() const;
  void work_in(const Revolution& revolution, const Sky& sky);
  void drop_the_beaten();
  void count(const EdgeTally& tally);
  std::optional<PulseChannel> mostly_gated() const;
  std::string ambiguous_status() const;
  std::string status() const;

  SpinConfig config_;
  std::vector<Hypothesis> hypotheses_;  ///< The likeliest first; empty before the first fix.
  StartingPoints settled_starts_;       ///< Of fixes that might start it, since it last started.
  StartingPoints open_starts_;          ///< Likewise, of those that leave several candidates open.
  StartingPoints unlike_;               ///< Of candidates that no hypothesis is near to; likewise.
  std::int64_t grazing_ = 0;            ///< Fixes, before the first that could start it.
  bool provisional_ = false;            ///< Started by these: the true axis may be missing.
  std::int64_t unheard_ = 0;      ///< Revolutions with fixes before the first that could start it.
  std::int64_t revolutions_ = 0;  ///< Since the start; likewise the following.
  std::int64_t gated_ = 0;
  double gated_share_ = 0.0;  ///< Of the recent edges.
  /// Of the recent revolutions, those in which the channel's edge was gated.
  std::array<double, kPulseChannels> channel_gated_share_ = {};
  bool settled_ = false;  ///< By a fix, or by the edges beyond doubt.
  bool settled_by_edges_ = false;
  bool prior_refuted_ = false;
  /// The gate opens for noise that made the filter begin anew before: then it was not the axis.
  double noise_at_restart_ = 1.0;
  InnovationWatch watch_;   ///< Over the restarts: noise and model stay what they are.
  ModelVerdict verdict_;    ///< Of the watch.
  int contradicted_ = 0;    ///< Fixes against the axis, less those for it.
  MeanAxis contradicting_;  ///< All fixes since it was last 0.
  StartingPoints poor_;     ///< Of fixes known too badly to speak alone, since they last spoke.
  int poor_fixes_ = 0;      ///< So many.
  int restarts_ = 0;
  std::string_view restarted_;  ///< Why; empty: never.
};

}  // namespace spindrift
