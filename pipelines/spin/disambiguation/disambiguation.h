/// @file
/// True or false solution (Wang 2015): which of a revolution's candidates the axis is.

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
#include "pipelines/spin/types/known_axis.h"
#include "pipelines/spin/types/products.h"
#include "pipelines/spin/types/sun_earth_directions.h"
#include "pipelines/time/tai_time.h"

namespace spindrift {

/// What an axis known beforehand says of candidates.
enum class PriorVerdict {
  Chooses,      ///< One of them.
  FarFromAll,   ///< By more than three sigmas.
  NearSeveral,  ///< It does not tell them apart.
};

/// Asks in this order, and the first that answers settles it:
///   GEOMETRY    the measurements themselves tell the candidates apart; not accepted where a
///               healthy beam that should see the Earth has been silent for five revolutions, or
///               from the first on;
///   CONSTRAINT  one candidate only is consistent, gives the chord that each beam saw, and does
///               not show the Earth to a healthy beam that is silent, five revolutions running;
///   PRIOR       one candidate is within three sigmas of the axis that is known already, and nearer
///               to it than every other by more than a sigma (that of the candidates included);
///   DISPERSION  one branch of candidates stays where it is while the others drift.
/// The mission's prior may be false: the dispersion is asked as well, and where it answers it
/// overrules the prior. What the pass has established is not asked again.
/// Otherwise the fix is AMBIGUOUS and not accepted. When the dispersion settles, the AMBIGUOUS
/// fixes of the window are given again; later ones are the candidates that continue that axis, as
/// long as no other comes near it.
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

  /// The beam that contradicts the last fix by its silence, where geometry left but one axis.
  std::optional<Side> silent_despite_view() const { return silent_where_seen_; }

  /// On the last candidates that the mission's prior was asked about; empty: it never was.
  std::optional<PriorVerdict> prior_verdict() const { return prior_verdict_; }

  /// What the dispersion settled on with the last fix, and by how much; empty: it did not then.
  const std::optional<StationaryBranch>& newly_stationary() const { return newly_steady_; }

 private:
  struct Pending {
    std::int64_t revolution;
    TaiTime t;
    AxisCandidates found;
    std::vector<std::size_t> possible;    ///< Those that break no constraint.
    std::optional<std::size_t> by_prior;  ///< The one that the mission's prior chooses.
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
  std::array<bool, 2> heard_{};  ///< Ever.
  std::optional<Side> silent_where_seen_;
  std::optional<PriorVerdict> prior_verdict_;
  Dispersion dispersion_;
  std::optional<StationaryBranch> newly_steady_;
  std::optional<StationaryAxis> steady_;
  int contradictions_ = 0;       ///< Revolutions running that no candidate continued `steady_`.
  std::deque<Pending> pending_;  ///< AMBIGUOUS so far, or settled by the mission's prior alone.
};

}  // namespace spindrift
