#include "pipelines/spin/sequential.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>
#include <utility>

#include "pipelines/frames/celestial.h"
#include "pipelines/spin/model_allowance.h"

namespace spindrift {
namespace {

double degrees(double angle_rad) { return angle_rad * 180.0 / std::numbers::pi; }

constexpr std::size_t kMostHypotheses = 8;
// So many fixes that graze, and none that does not: there will be no better ones.
constexpr std::int64_t kFewestGrazing = 20;
// Across a silence in which the phase became this uncertain, whole turns can no longer be counted:
// phase and rate start anew.
constexpr double kPhaseLost_rad = 0.3;
// Weight of one edge, or of one revolution, in the share of gated ones.
constexpr double kRecentEdge = 1.0 / 60.0;
constexpr double kRecentRevolution = 0.1;
constexpr double kMostGated = 0.5;
// A candidate is out when the edges are e^20 times likelier under another one.
constexpr double kBeyondDoubt = 20.0;
// A prior's candidate is in doubt when they are e^5 times likelier under another one: were it
// true, that would happen in one pass of 150 at most (Ville's inequality).
constexpr double kPriorInDoubt = 5.0;
// So many edges say whether a hypothesis fits them: the sum of their squared innovations,
// chi-square of one degree of freedom each, within so many of its sigmas.
constexpr double kFewestEdges = 60.0;
constexpr double kFitSigmas = 5.0;
// Mean squared angle between an axis that may point anywhere and any other.
constexpr double kAnywhere_rad2 = (std::numbers::pi * std::numbers::pi - 4.0) / 2.0;
// So many fixes beyond those that agree with the filter: then the axis is another one.
constexpr int kMostContradictions = 10;
// Where the edges do not speak against the filter, single fixes may all be off to one side: then
// their mean must contradict it, and so many more of them than agree with it.
constexpr int kManyContradictions = 30;
constexpr double kMeanSigmas = 8.0;

StartingPoint place_of(const SpinFilter& filter) {
  return {.axis_icrf = filter.axis_icrf(), .covariance_rad2 = filter.axis_covariance_rad2()};
}

/// Both filters have come to one axis.
bool agree(const SpinFilter& a, const SpinFilter& b) {
  const double apart_rad = angle_between_rad(a.axis_icrf(), b.axis_icrf());
  return apart_rad < kModelLimit_rad &&
         apart_rad * apart_rad <
             std::min(a.axis_covariance_rad2().trace(), b.axis_covariance_rad2().trace());
}

const SpinFix* last_accepted(std::span<const SpinFix> fixes) {
  const auto found = std::find_if(fixes.rbegin(), fixes.rend(),
                                  [](const SpinFix& fix) { return fix.accepted && !fix.grazing; });
  return found == fixes.rend() ? nullptr : &*found;
}

const SpinFix* last_open(std::span<const SpinFix> fixes, bool grazing) {
  const auto found = std::find_if(fixes.rbegin(), fixes.rend(), [=](const SpinFix& fix) {
    return leaves_open(fix) && fix.grazing == grazing;
  });
  return found == fixes.rend() ? nullptr : &*found;
}

}  // namespace

std::optional<SpinEstimate> SequentialEstimator::update(const Revolution& revolution,
                                                        const Sky& sky,
                                                        std::span<const SpinFix> settled) {
  const SpinFix* const accepted = last_accepted(settled);
  if (!begin(settled, revolution, sky) && !hypotheses_.empty()) {
    if (accepted != nullptr && !settled_) {
      take_side(*accepted);
    }
    add_unlike(settled, revolution, sky);
    work_in(revolution, sky);
  }
  if (hypotheses_.empty()) {
    unheard_ += settled.empty() ? 0 : 1;
    return std::nullopt;
  }
  const SpinFilter& best = hypotheses_.front().filter;
  return SpinEstimate{
      .t = revolution.t_start,
      .estimator = SpinEstimator::Sequential,
      .axis_icrf = best.axis_icrf(),
      .covariance_rad2 = covariance_rad2(),
      .spin_rate_rad_s = best.rate_rad_s(),
      .spin_rate_sigma_rad_s = best.rate_sigma_rad_s() * std::sqrt(verdict_.excess_noise),
      .status = status()};
}

Eigen::Matrix2d SequentialEstimator::covariance_rad2() const {
  if (gated_share_ > kMostGated) {
    return Eigen::Matrix2d::Identity() * (0.5 * kAnywhere_rad2);
  }
  const SpinFilter& filter = hypotheses_.front().filter;
  const Eigen::Matrix<double, 2, kModelErrors> moved = filter.axis_of_errors();
  return filter.axis_covariance_rad2() * verdict_.excess_noise +
         moved * verdict_.errors_rad2 * moved.transpose();
}

double SequentialEstimator::model_leverage() const {
  return hypotheses_.front().filter.axis_of_errors().norm();
}

/// Candidates of a fix that leaves them open, which no filter follows. What is settled is asked
/// again only where the fix does not name its axis at all.
void SequentialEstimator::add_unlike(std::span<const SpinFix> settled, const Revolution& revolution,
                                     const Sky& sky) {
  const SpinFix* const fix = last_open(settled, provisional_);
  if (fix == nullptr) {
    return;
  }
  std::vector<StartingPoint> unlike = candidates_of(*fix);
  const std::size_t named = unlike.size();
  std::erase_if(unlike, [&](const StartingPoint& candidate) {
    return std::any_of(hypotheses_.begin(), hypotheses_.end(), [&](const Hypothesis& h) {
      return !contradict(candidate, place_of(h.filter));
    });
  });
  if (settled_ && (verdict_.excess_noise == 1.0 || unlike.size() < named)) {
    return;
  }
  for (const StartingPoint& point : unlike_.add(unlike)) {
    if (hypotheses_.size() < kMostHypotheses && well_known(point.covariance_rad2)) {
      if (const auto filter =
              SpinFilter::about(point.axis_icrf, point.covariance_rad2, config_, revolution, sky)) {
        // The benefit of the doubt: as likely so far as the likeliest.
        hypotheses_.push_back(
            {.filter = *filter, .log_likelihood = hypotheses_.front().log_likelihood});
        settled_ = false;
        settled_by_edges_ = false;
      }
    }
  }
}

/// Only an accepted fix may start the filter again.
bool SequentialEstimator::restart_is_due(std::span<const SpinFix> settled) {
  if (hypotheses_.empty()) {
    return false;
  }
  for (const SpinFix& fix : settled) {
    if (fix.accepted && !fix.grazing) {
      note_contradiction(fix);
    }
  }
  if (last_accepted(settled) == nullptr) {
    return false;
  }
  if (gated_share_ > kMostGated) {
    restarted_ = "edges gated";
    return true;
  }
  const bool edges_contradict = verdict_.excess_noise > 1.0 || mostly_gated().has_value();
  if (contradicted_ >= kMostContradictions && (edges_contradict || fixes_contradict())) {
    restarted_ = "fixes differ";
    return true;
  }
  return false;
}

/// Poor fixes speak together: averaged until they are known as well as one that starts a filter,
/// and then afresh, as what they have in common to one side does not average out.
void SequentialEstimator::note_contradiction(const SpinFix& fix) {
  std::vector<StartingPoint> points = candidates_of(fix);
  int speaking = 1;
  if (!well_known(fix.covariance_rad2)) {
    ++poor_fixes_;
    points = poor_.add(points);
    if (!well_known(points.front().covariance_rad2)) {
      return;
    }
    speaking = std::exchange(poor_fixes_, 0);
    poor_ = {};
  }
  const bool against = std::all_of(hypotheses_.begin(), hypotheses_.end(), [&](const auto& h) {
    return std::all_of(points.begin(), points.end(), [&](const StartingPoint& point) {
      return contradict(point, place_of(h.filter));
    });
  });
  contradicted_ = std::max(0, contradicted_ + (against ? speaking : -speaking));
  contradicting_ = contradicted_ > 0 ? contradicting_ : MeanAxis{};
  contradicting_.add(points.front().axis_icrf, points.front().covariance_rad2);
}

bool SequentialEstimator::fixes_contradict() const {
  if (contradicted_ < kManyContradictions) {
    return false;
  }
  const Eigen::Vector3d mean_icrf = contradicting_.axis_icrf();
  return std::all_of(hypotheses_.begin(), hypotheses_.end(), [&](const auto& h) {
    const double sigma_rad = std::sqrt(contradicting_.covariance_rad2().trace() +
                                       h.filter.axis_covariance_rad2().trace());
    return angle_between_rad(mean_icrf, h.filter.axis_icrf()) >
           std::hypot(kMeanSigmas * sigma_rad, kModelLimit_rad);
  });
}

/// Begins, or begins again, where the fixes say; grazing ones only if there have been many and no
/// others.
bool SequentialEstimator::begin(std::span<const SpinFix> settled, const Revolution& revolution,
                                const Sky& sky) {
  if (!hypotheses_.empty() && !provisional_ && !restart_is_due(settled)) {
    return false;
  }
  const SpinFix* fix = last_accepted(settled);
  fix = fix != nullptr ? fix : last_open(settled, false);
  if (fix == nullptr && (hypotheses_.empty() || gated_share_ > kMostGated)) {
    fix = last_open(settled, true);
    grazing_ += fix != nullptr ? 1 : 0;
  }
  if (fix == nullptr) {
    return false;
  }
  // A branch that only alternates have made is not confirmed by a settled fix that comes near it.
  StartingPoints& starts = leaves_open(*fix) ? open_starts_ : settled_starts_;
  const std::vector<StartingPoint> points = starts.add(candidates_of(*fix));
  const bool known = std::all_of(points.begin(), points.end(), [](const StartingPoint& point) {
    return well_known(point.covariance_rad2);
  });
  // Without one of them the true one may be missing.
  return known && (!fix->grazing || grazing_ >= kFewestGrazing) &&
         start(*fix, points, revolution, sky);
}

bool SequentialEstimator::start(const SpinFix& fix, std::span<const StartingPoint> points,
                                const Revolution& revolution, const Sky& sky) {
  std::vector<Hypothesis> started;
  for (const StartingPoint& point : points) {
    const auto filter =
        SpinFilter::about(point.axis_icrf, point.covariance_rad2, config_, revolution, sky);
    if (!filter) {
      return false;
    }
    // The fix's own axis comes first.
    started.push_back(
        {.filter = *filter, .favoured = fix.resolution == Resolution::Prior && started.empty()});
  }
  follow(fix, std::move(started));
  return true;
}

/// From here on these alone; what was counted since the last start is forgotten.
void SequentialEstimator::follow(const SpinFix& fix, std::vector<Hypothesis> started) {
  restarts_ += hypotheses_.empty() || provisional_ ? 0 : 1;
  noise_at_restart_ = verdict_.excess_noise;
  watch_.fade();
  verdict_ = watch_.verdict();
  hypotheses_ = std::move(started);
  settled_starts_ = {};
  open_starts_ = {};
  unlike_ = {};
  provisional_ = fix.grazing;
  revolutions_ = 0;
  gated_ = 0;
  gated_share_ = 0.0;
  channel_gated_share_ = {};
  settled_ = fix.accepted && !provisional_ && hypotheses_.size() == 1;
  settled_by_edges_ = false;
  contradicted_ = 0;
  contradicting_ = MeanAxis{};
  poor_ = {};
  poor_fixes_ = 0;
}

/// A fix settles which of the candidates is true, unless it contradicts them all.
void SequentialEstimator::take_side(const SpinFix& fix) {
  const auto nearest = std::max_element(
      hypotheses_.begin(), hypotheses_.end(), [&](const Hypothesis& a, const Hypothesis& b) {
        return a.filter.axis_icrf().dot(fix.axis_icrf) < b.filter.axis_icrf().dot(fix.axis_icrf);
      });
  if (contradict({fix.axis_icrf, fix.covariance_rad2}, place_of(nearest->filter))) {
    return;
  }
  if (fix.resolution == Resolution::Prior) {
    for (Hypothesis& hypothesis : hypotheses_) {
      hypothesis.favoured = !prior_refuted_ && &hypothesis == &*nearest;
    }
  } else {
    std::swap(hypotheses_.front(), *nearest);
    hypotheses_.erase(hypotheses_.begin() + 1, hypotheses_.end());
    settled_ = true;
  }
}

void SequentialEstimator::work_in(const Revolution& revolution, const Sky& sky) {
  const GoodEdges edges{revolution};
  const double gate_noise = std::min(verdict_.excess_noise, noise_at_restart_);
  for (Hypothesis& hypothesis : hypotheses_) {
    SpinFilter& filter = hypothesis.filter;
    filter.predict(revolution.t_start);
    if (filter.phase_sigma_rad() > kPhaseLost_rad) {
      filter = SpinFilter::about(filter.axis_icrf(), filter.axis_covariance_rad2(), config_,
                                 revolution, sky)
                   .value_or(filter);
      hypothesis.tally = {};
    } else {
      hypothesis.tally = filter.update(config_, sky, edges.span(), gate_noise);
    }
    const EdgeTally& tally = hypothesis.tally;
    hypothesis.edges += static_cast<double>(tally.accepted.count() + tally.gated.count());
    hypothesis.log_likelihood += tally.log_likelihood;
    hypothesis.squared_innovations += tally.squared_innovations;
  }
  drop_the_beaten();
  count(hypotheses_.front().tally);
}

void SequentialEstimator::drop_the_beaten() {
  std::stable_sort(hypotheses_.begin(), hypotheses_.end(), [](const auto& a, const auto& b) {
    return a.log_likelihood > b.log_likelihood;
  });
  Hypothesis& best = hypotheses_.front();
  const bool fits =
      best.edges >= kFewestEdges &&
      best.squared_innovations < best.edges + kFitSigmas * std::sqrt(2.0 * best.edges);
  const std::size_t before = hypotheses_.size();
  const auto beaten = [&](const Hypothesis& other) {
    const bool same = agree(best.filter, other.filter);
    const bool out = fits && best.log_likelihood - other.log_likelihood > kBeyondDoubt;
    best.favoured = best.favoured || (same && other.favoured);
    if (!same && out && other.favoured) {
      prior_refuted_ = true;
      ++restarts_;
    }
    return same || out;
  };
  hypotheses_.erase(std::remove_if(hypotheses_.begin() + 1, hypotheses_.end(), beaten),
                    hypotheses_.end());
  settled_by_edges_ =
      settled_by_edges_ || (fits && before > 1 && hypotheses_.size() == 1 && !provisional_);
  settled_ = settled_ || settled_by_edges_;
  // Unbeaten, the prior's candidate stands before likelier ones.
  std::stable_partition(hypotheses_.begin(), hypotheses_.end(),
                        [](const Hypothesis& h) { return h.favoured; });
}

/// No other hypothesis is so much likelier than the one that the prior chose. What passed before
/// the filters began might have contradicted it: until they have seen as much, nothing is said. Nor
/// where all fixes graze: filters that began to one side of the axis need not come to it.
bool SequentialEstimator::prior_stands() const {
  const Hypothesis& first = hypotheses_.front();
  return first.favoured && !provisional_ && revolutions_ >= unheard_ &&
         std::all_of(hypotheses_.begin() + 1, hypotheses_.end(), [&](const Hypothesis& other) {
           return other.log_likelihood - first.log_likelihood < kPriorInDoubt;
         });
}

std::optional<KnownAxis> SequentialEstimator::settled_by_edges() const {
  if (!settled_by_edges_ || hypotheses_.size() > 1 || gated_share_ > kMostGated) {
    return std::nullopt;
  }
  return KnownAxis{.axis_icrf = hypotheses_.front().filter.axis_icrf(),
                   .sigma_rad = std::hypot(std::sqrt(covariance_rad2().trace()), kModelLimit_rad)};
}

void SequentialEstimator::count(const EdgeTally& tally) {
  const auto gated = static_cast<double>(tally.gated.count());
  const double edges = gated + static_cast<double>(tally.accepted.count());
  gated_share_ += kRecentEdge * (gated - edges * gated_share_);
  watch_.note(tally);
  verdict_ = watch_.verdict();
  // The first edges pull the filter from its start to where they fit.
  const double before = hypotheses_.front().edges - edges;
  if (before < kFewestEdges && before + edges >= kFewestEdges) {
    watch_.forget_the_start();
  }
  // Of the first revolutions the plain mean: what starts wrong says so at once.
  const double recent = std::max(kRecentRevolution, 1.0 / static_cast<double>(revolutions_ + 1));
  for (std::size_t channel = 0; channel < kPulseChannels; ++channel) {
    double& share = channel_gated_share_.at(channel);
    share += recent * ((tally.gated.test(channel) ? 1.0 : 0.0) - share);
  }
  gated_ += static_cast<std::int64_t>(tally.gated.count());
  ++revolutions_;
}

std::optional<PulseChannel> SequentialEstimator::mostly_gated() const {
  const auto* const worst =
      std::max_element(channel_gated_share_.begin(), channel_gated_share_.end());
  return *worst > kMostGated ? std::optional{static_cast<PulseChannel>(
                                   std::distance(channel_gated_share_.begin(), worst))}
                             : std::nullopt;
}

std::string SequentialEstimator::ambiguous_status() const {
  if (hypotheses_.size() == 1) {
    return provisional_
               ? "AMBIGUOUS, or none: all fixes graze"
               : fmt::format("AMBIGUOUS, no fix has settled it, {} revolutions", revolutions_);
  }
  const RaDec other = ra_dec_of(hypotheses_[1].filter.axis_icrf());
  const std::string named = fmt::format("AMBIGUOUS, or ra {:.2f} dec {:.2f} deg",
                                        degrees(other.ra_rad), degrees(other.dec_rad));
  if (provisional_) {
    return named + ", or none: all fixes graze";
  }
  return hypotheses_.size() > 2 ? fmt::format("{}, or {} more", named, hypotheses_.size() - 2)
                                : fmt::format("{}, {} revolutions", named, revolutions_);
}

std::string SequentialEstimator::status() const {
  if (gated_share_ > kMostGated) {
    return fmt::format("LOST, {} edges gated, awaiting a fix", gated_);
  }
  if ((!settled_ || hypotheses_.size() > 1) && !prior_stands()) {
    return ambiguous_status();
  }
  if (const auto channel = mostly_gated()) {
    return fmt::format("DOUBTFUL, most {} edges gated, {} revolutions", name_of(*channel),
                       revolutions_);
  }
  if (verdict_.excess_noise > 1.0) {
    return fmt::format("DOUBTFUL, residuals {:.1f} x stated noise, {} revolutions",
                       std::sqrt(verdict_.excess_noise), revolutions_);
  }
  if (verdict_.error_rad > 0.0) {
    return fmt::format("{}, model off by {:.2g} deg, {} revolutions",
                       verdict_.beyond_allowance ? "DOUBTFUL" : "OK", degrees(verdict_.error_rad),
                       revolutions_);
  }
  const std::string counts =
      fmt::format("OK, {} revolutions, {} edges gated", revolutions_, gated_);
  if (prior_refuted_) {
    return counts + ", prior refuted";
  }
  return restarted_.empty() ? counts : fmt::format("{}, restart: {}", counts, restarted_);
}

}  // namespace spindrift
