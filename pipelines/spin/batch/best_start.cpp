#include "pipelines/spin/batch/best_start.h"

#include <algorithm>
#include <vector>

#include "pipelines/frames/celestial.h"
#include "pipelines/spin/batch/first_clock.h"
#include "pipelines/spin/batch/pass_nutation.h"

namespace spindrift {
namespace {

// Two ends of two starts are one solution within this: 0.1 deg.
constexpr double kSameAxis_rad = 0.1 * 0.017453292519943295;
// exp(10) times as likely settles it, as for the filters of `sequential`.
constexpr double kSettled = 20.0;

/// Nutation is taken out before anything else is asked of the residuals: it would hide changes and
/// biases, which themselves are slow and do not look like it.
Expected<Explained> with_nutation(const PassModel& model, std::span<const PassEdge> edges,
                                  Explained steady) {
  PassNutation nutation = find_pass_nutation(model, edges, steady.fit.state);
  steady.nutation = nutation.last;
  if (nutation.stretches.empty()) {
    return steady;
  }
  SpinState start = steady.fit.state;
  start.nutation = std::move(nutation.stretches);
  return explain(model, edges, start, steady.estimated).map([&](Explained nutating) {
    nutating.nutation = nutation.last;
    return nutating;
  });
}

bool same_axis(const SpinState& one, const SpinState& other) {
  return angle_between_rad(one.axis_icrf(), other.axis_icrf()) < kSameAxis_rad;
}

bool likelier(const Explained& one, const Explained& other) {
  return one.misfit() < other.misfit();
}

/// Near each axis that a start leads to, in the order of the starts.
Expected<std::vector<SpinState>> ends_of(const PassModel& model, std::span<const PassEdge> edges,
                                         std::span<const Eigen::Vector3d> starts,
                                         BiasSet estimated) {
  std::vector<SpinState> ends;
  std::optional<Error> reason;
  for (const Eigen::Vector3d& start : starts) {
    const auto near = first_state(model, edges, start);
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

}  // namespace

Expected<Best> best_of(const PassModel& model, std::span<const PassEdge> edges,
                       std::span<const Eigen::Vector3d> starts, BiasSet estimated) {
  const auto ends = ends_of(model, edges, starts, estimated);
  if (!ends) {
    return Unexpected{ends.error()};
  }
  std::vector<Explained> all;
  std::optional<Error> reason;
  for (const SpinState& end : *ends) {
    const auto one = explain(model, edges, end, estimated);
    if (one) {
      all.push_back(with_nutation(model, edges, *one).value_or(*one));
    } else {
      reason = reason.value_or(one.error());
    }
  }
  if (all.empty()) {
    return Unexpected{*reason};
  }
  std::stable_sort(all.begin(), all.end(), likelier);
  const Explained& best = all.front();
  const double settled = kSettled * best.excess_noise();
  const auto other = std::find_if(all.begin() + 1, all.end(), [&](const Explained& one) {
    return !same_axis(one.fit.state, best.fit.state) && one.misfit() < best.misfit() + settled;
  });
  return Best{.best = best,
              .or_axis_icrf =
                  other == all.end() ? std::nullopt : std::optional{other->fit.state.axis_icrf()}};
}

}  // namespace spindrift
