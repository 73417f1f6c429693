#include "pipelines/spin/batch/multi_start.h"

#include <algorithm>
#include <iterator>
#include <utility>
#include <vector>

#include "pipelines/frames/angle.h"
#include "pipelines/frames/celestial.h"
#include "pipelines/spin/batch/batch_fit.h"
#include "pipelines/spin/batch/initial_state.h"
#include "pipelines/spin/batch/pass_nutation.h"
#include "pipelines/statistics/significance.h"

namespace spindrift {
namespace {

Expected<EvaluatedFit> with_stretches(const PassModel& model, std::span<const PassEdge> edges,
                                      SpinState near, BiasSet estimated, PassNutation nutation) {
  near.nutation = std::move(nutation.stretches);
  return explain(model, edges, near, estimated).map([&](EvaluatedFit nutating) {
    nutating.nutation = nutation.last;
    return nutating;
  });
}

/// Returns whether most edges would lie where Tukey's loss is not convex, which makes the fit slow.
bool is_scattered(const PassModel& model, std::span<const PassEdge> edges, const SpinState& state) {
  const std::size_t stride = std::max<std::size_t>(edges.size() / kCoarseEdges, 1);
  std::vector<PassEdge> few;
  for (std::size_t i = 0; i < edges.size(); i += stride) {
    few.push_back(edges[i]);
  }
  // Scatter, in stated sigmas, above which the body nutates or the noise is not as stated.
  return scatter_of(uniform_spin_residuals(model, few, state)) > 1.3;
}

Expected<EvaluatedFit> with_nutation(const PassModel& model, std::span<const PassEdge> edges,
                                     EvaluatedFit steady) {
  PassNutation nutation = find_pass_nutation(model, edges, steady.fit.state);
  steady.nutation = nutation.last;
  if (nutation.stretches.empty()) {
    return steady;
  }
  return with_stretches(model, edges, steady.fit.state, steady.estimated, std::move(nutation));
}

/// Takes out nutation first, because it would hide changes and biases, which are slow and do not
/// look like nutation.
Expected<EvaluatedFit> explain_motion(const PassModel& model, std::span<const PassEdge> edges,
                                      const SpinState& near, BiasSet estimated) {
  if (is_scattered(model, edges, near)) {
    PassNutation nutation = find_pass_nutation(model, edges, near);
    if (!nutation.stretches.empty()) {
      return with_stretches(model, edges, near, estimated, std::move(nutation));
    }
  }
  return explain(model, edges, near, estimated).map([&](const EvaluatedFit& steady) {
    return with_nutation(model, edges, steady).value_or(steady);
  });
}

bool same_axis(const SpinState& one, const SpinState& other) {
  // Two starts that end within this angle have reached the same solution.
  return angle_between_rad(one.axis_icrf(), other.axis_icrf()) < 0.1 * kRadPerDeg;
}

bool likelier(const EvaluatedFit& one, const EvaluatedFit& other) {
  return one.misfit() < other.misfit();
}

/// Returns a state near each distinct axis that the starts lead to, in the order of the starts.
Expected<std::vector<SpinState>> ends_of(const PassModel& model, std::span<const PassEdge> edges,
                                         std::span<const Eigen::Vector3d> starts,
                                         BiasSet estimated) {
  std::vector<SpinState> ends;
  std::optional<Error> reason;
  for (const Eigen::Vector3d& start : starts) {
    const auto near = initial_state(model, edges, start);
    if (!near) {
      reason = reason.value_or(near.error());
      continue;
    }
    const SpinState end = coarse_fit(model, edges, *near, estimated);
    if (std::none_of(ends.begin(), ends.end(),
                     [&](const SpinState& other) { return same_axis(end, other); })) {
      ends.push_back(end);
    }
  }
  if (ends.empty()) {
    return Unexpected{*reason};
  }
  return ends;
}

/// Returns the possible axes that agree with the mission's prior, or all if none does.
std::vector<EvaluatedFit> expected_of(std::vector<EvaluatedFit> possible,
                                      const std::optional<SpinPrior>& prior) {
  const auto is_unexpected = [&](const EvaluatedFit& one) {
    return prior && angle_between_rad(one.fit.state.axis_icrf(), prior->axis_icrf) >
                        kPriorSigmas * prior->sigma_rad;
  };
  if (!std::all_of(possible.begin(), possible.end(), is_unexpected)) {
    std::erase_if(possible, is_unexpected);
  }
  return possible;
}

}  // namespace

Expected<Best> best_of_starts(const PassModel& model, std::span<const PassEdge> edges,
                              std::span<const Eigen::Vector3d> starts, BiasSet estimated) {
  const auto ends = ends_of(model, edges, starts, estimated);
  if (!ends) {
    return Unexpected{ends.error()};
  }
  std::vector<EvaluatedFit> all;
  std::optional<Error> reason;
  for (const SpinState& end : *ends) {
    auto one = explain_motion(model, edges, end, estimated);
    if (one) {
      all.push_back(*std::move(one));
    } else {
      reason = reason.value_or(one.error());
    }
  }
  if (all.empty()) {
    return Unexpected{*reason};
  }
  std::stable_sort(all.begin(), all.end(), likelier);
  const double settled = all.front().misfit() + kSettled * all.front().excess_noise();
  std::vector<EvaluatedFit> likely;
  std::copy_if(all.begin(), all.end(), std::back_inserter(likely),
               [&](const EvaluatedFit& one) { return one.misfit() <= settled; });
  const auto possible = expected_of(std::move(likely), model.config().prior);
  Best found{.best = possible.front(), .alternate_axis_icrf = {}, .other = {}};
  const auto is_elsewhere = [&](const EvaluatedFit& one) {
    return !same_axis(one.fit.state, found.best.fit.state);
  };
  const auto alternate = std::find_if(possible.begin(), possible.end(), is_elsewhere);
  if (alternate != possible.end()) {
    found.alternate_axis_icrf = alternate->fit.state.axis_icrf();
  }
  const auto other = std::find_if(all.begin(), all.end(), is_elsewhere);
  if (other != all.end()) {
    found.other = {.axis_icrf = other->fit.state.axis_icrf(),
                   .more_misfit = other->misfit() - found.best.misfit()};
    found.by_prior = alternate == possible.end() && other->misfit() <= settled;
  }
  return found;
}

OtherAxis compared_with(const EvaluatedFit& best, const PassModel& model,
                        std::span<const PassEdge> edges, const Eigen::Vector3d& axis_icrf) {
  const auto near = initial_state(model, edges, axis_icrf);
  if (!near) {
    const double bound = static_cast<double>(edges.size()) * kOutlierSigmas * kOutlierSigmas;
    return {.axis_icrf = axis_icrf, .more_misfit = bound - best.misfit()};
  }
  const SpinState end = coarse_fit(model, edges, *near, best.estimated);
  const SpinState& other = same_axis(end, best.fit.state) ? *near : end;
  return {.axis_icrf = other.axis_icrf(),
          .more_misfit = evaluated(model, edges, {.state = other, .at_bound = {}, .iterations = 0},
                                   best.estimated)
                             .misfit() -
                         best.misfit()};
}

}  // namespace spindrift
