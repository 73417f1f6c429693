#include "pipelines/supervision/answer_in_force.h"

#include <algorithm>
#include <iterator>
#include <utility>

#include "pipelines/frames/celestial.h"

namespace spindrift {
namespace {

constexpr double kOfNow_s = 120.0;

TaiTime newest(const LastEstimates& last) {
  TaiTime t = TaiTime::min();
  for (const auto& [estimator, estimate] : last) {
    t = std::max(t, estimate.t);
  }
  return t;
}

LastEstimates of_now(const LastEstimates& last) {
  LastEstimates now = last;
  std::erase_if(now, [t = newest(last)](const auto& one) {
    return seconds_between(one.second.t, t) > kOfNow_s;
  });
  return now;
}

bool is_ok(const SpinEstimate& estimate) { return estimate.assessment.quality == Quality::Ok; }

double variance_rad2(const SpinEstimate& estimate) { return estimate.covariance_rad2.trace(); }

/// Returns whether a newer answer contradicts that of `estimator`.
bool is_outdated(SpinEstimator estimator, const LastEstimates& now,
                 const std::vector<AxesApart>& contradictions) {
  return std::any_of(contradictions.begin(), contradictions.end(), [&](const AxesApart& pair) {
    if (pair.one != estimator && pair.other != estimator) {
      return false;
    }
    const SpinEstimator against = pair.one == estimator ? pair.other : pair.one;
    return now.at(against).t > now.at(estimator).t;
  });
}

/// Returns the estimate to report, from estimates of now.
const SpinEstimate& selected(const LastEstimates& now,
                             const std::vector<AxesApart>& contradictions) {
  const SpinEstimate* best = nullptr;
  for (const auto& [estimator, estimate] : now) {
    if (is_ok(estimate) && !is_outdated(estimator, now, contradictions) &&
        (best == nullptr || variance_rad2(estimate) <= variance_rad2(*best))) {
      best = &estimate;
    }
  }
  // SpinEstimator is in the order of the edges used.
  return best != nullptr ? *best : std::prev(now.end())->second;
}

}  // namespace

std::vector<AxesApart> axes_apart(const LastEstimates& last) {
  LastEstimates sound = of_now(last);
  std::erase_if(sound, [](const auto& one) { return !is_ok(one.second); });
  std::vector<AxesApart> pairs;
  for (auto one = sound.begin(); one != sound.end(); ++one) {
    for (auto other = std::next(one); other != sound.end(); ++other) {
      const double apart_rad = angle_between_rad(one->second.axis_icrf, other->second.axis_icrf);
      pairs.push_back({.one = one->first,
                       .other = other->first,
                       .apart_rad = apart_rad,
                       .sigmas = apart_rad / difference_sigma_rad(one->second, other->second)});
    }
  }
  return pairs;
}

std::optional<SpinAnswer> answer_in_force(const LastEstimates& last, double contradiction_sigmas) {
  if (last.empty()) {
    return std::nullopt;
  }
  std::vector<AxesApart> contradictions = axes_apart(last);
  std::erase_if(contradictions,
                [&](const AxesApart& pair) { return pair.sigmas < contradiction_sigmas; });
  SpinAnswer answer{.t = newest(last), .estimate = selected(of_now(last), contradictions)};
  answer.quality = contradictions.empty()
                       ? answer.estimate.assessment.quality
                       : std::max(answer.estimate.assessment.quality, Quality::Doubtful);
  answer.contradictions = std::move(contradictions);
  return answer;
}

void SpinAnswers::take(const SpinEstimate& estimate) {
  last_.insert_or_assign(estimate.estimator, estimate);
  if (estimate.assessment.quality == Quality::Lost) {
    changes_.insert(estimate.t);
  }
  const auto to_come = changes_.upper_bound(newest(last_));
  if (to_come != changes_.begin()) {
    std::erase_if(
        last_, [latest = *std::prev(to_come)](const auto& one) { return one.second.t < latest; });
  }
  weigh();
}

void SpinAnswers::note_fault() {
  has_failed_ = true;
  weigh();
}

void SpinAnswers::weigh() {
  in_force_ = answer_in_force(last_, limit_);
  if (in_force_ && has_failed_) {
    in_force_->quality = std::max(in_force_->quality, Quality::Doubtful);
  }
}

}  // namespace spindrift
