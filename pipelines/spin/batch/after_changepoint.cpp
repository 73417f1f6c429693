#include "pipelines/spin/batch/after_changepoint.h"

#include <fmt/format.h>

#include <utility>
#include <vector>

#include "pipelines/spin/batch/bias_selection.h"
#include "pipelines/spin/batch/changepoint.h"
#include "pipelines/spin/batch/sky_search.h"
#include "pipelines/statistics/significance.h"
#include "pipelines/time/utc.h"

namespace spindrift {
namespace {

// With fewer revolutions rate and drift cannot be told from noise.
constexpr std::int64_t kFewestTurns = 3;
constexpr int kMostChanges = 4;

/// Rejects a change that the mission file's alignment or a further bias explains, since these make
/// residuals drift as well.
bool is_change(const std::optional<Changepoint>& change, const EvaluatedFit& found) {
  if (!change) {
    return false;
  }
  const double by_alignment = found.information.misfit() - found.misfit();
  const auto bias = most_significant_bias(found.beside_considered(), found.estimated);
  const double by_model = by_alignment + (bias ? bias->gain : 0.0);
  return by_model == 0.0 || change->gain > by_model + kSettled;
}

/// Dates a rate step by pulse times alone: a state lies between the two rates or fits neither.
std::optional<Changepoint> change_in(const PassModel& model, std::span<const PassEdge> edges,
                                     const EvaluatedFit& found) {
  auto change = find_changepoint(model, edges, found.fit.state);
  if (!is_change(change, found)) {
    change.reset();
  }
  if (change || found.information.outlier_share() > kMostOutliers) {
    const auto step = find_rate_changepoint(edges);
    return step ? step : change;
  }
  return change;
}

Expected<void> suffices(std::span<const PassEdge> edges) {
  const auto turns = edges.empty() ? 0 : edges.back().revolution - edges.front().revolution + 1;
  if (turns < kFewestTurns || edges.size() <= static_cast<std::size_t>(kBatchUnknowns)) {
    return unobservable(
        fmt::format("{} edges of {} turn{}: axis, phase, rate and drift need more than {} edges of "
                    "at least {} turns",
                    edges.size(), turns, turns == 1 ? "" : "s", kBatchUnknowns, kFewestTurns));
  }
  return {};
}

struct OneAttitude {
  PassModel model;
  Best of;
  std::optional<Changepoint> change;
};

Expected<OneAttitude> solve_as_one(const SpinConfig& config, const Orbit& orbit,
                                   std::span<const PassEdge> edges,
                                   std::span<const Eigen::Vector3d> starts, BiasSet estimated) {
  if (const auto enough = suffices(edges); !enough) {
    return Unexpected{enough.error()};
  }
  auto model = PassModel::make(config, orbit, edges);
  if (!model) {
    return Unexpected{model.error()};
  }
  auto best = best_of_starts(*model, edges, starts, estimated);
  if (!best) {
    return Unexpected{best.error()};
  }
  const auto change = change_in(*model, edges, best->best);
  return OneAttitude{.model = *std::move(model), .of = *std::move(best), .change = change};
}

bool fits(const Expected<OneAttitude>& one) {
  return one && !one->change && one->of.best.information.outlier_share() < kManyOutliers &&
         one->of.best.excess_noise() <= 1.0;
}

/// Searches the sky before accepting an unsettled axis or a change, since a false axis may fit as
/// well or need a change where the true one does not.
/// @param from Starting axes; the axes found are added.
Expected<OneAttitude> solve_pass(const SpinConfig& config, const Orbit& orbit,
                                 std::span<const PassEdge> edges, StartingAxes& from,
                                 BiasSet estimated) {
  std::vector<Eigen::Vector3d>& axes = from.axes_icrf;
  auto one = solve_as_one(config, orbit, edges, axes, estimated);
  if (!one || (from.settled && !one->change)) {
    return one;
  }
  const auto rivals = competing_axes(one->of.best.fit.state, one->model, edges, estimated);
  if (rivals.empty()) {
    return one;
  }
  axes.insert(axes.end(), rivals.begin(), rivals.end());
  return solve_as_one(config, orbit, edges, axes, estimated);
}

}  // namespace

Expected<Solved> solve_after_changepoint(const SpinConfig& config, const Orbit& orbit,
                                         std::span<const PassEdge> edges,
                                         const StartingAxes& starts, BiasSet estimated) {
  StartingAxes from = starts;
  std::span<const PassEdge> since = edges;
  auto one = solve_pass(config, orbit, edges, from, estimated);
  std::optional<TaiTime> changed;
  for (int changes = 1; one && one->change; ++changes) {
    changed = one->change->t;
    if (changes == kMostChanges) {
      return unobservable(fmt::format(
          "attitude or rate change all the time, last at {}: no one state explains the edges",
          format_utc(*changed, 0)));
    }
    since = since.subspan(one->change->first_edge);
    one = solve_as_one(config, orbit, since, from.axes_icrf, estimated);
  }
  if (!one) {
    return Unexpected{one.error()};
  }
  Solved solved{
      .model = std::move(one->model), .edges = since, .of = std::move(one->of), .left_out = {}};
  if (changed) {
    const auto before = edges.first(edges.size() - since.size());
    const bool fit_one_attitude =
        !suffices(before) || fits(solve_as_one(config, orbit, before, from.axes_icrf, estimated));
    solved.left_out = {
        .until = *changed, .edges = std::ssize(before), .fit_one_attitude = fit_one_attitude};
  }
  return solved;
}

}  // namespace spindrift
