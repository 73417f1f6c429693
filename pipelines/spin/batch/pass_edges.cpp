#include "pipelines/spin/batch/pass_edges.h"

#include <algorithm>
#include <cmath>
#include <type_traits>
#include <utility>
#include <variant>

#include "pipelines/frames/angle.h"
#include "pipelines/frames/celestial.h"
#include "pipelines/spin/measurement/measurement.h"

namespace spindrift {
namespace {

/// Returns whether the edge itself is bad: out of place or without anything to compare it with.
/// Otherwise it is one of several edges of an angle that failed its test.
bool is_bad(Rejection rejection) {
  return rejection != Rejection::Geometry &&
         std::none_of(kMeasuredAngles.begin(), kMeasuredAngles.end(),
                      [&](SpinQuantity angle) { return rejection_of(angle) == rejection; });
}

}  // namespace

void PassEdges::collect(const SpinProduct& product) {
  std::visit([this](const auto& value) { keep(value); }, product);
}

std::size_t PassEdges::act(TaiTime t, const SpinAction& action) {
  const std::size_t before = edges_.size();
  std::visit(
      [&](const auto& what) {
        if constexpr (requires { excluded_.apply(t, what); }) {
          excluded_.apply(t, what);
          std::erase_if(edges_, [this](const PassEdge& edge) {
            return excluded_.hold(edge.pulse.t, edge.pulse.channel);
          });
        } else if constexpr (std::is_same_v<std::decay_t<decltype(what)>, MarkManoeuvre>) {
          manoeuvres_.insert(t);
        }
      },
      action);
  return before - edges_.size();
}

void PassEdges::forget_before(TaiTime t) {
  std::erase_if(edges_, [t](const PassEdge& edge) { return edge.pulse.t < t; });
  mean_.reset();
  sequential_.reset();
  last_fix_.reset();
}

void PassEdges::keep(const PulseUse& use) {
  while (use.revolution && !manoeuvres_.empty() && *manoeuvres_.begin() <= use.pulse.t) {
    forget_before(manoeuvres_.extract(manoeuvres_.begin()).value());
  }
  if (use.revolution && !(use.rejected_by && is_bad(*use.rejected_by)) &&
      !excluded_.hold(use.pulse.t, use.pulse.channel)) {
    edges_.push_back({.pulse = use.pulse, .revolution = *use.revolution});
    last_revolution_ = std::max(last_revolution_, *use.revolution);
    if (edges_.size() == kMost + kMost / 8) {
      edges_.erase(edges_.begin(), edges_.end() - kMost);
      forgot_some_ = true;
    }
  }
}

void PassEdges::keep(const SpinEstimate& estimate) {
  noise_chose_among_copies_ =
      noise_chose_among_copies_ || has(estimate.assessment, ReasonCode::CopiesInNoise);
  if (estimate.estimator == SpinEstimator::Mean) {
    mean_ = estimate;
  } else if (estimate.estimator == SpinEstimator::Sequential) {
    sequential_ = estimate;
  }
}

void PassEdges::keep_last(std::int64_t revolutions) {
  std::erase_if(edges_, [&](const PassEdge& edge) {
    return edge.revolution <= last_revolution_ - revolutions;
  });
}

std::optional<TaiTime> PassEdges::last() const {
  const auto last =
      std::max_element(edges_.begin(), edges_.end(),
                       [](const PassEdge& a, const PassEdge& b) { return a.pulse.t < b.pulse.t; });
  return last == edges_.end() ? std::nullopt : std::optional{last->pulse.t};
}

std::vector<PassEdge> PassEdges::edges() && {
  std::vector<PassEdge> sorted = std::move(edges_);
  std::stable_sort(sorted.begin(), sorted.end(),
                   [](const PassEdge& a, const PassEdge& b) { return a.pulse < b.pulse; });
  const auto same = [](const PassEdge& a, const PassEdge& b) { return a.pulse == b.pulse; };
  sorted.erase(std::unique(sorted.begin(), sorted.end(), same), sorted.end());
  sorted.erase(sorted.begin(), sorted.end() - std::min<std::ptrdiff_t>(std::ssize(sorted), kMost));
  return sorted;
}

StartingAxes PassEdges::starts(const std::optional<SpinPrior>& prior) const {
  std::vector<Eigen::Vector3d> all;
  const auto add = [&all](const Eigen::Vector3d& axis_icrf) {
    const bool known = std::any_of(all.begin(), all.end(), [&](const Eigen::Vector3d& other) {
      // Starts this near end at the same place. The narrowest chord vanishes within a degree.
      return angle_between_rad(other, axis_icrf) < 0.1 * kRadPerDeg;
    });
    if (!known) {
      all.push_back(axis_icrf);
    }
  };
  for (const auto* const estimate : {&sequential_, &mean_}) {
    if (*estimate) {
      add((*estimate)->axis_icrf);
    }
  }
  const bool settled = sequential_ && is_unopposed(sequential_->assessment.quality);
  if (last_fix_ && !settled) {
    add(last_fix_->axis_icrf);
    for (const SpinAlternate& alternate : last_fix_->alternates) {
      add(alternate.axis_icrf);
    }
  }
  if (all.empty() && prior) {
    add(prior->axis_icrf);
  }
  return {.axes_icrf = std::move(all), .settled = settled};
}

}  // namespace spindrift
