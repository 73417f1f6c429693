#include "pipelines/spin/batch/batch_estimator.h"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "pipelines/frames/celestial.h"
#include "pipelines/spin/batch/attitude_change.h"
#include "pipelines/spin/batch/batch_fit.h"
#include "pipelines/spin/batch/batch_status.h"
#include "pipelines/spin/batch/bias_choice.h"
#include "pipelines/spin/batch/first_clock.h"
#include "pipelines/spin/batch/observability.h"
#include "pipelines/spin/batch/pass_information.h"
#include "pipelines/spin/batch/pass_nutation.h"
#include "pipelines/spin/time_span.h"
#include "pipelines/time/utc.h"

namespace spindrift {
namespace {

constexpr double kDegree_rad = std::numbers::pi / 180.0;
// Fewer turns do not tell rate and drift from noise.
constexpr std::int64_t kFewestTurns = 3;
// More outliers are no dirt of a pass but another motion.
constexpr double kMostOutliers = 0.5;
// An axis known no better is not determined: cones about Sun or Earth, more or less.
constexpr double kLost_rad = 10.0 * kDegree_rad;
// Two ends of two starts are one solution within this.
constexpr double kSameAxis_rad = 0.1 * kDegree_rad;
// exp(10) times as likely settles it, as for the filters of `sequential`.
constexpr double kSettled = 20.0;
constexpr int kMostChanges = 4;
constexpr int kMostBiases = 3;
// What one step says of a gain may be off by so much; each comparison is a fit.
constexpr double kOneStep = 0.7;
constexpr std::size_t kMostRivals = 3;

Unexpected unobservable(std::string message) {
  return Unexpected{{ErrorCode::Unobservable, std::move(message)}};
}

/// A fit, and how well it explains its edges.
struct Explained {
  BatchFit fit;
  BiasSet estimated;
  PassInformation information;
  std::optional<NutationSearch> nutation;

  double excess_noise() const {
    return information.excess_noise(kMotionUnknowns + static_cast<int>(estimated.count()) +
                                    kNutationUnknowns *
                                        static_cast<int>(fit.state.nutation.size()));
  }

  double misfit() const {
    return information.squares +
           static_cast<double>(information.outliers) * kOutlierSigmas * kOutlierSigmas;
  }
};

Expected<Explained> explain(const PassModel& model, std::span<const PassEdge> edges,
                            const SpinState& start, BiasSet estimated) {
  return fit(model, edges, start, estimated).map([&](const BatchFit& found) {
    return Explained{.fit = found,
                     .estimated = estimated,
                     .information = less_nutation(information_of(model, edges, found.state), model,
                                                  edges, found.state),
                     .nutation = {}};
  });
}

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

bool same_axis(const Explained& one, const Explained& other) {
  return angle_between_rad(one.fit.state.axis_icrf(), other.fit.state.axis_icrf()) < kSameAxis_rad;
}

bool likelier(const Explained& one, const Explained& other) {
  return one.misfit() < other.misfit();
}

/// The likeliest, and another that is nearly so.
struct Best {
  Explained best;
  std::optional<Eigen::Vector3d> or_axis_icrf;
};

/// One of each axis that a start leads to, likeliest first.
Expected<std::vector<Explained>> all_of(const PassModel& model, std::span<const PassEdge> edges,
                                        std::span<const Eigen::Vector3d> starts,
                                        BiasSet estimated) {
  std::vector<Explained> all;
  std::optional<Error> reason;
  for (const Eigen::Vector3d& start : starts) {
    const auto found = first_state(model, edges, start).and_then([&](const SpinState& state) {
      return explain(model, edges, state, estimated);
    });
    if (found) {
      all.push_back(*found);
    } else if (!reason) {
      reason = found.error();
    }
  }
  if (all.empty()) {
    return Unexpected{*reason};
  }
  std::stable_sort(all.begin(), all.end(), likelier);
  std::vector<Explained> apart;
  for (const Explained& one : all) {
    const auto same = [&](const Explained& other) { return same_axis(one, other); };
    if (std::none_of(apart.begin(), apart.end(), same)) {
      apart.push_back(one);
    }
  }
  return apart;
}

Expected<Best> best_of(const PassModel& model, std::span<const PassEdge> edges,
                       std::span<const Eigen::Vector3d> starts, BiasSet estimated) {
  auto all = all_of(model, edges, starts, estimated);
  if (!all) {
    return Unexpected{all.error()};
  }
  for (Explained& one : *all) {
    auto nutating = with_nutation(model, edges, one);
    if (!nutating) {
      return Unexpected{nutating.error()};
    }
    one = *std::move(nutating);
  }
  std::stable_sort(all->begin(), all->end(), likelier);
  const Explained& best = all->front();
  const double settled = kSettled * best.excess_noise();
  const auto other = std::find_if(all->begin() + 1, all->end(), [&](const Explained& one) {
    return !same_axis(one, best) && one.misfit() < best.misfit() + settled;
  });
  return Best{.best = best,
              .or_axis_icrf =
                  other == all->end() ? std::nullopt : std::optional{other->fit.state.axis_icrf()}};
}

/// All that is found out of the edges from the last change on.
struct Solved {
  PassModel model;
  std::span<const PassEdge> edges;
  Best of;
  std::optional<TaiTime> changed;
};

/// A wrong bias lets residuals drift as the geometry turns, which is no change of the attitude.
bool is_change(const std::optional<AttitudeChange>& change, const Explained& found) {
  if (!change) {
    return false;
  }
  const auto bias = most_wanted_bias(found.information, found.estimated);
  return !bias || change->gain > bias->gain + kSettled;
}

Expected<void> suffices(std::span<const PassEdge> edges) {
  const auto turns = edges.empty() ? 0 : edges.back().revolution - edges.front().revolution + 1;
  if (turns < kFewestTurns || edges.size() <= static_cast<std::size_t>(kBatchUnknowns)) {
    return unobservable(
        fmt::format("{} edges of {} turns: axis, phase, rate and drift need more than {} edges of "
                    "at least {} turns",
                    edges.size(), turns, kBatchUnknowns, kFewestTurns));
  }
  return {};
}

Expected<Solved> solve_since_change(const SpinConfig& config, const Orbit& orbit,
                                    std::span<const PassEdge> edges,
                                    std::span<const Eigen::Vector3d> starts, BiasSet estimated) {
  std::optional<TaiTime> changed;
  for (int change = 0; change < kMostChanges; ++change) {
    if (const auto enough = suffices(edges); !enough) {
      return Unexpected{enough.error()};
    }
    auto model = PassModel::make(config, orbit, edges);
    if (!model) {
      return Unexpected{model.error()};
    }
    auto best = best_of(*model, edges, starts, estimated);
    if (!best) {
      return Unexpected{best.error()};
    }
    const auto found = find_change(*model, edges, best->best.fit.state);
    if (!is_change(found, best->best)) {
      return Solved{
          .model = *std::move(model), .edges = edges, .of = *std::move(best), .changed = changed};
    }
    changed = found->t;
    edges = edges.subspan(found->first_edge);
  }
  return unobservable(fmt::format(
      "attitude or rate change all the time, last at {}: no one state explains the edges",
      format_utc(*changed, 0)));
}

/// What makes a fit with one more bias the less likely: misfit, priors, and how easily such a bias
/// explains noise.
double cost_of(const Explained& with, SensorBias bias) {
  double cost = with.misfit() + wanted_from(bias);
  for (int i = 0; i < kSensorBiases; ++i) {
    cost += std::pow(with.fit.state.biases[i] / prior_of(static_cast<SensorBias>(i)).sigma, 2);
  }
  return cost;
}

/// Gains come from one step, which is some percent wrong: those near the largest are compared by
/// what their fits leave. So is coning, which has the axis degrees off, where one step is worse.
std::vector<SensorBias> rivals_of(std::span<const BiasGain> wanted, BiasSet estimated) {
  std::vector<SensorBias> rivals;
  for (const auto& [bias, gain] : wanted.first(std::min(wanted.size(), kMostRivals))) {
    if (gain > kOneStep * wanted.front().gain) {
      rivals.push_back(bias);
    }
  }
  if (!estimated[ConingX] && std::find(rivals.begin(), rivals.end(), ConingX) == rivals.end()) {
    rivals.push_back(ConingX);
  }
  return rivals;
}

Expected<std::pair<SensorBias, Explained>> likeliest_of(const Solved& solved,
                                                        std::span<const BiasGain> wanted) {
  const Explained& now = solved.of.best;
  std::optional<std::pair<SensorBias, Explained>> best;
  for (const SensorBias bias : rivals_of(wanted, now.estimated)) {
    auto with =
        explain(solved.model, solved.edges, now.fit.state, now.estimated | unknowns_of(bias));
    if (!with) {
      return Unexpected{with.error()};
    }
    with->nutation = now.nutation;
    if (!best || cost_of(*with, bias) < cost_of(best->second, best->first)) {
      best = {bias, *std::move(with)};
    }
  }
  return *std::move(best);
}

/// @return What the choice among biases leaves open of the axis, tilts, rad^2.
Expected<Eigen::Matrix2d> add_wanted_biases(Solved& solved) {
  Eigen::Matrix2d open_rad2 = Eigen::Matrix2d::Zero();
  for (int i = 0; i < kMostBiases; ++i) {
    const Explained& now = solved.of.best;
    const auto wanted = wanted_biases(now.information, now.estimated);
    if (wanted.empty()) {
      break;
    }
    auto likeliest = likeliest_of(solved, wanted);
    if (!likeliest) {
      return Unexpected{likeliest.error()};
    }
    open_rad2 += other_biases_rad2(now.information, now.estimated, likeliest->first);
    solved.of.best = std::move(likeliest->second);
  }
  return open_rad2;
}

/// @param bound_rad2 Of the axis.
std::optional<Error> axis_left_open(const Eigen::Matrix2d& bound_rad2) {
  if (bound_rad2.trace() < kLost_rad * kLost_rad) {
    return std::nullopt;
  }
  return Error{ErrorCode::Unobservable,
               fmt::format("these edges leave the axis open by {:.0f} deg: a cone about Sun or "
                           "Earth, or less",
                           std::min(std::sqrt(bound_rad2.trace()) / kDegree_rad, 180.0))};
}

/// What the edges leave open wanders off.
Error why_diverged(const Solved& solved, const Eigen::Vector3d& start_icrf) {
  const auto start = first_state(solved.model, solved.edges, start_icrf);
  if (start) {
    const PassInformation there =
        information_of(solved.model, solved.edges, *start, std::numeric_limits<double>::infinity());
    const Observability observed{there, solved.of.best.estimated};
    if (auto open = axis_left_open(observed.axis_covariance_rad2())) {
      return *std::move(open);
    }
  }
  const PassInformation& found = solved.of.best.information;
  return {ErrorCode::Unobservable,
          fmt::format("the solution diverged: {} of {} edges are not where it has them",
                      found.outliers, found.outliers + found.edges)};
}

/// Of the biases not estimated, what one step from the state would make of all together.
std::vector<BiasEstimate> all_biases(const Explained& found) {
  const SensorBiases& now = found.fit.state.biases;
  const Observability together{found.information, seen_biases(found.information) | found.estimated};
  const Observability alone{found.information, found.estimated};
  const SensorBiases step = together.bias_step(found.information, now);
  std::vector<BiasEstimate> biases = together.biases(now + step);
  for (const BiasEstimate& estimated : alone.biases(now)) {
    *std::find_if(biases.begin(), biases.end(), [&](const BiasEstimate& bias) {
      return bias.bias == estimated.bias;
    }) = estimated;
  }
  std::erase_if(biases, [](const BiasEstimate& bias) {
    return bias.bias == ConingX || bias.bias == ConingY;
  });
  return biases;
}

ConingEstimate coning_of(const Explained& found, double excess_noise) {
  const Observability observed{found.information, found.estimated | unknowns_of(ConingX)};
  const bool estimated = found.estimated[ConingX];
  SensorBiases biases = found.fit.state.biases;
  if (!estimated) {
    biases += observed.bias_step(found.information, biases);
  }
  const Eigen::Vector2d coning_rad = biases.segment<2>(ConingX);
  const Eigen::Matrix2d covariance_rad2 = observed.coning_covariance_rad2() * excess_noise;
  const Eigen::Vector2d along = coning_rad.stableNormalized();
  const Eigen::Vector2d across{-along.y(), along.x()};
  ConingEstimate coning{
      .verdict = judge_coning(coning_rad, covariance_rad2),
      .tilt_sigma_rad = std::sqrt(along.dot(covariance_rad2 * along)),
      .azimuth_sigma_rad = std::sqrt(across.dot(covariance_rad2 * across)) / coning_rad.norm()};
  coning.verdict.detected = coning.verdict.detected && estimated;
  return coning;
}

}  // namespace

Expected<BatchSolution> solve_batch(const SpinConfig& config, const Orbit& orbit,
                                    std::span<const PassEdge> edges,
                                    std::span<const Eigen::Vector3d> starts) {
  if (starts.empty()) {
    return unobservable("no fix has given an axis to begin at");
  }
  auto solved =
      solve_since_change(config, orbit, edges, starts, config.batch.biases.value_or(BiasSet{}));
  if (!solved) {
    return Unexpected{solved.error()};
  }
  Eigen::Matrix2d open_rad2 = Eigen::Matrix2d::Zero();
  if (!config.batch.biases) {
    const auto added = add_wanted_biases(*solved);
    if (!added) {
      return Unexpected{added.error()};
    }
    open_rad2 = *added;
  }
  const Explained& best = solved->of.best;
  const PassInformation& information = best.information;
  if (information.outlier_share() > kMostOutliers) {
    return Unexpected{why_diverged(*solved, starts.front())};
  }
  const Observability observed{information, best.estimated};
  const Eigen::Matrix2d bound_rad2 = observed.axis_covariance_rad2();
  if (const auto open = axis_left_open(bound_rad2)) {
    return Unexpected{*open};
  }
  const double excess_noise = best.excess_noise();
  const Eigen::Matrix2d turned = tangent_from_tilts(best.fit.state.q_icrf_spin);
  const double half_s = solved->model.half_s();
  BatchSolution solution{
      .estimate =
          {.t = solved->edges.back().pulse.t,
           .estimator = SpinEstimator::Batch,
           .axis_icrf = best.fit.state.axis_icrf(),
           .covariance_rad2 = turned * (bound_rad2 * (excess_noise / kEfficiency) + open_rad2) *
                              turned.transpose(),
           .spin_rate_rad_s = best.fit.state.rate_rad_s + best.fit.state.drift_rad_s2 * half_s,
           .spin_rate_sigma_rad_s = std::sqrt(observed.last_rate_variance(half_s) * excess_noise),
           .status = {}},
      .bound_rad = std::sqrt(bound_rad2.trace()),
      .biases = all_biases(best),
      .undetermined = {},
      .singular_values = observed.singular_values(),
      .changed = solved->changed,
      .edges = information.edges,
      .outliers = information.outliers,
      .noise = std::sqrt(excess_noise),
      .iterations = best.fit.iterations,
      .nutation = best.nutation,
      .nutation_t = solved->edges.back().pulse.t,
      .coning = coning_of(best, excess_noise)};
  if (best.nutation && best.nutation->found) {
    solution.nutation->found = as_fitted(*best.nutation->found, solved->model, best.fit.state);
    solution.nutation_t = later_by_s(solved->model.middle(), best.nutation->found->t_s);
  }
  const BiasSet suspected = config.batch.biases.value_or(seen_biases(information));
  solution.undetermined = Observability{information, suspected}.undetermined();
  solution.estimate.status = status_of(solution, {.or_axis_icrf = solved->of.or_axis_icrf,
                                                  .estimated = best.estimated,
                                                  .at_bound = best.fit.at_bound});
  return solution;
}

}  // namespace spindrift
