/// @file
/// True or false solution (Wang 2015): decides which candidate of a revolution is the axis.
///
/// Near-tangent fixes may lack the true candidate. An axis known to worse than 3 deg chooses among
/// their candidates as if it were known to 3 deg, since within three large sigmas there is soon a
/// false one.

#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

#include "pipelines/spin/disambiguation/dispersion.h"
#include "pipelines/spin/fix/axis_candidates.h"
#include "pipelines/spin/measurement/measurement.h"
#include "pipelines/spin/types/config.h"
#include "pipelines/spin/types/products.h"
#include "pipelines/spin/types/sky.h"
#include "pipelines/time/tai_time.h"

namespace spindrift {

/// What an axis known beforehand says of the candidates.
enum class PriorVerdict {
  Chooses,      ///< It chooses one of them.
  FarFromAll,   ///< All are more than three sigmas away.
  NearSeveral,  ///< Several are near: it does not tell them apart.
};

/// Decides which candidate is the axis by the first of these tests that answers:
///   GEOMETRY    the measurements themselves tell the candidates apart; the fix is not accepted
///               where a healthy beam that should see the Earth has been silent for five
///               revolutions, or from the first on;
///   CONSTRAINT  only one candidate is consistent, gives the chord that each beam saw, and does
///               not show the Earth to a healthy beam silent for five revolutions running;
///   PRIOR       one candidate is within three sigmas of the axis that is known already, and nearer
///               to it than every other by more than a sigma (that of the candidate included);
///   DISPERSION  one branch of candidates stays in place while the others drift.
/// The mission's prior may be false: the dispersion is asked as well, and overrules the prior where
/// it answers. An axis that the pass has established is not tested again. Where no test answers,
/// the fix is AMBIGUOUS and not accepted. When the dispersion settles the axis, the AMBIGUOUS fixes
/// of the window are given again; later fixes take the candidate that continues that axis, as long
/// as no other comes near it.
class Disambiguator {
 public:
  explicit Disambiguator(const SpinConfig& config);

  /// @param established The axis that the pass has already settled on; takes the place of the
  ///        mission's prior.
  /// @return Earlier fixes that this revolution settles, then its own.
  std::vector<SpinFix> settle(std::int64_t revolution, TaiTime t,
                              const RevolutionMeasurements& measured,
                              const SunEarthDirections& sun_earth, const AxisCandidates& candidates,
                              const std::optional<KnownAxis>& established);

  /// Returns the beam whose silence contradicts the last fix, where geometry left only one axis.
  std::optional<Side> silent_despite_view() const { return silent_where_seen_; }

  /// Returns what the mission's prior said of the last candidates; empty if it was never asked.
  std::optional<PriorVerdict> prior_verdict() const { return prior_verdict_; }

  /// Returns what the dispersion settled on with the last fix; empty if it settled nothing then.
  const std::optional<StationaryBranch>& newly_stationary() const { return newly_steady_; }

 private:
  struct Pending {
    std::int64_t revolution;
    TaiTime t;
    AxisCandidates found;
    std::vector<std::size_t> possible;    ///< Candidates that break no constraint.
    std::optional<std::size_t> by_prior;  ///< Candidate that the mission's prior chooses.
  };

  void note_silence(const RevolutionMeasurements& measured);
  bool should_see(Side side, const SunEarthDirections& sun_earth,
                  const AxisCandidate& candidate) const;
  std::optional<Side> silent_despite_view(const SunEarthDirections& sun_earth,
                                          const AxisCandidate& candidate) const;
  bool breaks_constraint(const RevolutionMeasurements& measured,
                         const SunEarthDirections& sun_earth, const AxisCandidate& candidate) const;
  std::vector<std::size_t> possible_of(const RevolutionMeasurements& measured,
                                       const SunEarthDirections& sun_earth,
                                       const AxisCandidates& found) const;
  std::optional<std::size_t> nearest_to_known(const std::optional<KnownAxis>& established,
                                              const AxisCandidates& found,
                                              const std::vector<std::size_t>& possible);
  void ask_dispersion(const Pending& pending);
  std::vector<SpinFix> settle_by_dispersion(Pending pending);
  void follow(const Pending& pending, const std::optional<std::size_t>& chosen);

  SpinConfig config_;
  std::array<int, 2> silent_revolutions_{};
  std::array<bool, 2> heard_{};  ///< Whether the beam was ever heard.
  std::optional<Side> silent_where_seen_;
  std::optional<PriorVerdict> prior_verdict_;
  Dispersion dispersion_;
  std::optional<StationaryBranch> newly_steady_;
  std::optional<StationaryAxis> steady_;
  int contradictions_ = 0;       ///< Revolutions in a row that did not continue `steady_`.
  std::deque<Pending> pending_;  ///< Fixes AMBIGUOUS so far, or settled by the prior alone.
};

}  // namespace spindrift
