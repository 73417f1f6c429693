#include "pipelines/spin/disambiguation/disambiguation.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <utility>

#include "pipelines/frames/angle.h"
#include "pipelines/frames/celestial.h"
#include "pipelines/spin/sensor_model/geometry.h"
#include "pipelines/spin/types/model_allowance.h"
#include "pipelines/statistics/significance.h"

namespace spindrift {
namespace {

constexpr int kSilentRevolutions = 5;
// A near-tangent fix may lack the true candidate: false ones lie near an axis known worse than
// this.
constexpr double kWidest_rad = 3.0 * kRadPerDeg;
constexpr int kContradictionsInARow = 20;

double sigma_of(const AxisCandidate& candidate) {
  return std::sqrt(candidate.total_covariance_rad2().trace());
}

/// The range of chords that a beam may see about a candidate, within noise and model errors.
struct ChordRange {
  double least_rad = kTurn_rad;
  double most_rad = 0.0;  ///< 0: the beam misses the disc. A turn: it never leaves it.
};

ChordRange chords_from(const AxisCandidate& candidate, const SunEarthDirections& sun_earth,
                       double mount_angle_rad) {
  const Eigen::Vector3d& axis = candidate.axis_icrf;
  const double earth_rad = angle_between_rad(axis, sun_earth.earth_icrf);
  const Eigen::Vector2d towards =
      tangent_basis(axis).transpose() * sun_earth.earth_icrf / std::sin(earth_rad);
  const double margin_rad =
      kContradictionSigmas * std::sqrt(towards.dot(candidate.total_covariance_rad2() * towards)) +
      kModelLimit_rad;
  constexpr int kPlaces = 5;  // Places on either side.
  ChordRange range;
  for (int place = -kPlaces; place <= kPlaces; ++place) {
    const double there_rad = std::abs(earth_rad + margin_rad * place / kPlaces);
    const bool misses = std::abs(there_rad - mount_angle_rad) > sun_earth.disc_rad;
    const double chord_rad = predict_chord_rad(mount_angle_rad, there_rad, sun_earth.disc_rad)
                                 .value_or(misses ? 0.0 : kTurn_rad);
    range.least_rad = std::min(range.least_rad, chord_rad);
    range.most_rad = std::max(range.most_rad, chord_rad);
  }
  return range;
}

struct Nearest {
  std::size_t candidate;
  PriorVerdict verdict;
};

Nearest nearest_to(const KnownAxis& known, const AxisCandidates& found,
                   const std::vector<std::size_t>& possible) {
  const auto distance_rad = [&](std::size_t i) {
    return angle_between_rad(known.axis_icrf, found.candidates[i].axis_icrf);
  };
  const auto nearest = *std::min_element(
      possible.begin(), possible.end(),
      [&](std::size_t a, std::size_t b) { return distance_rad(a) < distance_rad(b); });
  const double known_rad =
      found.near_tangent ? std::min(known.sigma_rad, kWidest_rad) : known.sigma_rad;
  const double sigma_rad = std::hypot(known_rad, sigma_of(found.candidates[nearest]));
  if (distance_rad(nearest) > kPriorSigmas * sigma_rad) {
    return {.candidate = nearest, .verdict = PriorVerdict::FarFromAll};
  }
  const bool alone = std::all_of(possible.begin(), possible.end(), [&](std::size_t other) {
    return other == nearest || distance_rad(other) - distance_rad(nearest) > sigma_rad;
  });
  return {.candidate = nearest,
          .verdict = alone ? PriorVerdict::Chooses : PriorVerdict::NearSeveral};
}

/// Returns the candidate that continues a steady axis, when no other may.
std::optional<std::size_t> continues(const StationaryAxis& steady, const AxisCandidates& found,
                                     const std::vector<std::size_t>& possible) {
  constexpr double kGate = kContradictionSigmas * kContradictionSigmas;
  std::optional<std::size_t> chosen;
  double least = 0.0;
  double second = 0.0;
  for (const std::size_t i : possible) {
    const double distance = squared_distance(steady.axis_icrf, found.candidates[i], steady.count);
    if (!chosen || distance < least) {
      second = chosen ? least : distance + 2.0 * kGate;
      least = distance;
      chosen = i;
    } else {
      second = std::min(second, distance);
    }
  }
  return chosen && least < kGate && second - least > kGate ? chosen : std::nullopt;
}

/// The fix that chooses one of the candidates; the others become its alternates.
SpinFix fix_of(std::int64_t revolution, TaiTime t, const AxisCandidates& found, std::size_t chosen,
               Resolution resolution) {
  const AxisCandidate& candidate = found.candidates[chosen];
  SpinFix fix{.revolution = revolution,
              .t = t,
              .geometry_case = found.geometry_case,
              .axis_icrf = candidate.axis_icrf,
              .covariance_rad2 = candidate.total_covariance_rad2(),
              .alternates = {},
              .resolution = resolution,
              .norm = candidate.norm,
              .accepted = candidate.consistent && resolution != Resolution::Ambiguous,
              .near_tangent = found.near_tangent,
              .misfit = candidate.misfit,
              .alignment_rad2 = candidate.alignment_rad2};
  for (std::size_t i = 0; i < found.candidates.size(); ++i) {
    const AxisCandidate& other = found.candidates[i];
    if (i != chosen) {
      fix.alternates.push_back({.axis_icrf = other.axis_icrf,
                                .covariance_rad2 = other.total_covariance_rad2(),
                                .misfit = other.misfit,
                                .alignment_rad2 = other.alignment_rad2});
    }
  }
  return fix;
}

}  // namespace

Disambiguator::Disambiguator(const SpinConfig& config)
    : config_{config}, dispersion_{static_cast<std::size_t>(config.screening.window)} {}

std::vector<SpinFix> Disambiguator::settle(std::int64_t revolution, TaiTime t,
                                           const RevolutionMeasurements& measured,
                                           const SunEarthDirections& sun_earth,
                                           const AxisCandidates& candidates,
                                           const std::optional<KnownAxis>& established) {
  note_silence(measured);
  newly_steady_.reset();
  if (candidates.told_apart) {
    SpinFix fix = fix_of(revolution, t, candidates, 0, Resolution::Geometry);
    silent_where_seen_ = silent_despite_view(sun_earth, candidates.candidates.front());
    fix.accepted = fix.accepted && !silent_where_seen_;
    return {std::move(fix)};
  }
  silent_where_seen_.reset();
  std::vector<std::size_t> possible = possible_of(measured, sun_earth, candidates);
  if (possible.empty()) {
    return {fix_of(revolution, t, candidates, 0, Resolution::Ambiguous)};
  }
  if (possible.size() == 1 && candidates.candidates.size() > 1 && !candidates.near_tangent) {
    return {fix_of(revolution, t, candidates, possible.front(), Resolution::Constraint)};
  }
  const auto nearest = nearest_to_known(established, candidates, possible);
  // What the pass itself has established needs no further test.
  if (nearest && (established || candidates.near_tangent)) {
    SpinFix fix = fix_of(revolution, t, candidates, *nearest, Resolution::Prior);
    if (established) {
      fix.settled_before = established->settled_by;
    }
    return {std::move(fix)};
  }
  if (candidates.near_tangent) {
    dispersion_.note_unlike();
    return {fix_of(revolution, t, candidates, possible.front(), Resolution::Ambiguous)};
  }
  return settle_by_dispersion({.revolution = revolution,
                               .t = t,
                               .found = candidates,
                               .possible = std::move(possible),
                               .by_prior = nearest});
}

void Disambiguator::note_silence(const RevolutionMeasurements& measured) {
  for (const Side side : kSides) {
    int& silent = silent_revolutions_.at(index_of(side));
    silent = measured.silent.at(index_of(side)) ? silent + 1 : 0;
    heard_.at(index_of(side)) = heard_.at(index_of(side)) || silent == 0;
  }
}

bool Disambiguator::should_see(Side side, const SunEarthDirections& sun_earth,
                               const AxisCandidate& candidate) const {
  const auto& sensor = sensor_of(config_, side);
  if (!sensor || !sensor->healthy) {
    return false;
  }
  const ChordRange range = chords_from(candidate, sun_earth, sensor->mount_angle_rad);
  return range.least_rad > 0.0 && range.most_rad < kTurn_rad;
}

std::optional<Side> Disambiguator::silent_despite_view(const SunEarthDirections& sun_earth,
                                                       const AxisCandidate& candidate) const {
  const auto* const found = std::find_if(kSides.begin(), kSides.end(), [&](Side side) {
    const int silent = silent_revolutions_.at(index_of(side));
    return (silent >= kSilentRevolutions || (silent > 0 && !heard_.at(index_of(side)))) &&
           should_see(side, sun_earth, candidate);
  });
  return found == kSides.end() ? std::nullopt : std::optional{*found};
}

bool Disambiguator::breaks_constraint(const RevolutionMeasurements& measured,
                                      const SunEarthDirections& sun_earth,
                                      const AxisCandidate& candidate) const {
  return std::any_of(kSides.begin(), kSides.end(), [&](Side side) {
    const auto& sensor = sensor_of(config_, side);
    if (!sensor) {
      return false;
    }
    if (const auto chord = good_value_of(measured, kChords.at(index_of(side)))) {
      const ChordRange range = chords_from(candidate, sun_earth, sensor->mount_angle_rad);
      const double tolerance_rad = kContradictionSigmas * chord->sigma_rad + kModelLimit_rad;
      return chord->value_rad < range.least_rad - tolerance_rad ||
             chord->value_rad > range.most_rad + tolerance_rad;
    }
    return silent_revolutions_.at(index_of(side)) >= kSilentRevolutions &&
           should_see(side, sun_earth, candidate);
  });
}

std::vector<std::size_t> Disambiguator::possible_of(const RevolutionMeasurements& measured,
                                                    const SunEarthDirections& sun_earth,
                                                    const AxisCandidates& found) const {
  std::vector<std::size_t> possible;
  for (std::size_t i = 0; i < found.candidates.size(); ++i) {
    const AxisCandidate& candidate = found.candidates[i];
    if (candidate.consistent && !breaks_constraint(measured, sun_earth, candidate)) {
      possible.push_back(i);
    }
  }
  return possible;
}

std::optional<std::size_t> Disambiguator::nearest_to_known(
    const std::optional<KnownAxis>& established, const AxisCandidates& found,
    const std::vector<std::size_t>& possible) {
  if (!established && !config_.prior) {
    return std::nullopt;
  }
  const KnownAxis known = established ? *established
                                      : KnownAxis{.axis_icrf = config_.prior->axis_icrf,
                                                  .sigma_rad = config_.prior->sigma_rad};
  const Nearest nearest = nearest_to(known, found, possible);
  if (!established) {
    prior_verdict_ = nearest.verdict;
  }
  return nearest.verdict == PriorVerdict::Chooses ? std::optional{nearest.candidate} : std::nullopt;
}

void Disambiguator::ask_dispersion(const Pending& pending) {
  constexpr int kLastOfCones = 3;  // Later cases have roots that are no mirror images.
  if (pending.found.geometry_case > kLastOfCones) {
    dispersion_.note_unlike();
  }
  if (steady_) {
    return;
  }
  std::vector<AxisCandidate> possible;
  for (const std::size_t i : pending.possible) {
    possible.push_back(pending.found.candidates[i]);
  }
  newly_steady_ = dispersion_.add(possible);
  if (newly_steady_) {
    steady_ = newly_steady_->axis;
  }
}

std::vector<SpinFix> Disambiguator::settle_by_dispersion(Pending pending) {
  ask_dispersion(pending);
  std::vector<SpinFix> fixes;
  if (steady_) {
    for (const Pending& earlier : std::exchange(pending_, {})) {
      const auto chosen = continues(*steady_, earlier.found, earlier.possible);
      if (chosen && chosen != earlier.by_prior) {
        fixes.push_back(
            fix_of(earlier.revolution, earlier.t, earlier.found, *chosen, Resolution::Dispersion));
      }
    }
    if (const auto chosen = continues(*steady_, pending.found, pending.possible)) {
      follow(pending, chosen);
      fixes.push_back(
          fix_of(pending.revolution, pending.t, pending.found, *chosen, Resolution::Dispersion));
      return fixes;
    }
    follow(pending, std::nullopt);
  }
  const bool by_prior = !steady_ && pending.by_prior;
  fixes.push_back(fix_of(pending.revolution, pending.t, pending.found,
                         by_prior ? *pending.by_prior : pending.possible.front(),
                         by_prior ? Resolution::Prior : Resolution::Ambiguous));
  if (!steady_) {
    pending_.push_back(std::move(pending));
    if (pending_.size() > static_cast<std::size_t>(config_.screening.window)) {
      pending_.pop_front();
    }
  }
  return fixes;
}

void Disambiguator::follow(const Pending& pending, const std::optional<std::size_t>& chosen) {
  if (chosen) {
    contradictions_ = 0;
    steady_->count = std::min(steady_->count + 1.0, static_cast<double>(config_.screening.window));
    steady_->axis_icrf +=
        (pending.found.candidates[*chosen].axis_icrf - steady_->axis_icrf) / steady_->count;
    steady_->axis_icrf.normalize();
    return;
  }
  const bool crosses =
      std::any_of(pending.possible.begin(), pending.possible.end(), [&](std::size_t i) {
        return squared_distance(steady_->axis_icrf, pending.found.candidates[i], steady_->count) <
               kContradictionSigmas * kContradictionSigmas;
      });
  contradictions_ = crosses ? 0 : contradictions_ + 1;
  if (contradictions_ >= kContradictionsInARow) {
    steady_.reset();
    dispersion_ = Dispersion{static_cast<std::size_t>(config_.screening.window)};
    contradictions_ = 0;
  }
}

}  // namespace spindrift
