#include "pipelines/spin/sequential/hypotheses.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "pipelines/frames/celestial.h"
#include "pipelines/spin/types/model_allowance.h"
#include "pipelines/statistics/significance.h"

namespace spindrift {
namespace {

constexpr double kBeyondDoubt = 20.0;
// A true candidate falls behind another by e^5 in one pass of 150 at most (Ville's inequality).
constexpr double kUnlikely = 5.0;

StartingPoint place_of(const Hypothesis& hypothesis) {
  return {.axis_icrf = hypothesis.filter.axis_icrf(),
          .covariance_rad2 = hypothesis.filter.total_covariance_rad2()};
}

/// Returns whether both filters have converged to one axis.
bool agree(const SpinFilter& a, const SpinFilter& b) {
  const double apart_rad = angle_between_rad(a.axis_icrf(), b.axis_icrf());
  return apart_rad < kModelLimit_rad &&
         apart_rad * apart_rad <
             std::min(a.axis_covariance_rad2().trace(), b.axis_covariance_rad2().trace());
}

/// Tests the sum of squared innovations as a chi-square with one degree of freedom per edge.
bool fits(const Hypothesis& hypothesis) {
  return hypothesis.edges >= kFewestEdgesToFit &&
         noise_is_as_stated(hypothesis.squared_innovations, hypothesis.edges);
}

}  // namespace

std::vector<StartingPoint> Hypotheses::followed() const {
  std::vector<StartingPoint> places;
  std::transform(all_.begin(), all_.end(), std::back_inserter(places), place_of);
  return places;
}

std::optional<Hypotheses::Rival> Hypotheses::rival() const {
  return all_.size() > 1
             ? std::optional{Rival{.axis_icrf = all_[1].filter.axis_icrf(),
                                   .less = all_[0].log_likelihood - all_[1].log_likelihood}}
             : eliminated_;
}

bool Hypotheses::contradicted_by(const StartingPoint& point) const {
  return std::all_of(all_.begin(), all_.end(), [&](const Hypothesis& hypothesis) {
    return contradict(point, place_of(hypothesis));
  });
}

bool Hypotheses::closed() const {
  // Stray edges may make a false fix, even twice.
  return !all_.empty() && !provisional_ && published().eliminated_another &&
         published().fixes >= 5 &&
         std::all_of(all_.begin() + 1, all_.end(),
                     [](const Hypothesis& other) { return other.late; });
}

/// Where all fixes are near-tangent the edges must fit as well, since filters that began to one
/// side of the axis need not converge to it.
bool Hypotheses::prior_stands() const {
  return published().preferred_by_prior && (!provisional_ || fits(published())) &&
         std::all_of(all_.begin() + 1, all_.end(), [&](const Hypothesis& other) {
           return other.log_likelihood - published().log_likelihood < kUnlikely;
         });
}

bool Hypotheses::try_start(const StartingPoint& point, const SpinConfig& config,
                           const Revolution& revolution, const Sky& sky) {
  const auto filter =
      SpinFilter::about(point.axis_icrf, point.covariance_rad2, config, revolution, sky);
  if (!filter) {
    return false;
  }
  Hypothesis added{.filter = *filter};
  if (!all_.empty()) {
    Hypothesis& published = all_.front();
    published.eliminated_another = published.eliminated_another && !settled() && !closed();
    added.log_likelihood = published.log_likelihood;
    added.late = published.eliminated_another;
  }
  all_.push_back(std::move(added));
  settled_ = false;
  return true;
}

void Hypotheses::count_fix(const StartingPoints::Known& said) {
  for (Hypothesis& hypothesis : all_) {
    const bool named = std::any_of(
        said.points.begin(), said.points.end(),
        [&](const StartingPoint& point) { return !contradict(point, place_of(hypothesis)); });
    hypothesis.fixes += named ? said.fixes : 0;
  }
}

/// Returns the nearest candidate; the end if `point` contradicts it.
std::vector<Hypothesis>::iterator Hypotheses::at(const StartingPoint& point) {
  const auto nearest =
      std::max_element(all_.begin(), all_.end(), [&](const Hypothesis& a, const Hypothesis& b) {
        return a.filter.axis_icrf().dot(point.axis_icrf) <
               b.filter.axis_icrf().dot(point.axis_icrf);
      });
  return contradict(point, place_of(*nearest)) ? all_.end() : nearest;
}

void Hypotheses::settle_at(const StartingPoint& point) {
  if (const auto chosen = at(point); chosen != all_.end()) {
    std::swap(all_.front(), *chosen);
    all_.erase(all_.begin() + 1, all_.end());
    settled_ = true;
  }
}

void Hypotheses::prefer_at(const StartingPoint& point) {
  if (const auto chosen = at(point); chosen != all_.end()) {
    for (Hypothesis& hypothesis : all_) {
      hypothesis.preferred_by_prior = &hypothesis == &*chosen;
    }
  }
}

void Hypotheses::prefer_near(const SpinPrior& prior) {
  std::vector<Hypothesis*> near;
  for (Hypothesis& hypothesis : all_) {
    const SpinFilter& filter = hypothesis.filter;
    const double sigma_rad =
        std::hypot(prior.sigma_rad, std::sqrt(filter.total_covariance_rad2().trace()));
    if (angle_between_rad(filter.axis_icrf(), prior.axis_icrf) < kPriorSigmas * sigma_rad) {
      near.push_back(&hypothesis);
    }
  }
  if (near.size() == 1) {
    near.front()->preferred_by_prior = true;
  }
}

bool Hypotheses::work_in(const SpinConfig& config, const Revolution& revolution, const Sky& sky,
                         const ChannelNoise& noise) {
  const GoodEdges edges{config, revolution};
  for (Hypothesis& hypothesis : all_) {
    SpinFilter& filter = hypothesis.filter;
    filter.predict(revolution.t_start);
    // After a gap that makes the phase this uncertain, turns can no longer be counted and phase and
    // rate start anew.
    if (filter.phase_sigma_rad() > 0.3) {
      filter = SpinFilter::about(
                   filter.axis_icrf(),
                   filter.axis_covariance_rad2() +
                       filter.considered_rad2(considered_prior(config.noise, config.alignment)),
                   config, revolution, sky)
                   .value_or(filter);
      hypothesis.said = {};
    } else {
      hypothesis.said = filter.update(config, sky, edges.span(), noise);
    }
    const RevolutionObservations& said = hypothesis.said;
    const bool was_new = hypothesis.edges < kFewestEdgesToFit;
    hypothesis.edges += static_cast<double>(said.edges().size());
    hypothesis.log_likelihood += said.log_likelihood;
    hypothesis.squared_innovations += said.squared_innovations();
    // Early edges of a filter are unlikely because it knows little. A late candidate is compared
    // with the others, which have this phase behind them, only from here on.
    if (hypothesis.late && was_new && hypothesis.edges >= kFewestEdgesToFit) {
      hypothesis.log_likelihood = std::max(hypothesis.log_likelihood, published().log_likelihood);
    }
  }
  return drop_eliminated();
}

bool Hypotheses::drop_eliminated() {
  std::stable_sort(all_.begin(), all_.end(), [](const Hypothesis& a, const Hypothesis& b) {
    return a.log_likelihood > b.log_likelihood;
  });
  Hypothesis& best = all_.front();
  const bool best_fits = fits(best);
  bool prior_beaten = false;
  const auto beaten = [&](const Hypothesis& other) {
    const bool judged = other.late && other.edges >= kFewestEdgesToFit && best.eliminated_another;
    const double enough = judged ? kUnlikely : kBeyondDoubt;
    const bool same = agree(best.filter, other.filter);
    const bool out = best_fits && best.log_likelihood - other.log_likelihood > enough;
    best.preferred_by_prior = best.preferred_by_prior || (same && other.preferred_by_prior);
    prior_beaten = prior_beaten || (!same && out && other.preferred_by_prior);
    if (!same && out) {
      eliminated_ = Rival{.axis_icrf = other.filter.axis_icrf(),
                          .less = best.log_likelihood - other.log_likelihood};
    }
    return same || out;
  };
  const auto left = std::remove_if(all_.begin() + 1, all_.end(), beaten);
  best.eliminated_another = best.eliminated_another || (best_fits && left != all_.end());
  all_.erase(left, all_.end());
  // The prior's candidate stays before likelier ones until it is beaten.
  std::stable_partition(all_.begin(), all_.end(),
                        [](const Hypothesis& hypothesis) { return hypothesis.preferred_by_prior; });
  return prior_beaten;
}

}  // namespace spindrift
