/// @file
/// The pass of one spin-stabilised satellite: samples in, products out. Live, offline and replay
/// runs all use this one composition of the spin pipeline.
///
///     frame -> order of time -> its edges -+
///     pulse -------------------------------+-> order of time -> interference -> revolution, period
///       -> grid of the times
///       -> measurements -> screening -> candidates for the axis -> fix -> mean
///                                    -> good edges -------------------> sequential
///
/// The first kFirstRevolutions revolutions are held back to tell outliers from the level; later
/// ones are settled as they close. When the axis has moved, screening and mean begin anew; the mean
/// is of the axis of before until then, and at best DOUBTFUL while `sequential` is DOUBTFUL or
/// LOST.
///
/// An operator action applies from its instant on to edges and revolutions not yet computed. A
/// marked manoeuvre begins everything anew; a prior does so only where the pass has settled on
/// another axis. The silence of a beam that is left out speaks against no candidate.

#pragma once

#include <cstddef>
#include <deque>
#include <map>
#include <optional>
#include <span>
#include <vector>

#include "pipelines/core/notice.h"
#include "pipelines/ephemeris/orbit.h"
#include "pipelines/ephemeris/orbit_steps.h"
#include "pipelines/exclusions/exclusions.h"
#include "pipelines/spin/association/association.h"
#include "pipelines/spin/consistency/channel_block.h"
#include "pipelines/spin/consistency/channel_contradictions.h"
#include "pipelines/spin/disambiguation/disambiguation.h"
#include "pipelines/spin/fix/axis_candidates.h"
#include "pipelines/spin/mean/mean_axis.h"
#include "pipelines/spin/mean/mean_estimator.h"
#include "pipelines/spin/measurement/measurement.h"
#include "pipelines/spin/measurement/sun_earth_ephemeris.h"
#include "pipelines/spin/pass/pass_notices.h"
#include "pipelines/spin/screening/screening.h"
#include "pipelines/spin/sequential/sequential.h"
#include "pipelines/spin/sequential/starting_points.h"
#include "pipelines/spin/telemetry_order/interference.h"
#include "pipelines/spin/telemetry_order/pulse_reorder_window.h"
#include "pipelines/spin/telemetry_order/time_grid.h"
#include "pipelines/spin/types/coded_frame.h"
#include "pipelines/spin/types/config.h"
#include "pipelines/spin/types/products.h"
#include "pipelines/spin/types/spin_action.h"
#include "pipelines/statistics/recent_mean.h"
#include "pipelines/time/contested.h"

namespace spindrift {

struct SpinOutput {
  std::vector<SpinProduct> products;  ///< Products in the order they arose.
  std::vector<Notice> notices;        ///< Notices for users, each once a pass.
};

class SpinPass {
 public:
  static constexpr std::size_t kFirstRevolutions = 10;

  SpinPass(const SpinConfig& config, Orbit orbit);

  SpinOutput push(const Pulse& pulse);

  /// Takes a frame of edges that were timed on board.
  SpinOutput push(const CodedFrame& frame);

  /// Returns whether operators have excluded the channel at `t`.
  bool leaves_out(TaiTime t, PulseChannel channel) const { return excluded_.hold(t, channel); }

  /// Applies an operator action to telemetry from `t` on.
  void act(TaiTime t, const SpinAction& action);

  /// Computes what the reordering holds back, when no telemetry comes for now; earlier telemetry is
  /// late from then on. The open revolution and edges that later ones may spoil stay held.
  SpinOutput fall_silent();

  /// Ends the pass and settles all that is still held.
  SpinOutput finish();

  /// Returns the prior as told by the mission or an operator, even if the pass refuted it: `batch`
  /// judges it anew.
  const std::optional<SpinPrior>& told_prior() const { return told_prior_; }

  /// Returns the present choice of `sequential`, or of `mean` before that has begun; empty without
  /// an estimate. The likelihood of the other axis is not computed.
  std::optional<AxisChoice> axis_choice() const;

 private:
  /// Holds a revolution with all that is needed to settle it.
  struct Candidate {
    Revolution revolution;
    RevolutionMeasurements measured;
    std::optional<SunEarthDirections> sun_earth;  ///< Empty outside the orbit.
    std::vector<AngleResidual> residuals;
    bool is_counted = false;  ///< True if counted in inconsistent_share_.
  };

  void process(const Pulse& pulse, SpinOutput& out);
  void process(const CodedFrame& frame, SpinOutput& out);
  void compare(const CodedFrame& again, SpinOutput& out);
  void take_due(const std::vector<CodedFrame>& due, SpinOutput& out);
  void take_edges_before(TaiTime t, SpinOutput& out);
  void sort_out(const std::vector<Pulse>& in_time, SpinOutput& out);
  void associate(const std::vector<InterferenceWindow::Judged>& pulses, SpinOutput& out);
  void collect(Association association, SpinOutput& out);
  void hear(const Revolution& revolution);
  void consider(const Revolution& revolution, SpinOutput& out);
  void compare_sensors(const Revolution& revolution, SpinOutput& out);
  std::vector<Eigen::Vector3d> axes_to_try_icrf() const;
  void doubt_where_sensors_contradict(SpinEstimate& estimate) const;
  void settle_first(SpinOutput& out);
  void settle(Candidate& candidate, SpinOutput& out);
  void predict_anew_where_better_known();
  void predict(Candidate& candidate, const Eigen::Vector3d& axis_icrf);
  void screen(Candidate& candidate) const;
  void note_observations(std::span<SpinProduct> products) const;
  void count_consistency(const FoundCandidates& found, Candidate& candidate);
  bool most_are_consistent() const;
  std::vector<SpinFix> find_fixes(Candidate& candidate);
  void say_why_not_accepted(const SpinFix& fix);
  void announce_axis(Candidate& candidate, SpinOutput& out);
  void note_choice(const SpinFix& fix);
  std::vector<EstimatorShift> shifts() const;
  std::optional<Eigen::Vector3d> other_axis_icrf(const Eigen::Vector3d& axis_icrf) const;
  std::optional<KnownAxis> established_axis() const;
  bool recent_fixes_left_the_mean_for(const Eigen::Vector3d& axis_icrf) const;
  void start_again_where_moved(const SpinEstimate& sequential);
  void expect_no_silence(Candidate& candidate) const;
  void do_what_is_due(TaiTime t);
  void apply(TaiTime t, const ChooseRoot& action);
  void apply(TaiTime t, const SetPrior& action);
  void apply(TaiTime t, const MarkManoeuvre& action);
  template <class Other>
  void apply(TaiTime /*t*/, const Other& /*of edges, or of none*/) {}
  std::vector<StartingPoint> roots_of(const AxisCandidates& found) const;
  void choose_root(TaiTime t, const AxisCandidates& candidates);
  void forget_prior(TaiTime t);
  void begin_anew(TaiTime t);
  void doubt_where_orbit_steps(SpinEstimate& estimate);
  static void leave_out(const Pulse& pulse, Rejection rejected_by, SpinOutput& out);
  void leave_out_of_time(const Pulse& pulse, SpinOutput& out);

  SpinConfig config_;
  std::optional<SpinPrior> told_prior_;
  PassNotices notices_;
  std::vector<OrbitStep> orbit_steps_;
  std::optional<TaiTime> on_orbit_since_;  ///< First revolution of the estimates.
  SunEarthEphemeris sun_earth_;
  FrameReorderWindow frames_;
  Contested<CodedFrame> contested_;
  std::vector<Pulse> of_next_frame_;  ///< Edges that belong behind the next frame's sun1.
  ReorderWindow reorder_;
  InterferenceWindow interference_;
  Associator associator_;
  TimeGrid grid_;
  std::vector<Candidate> first_;  ///< Held-back revolutions; empty once settled.
  bool started_ = false;
  /// Holds the mean attitude that measurements are compared with.
  struct Prediction {
    Eigen::Vector3d axis_icrf;
    std::size_t fixes;  ///< Number of fixes in the mean.
  };

  ScreeningWindow screening_;
  std::optional<Prediction> predicted_from_;
  std::deque<Candidate> recent_;  ///< Last revolutions, one screening window.
  AxisWindow recent_axes_;
  Disambiguator disambiguator_;
  MeanEstimator mean_;
  RecentMean inconsistent_share_;  ///< Share of contradicting revolutions lately.
  SequentialEstimator sequential_;
  int restarts_handled_ = 0;
  BlockCollector blocks_;
  ChannelContradictions contradictions_;
  std::optional<SpinEstimate> answer_;  ///< Last estimate of `sequential`, else of `mean`.
  /// First accepted fix since the pass began or began anew that the pass's own axis did not settle.
  std::optional<SpinFix> settling_fix_;
  std::optional<Eigen::Vector3d> alternate_icrf_;  ///< Best alternate of the last fix that has any.

  Exclusions<PulseChannel> excluded_;
  std::multimap<TaiTime, SpinAction> to_do_;  ///< Actions to apply from a time on.
  std::optional<ChooseRoot> root_to_choose_;  ///< Choice for the next ambiguous fix.
  std::optional<TaiTime> first_axis_;         ///< First revolution that an axis was sought for.
};

}  // namespace spindrift
