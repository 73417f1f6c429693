/// @file
/// Collects the notices of a pass for its users: each once, when it arises, and at the end those
/// that are certain only then.

#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "pipelines/core/expected.h"
#include "pipelines/core/notice.h"
#include "pipelines/spin/association/association.h"
#include "pipelines/spin/disambiguation/disambiguation.h"
#include "pipelines/spin/disambiguation/dispersion.h"
#include "pipelines/spin/measurement/measurement.h"
#include "pipelines/spin/sequential/sequential.h"
#include "pipelines/spin/types/config.h"
#include "pipelines/spin/types/products.h"
#include "pipelines/spin/types/pulse.h"
#include "pipelines/spin/types/side.h"

namespace spindrift {

class PassNotices {
 public:
  explicit PassNotices(SpinConfig config) : config_{std::move(config)} {}

  void edge_came(PulseChannel channel) { heard_.at(index_of(channel)) = true; }
  /// Counts the edges used and left out among the products.
  void used(std::span<const SpinProduct> products);
  void edge_came_late();
  void edge_out_of_time();
  void associated(const Association& association);
  void counted_on(const Revolution& revolution);
  void times_on_grid(TaiTime t, double width_s);
  /// @param code Error code of SunEarthEphemeris::sun_earth.
  void outside_orbit(TaiTime t, ErrorCode code);
  /// Marks the revolution that the end of the pass cuts, which may lack a fix for that reason
  /// alone.
  void cut_short(std::int64_t revolution) { cut_short_ = revolution; }
  void orbit_steps(Notice notice) { say_once(std::move(notice)); }
  void without_fix(std::int64_t revolution, const WhyNoFix& why);
  /// @param fix Fix of the present revolution, not one settled again.
  /// @param prior Verdict of the prior on the fix's candidates, else its last one.
  void has_fix(const SpinFix& fix, std::optional<PriorVerdict> prior);
  void settled_by_dispersion(TaiTime t, const StationaryBranch& branch);
  void mean_began() { mean_began_ = true; }
  void most_contradict_themselves();
  void silent_where_it_must_see(Side side);
  void fix_contradicts_itself();
  void prior_contradicted(TaiTime t);
  /// Resets all statements about the previous prior, as an operator has set a new one.
  void prior_set(const SpinPrior& prior);
  /// Notes that an operator's choice is no candidate; once a choice.
  void root_far_from_all(TaiTime t, const Eigen::Vector3d& nearest_icrf, double apart_rad,
                         double limit_rad);
  void root_chosen(TaiTime t, const Eigen::Vector3d& root_icrf, double apart_rad);
  /// Resets what was said of the choice before.
  void root_to_choose() { said_.erase(NoticeCode::RootFarFromAll); }
  void axis_moved(TaiTime t, double apart_rad);
  /// Takes an estimate of `sequential`.
  void estimated(const SpinEstimate& estimate);

  /// @param interfering Interfering channels of the whole pass.
  void pass_ended(std::span<const InterferingChannels> interfering,
                  const SequentialEstimator& sequential);

  /// Returns the notices since the last call.
  std::vector<Notice> take_pending() { return std::exchange(pending_, {}); }

 private:
  void say(Notice notice) { pending_.push_back(std::move(notice)); }
  void say_once(Notice notice) {
    const NoticeCode kind = notice.code;
    say_first(kind, std::move(notice));
  }
  void say_first(NoticeCode kind, Notice notice);
  /// Names the channels with or without edges (`heard`) that have or lack a sensor (`described`).
  std::vector<std::string> channels_where(bool heard, bool described) const;
  void say_what_was_copied();
  void say_what_was_left_out();
  void say_why_no_mean();
  Notice why_ambiguous() const;
  void say_what_the_axis_lacks(const SequentialEstimator& sequential);

  SpinConfig config_;
  /// Who gave the prior: `mission` or `operator`.
  NamedValue prior_from_{"prior_from", "mission"};
  std::vector<Notice> pending_;
  std::set<NoticeCode> said_;
  std::array<bool, kSides.size()> silence_said_{};
  std::array<bool, kPulseChannels> heard_{};
  std::int64_t edges_ = 0;
  std::map<Rejection, std::int64_t> left_out_;  ///< Numbers of rejected edges.
  std::set<PulseChannel> copied_channels_;
  std::int64_t copies_ = 0;          ///< Number of copied edges.
  double copies_apart_s_ = 0.0;      ///< Sum of distances to the originals.
  bool closed_any_ = false;          ///< True after a closed revolution.
  bool left_over_any_ = false;       ///< True after an edge without revolution.
  std::optional<Quality> quality_;   ///< Quality of `sequential`; empty without estimate.
  bool fixes_near_tangent_ = false;  ///< Whether `sequential` rests on near-tangent fixes.
  int last_case_ = 0;                ///< Geometry case of the last fix.
  std::optional<PriorVerdict> prior_verdict_;
  bool prior_contradicted_ = false;
  bool mean_began_ = false;
  std::int64_t near_tangent_ = 0;  ///< Number of near-tangent fixes.
  std::int64_t ambiguous_ = 0;     ///< Number of other ambiguous fixes.
  std::int64_t otherwise_not_accepted_ = 0;
  std::optional<std::int64_t> cut_short_;     ///< Number of the cut revolution.
  std::int64_t without_fix_ = 0;              ///< Number of revolutions without a fix.
  std::optional<WhyNoFix> last_without_fix_;  ///< Why the last revolution has no fix.
  std::int64_t outside_orbit_ = 0;            ///< Number of revolutions outside the orbit.
  TaiTime last_outside_orbit_{};              ///< Time of the last of these revolutions.
};

}  // namespace spindrift
