#include "pipelines/spin/batch/batch_estimator.h"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>

#include "pipelines/ephemeris/orbit_steps.h"
#include "pipelines/frames/angle.h"
#include "pipelines/frames/celestial.h"
#include "pipelines/frames/uncertain_attitude.h"
#include "pipelines/spin/batch/after_changepoint.h"
#include "pipelines/spin/batch/batch_assessment.h"
#include "pipelines/spin/batch/bias_priors.h"
#include "pipelines/spin/batch/bias_selection.h"
#include "pipelines/spin/batch/initial_state.h"
#include "pipelines/spin/batch/observability.h"
#include "pipelines/spin/batch/pass_evidence.h"
#include "pipelines/spin/batch/pass_nutation.h"
#include "pipelines/spin/telemetry_order/time_grid.h"
#include "pipelines/statistics/median.h"
#include "pipelines/statistics/significance.h"
#include "pipelines/time/time_span.h"
#include "pipelines/time/utc.h"

namespace spindrift {
namespace {

// Errors of a parabola through three times, at the ends and in the middle of a pass, per error of
// one time: of its slope at the end over the length and of its curvature over the length squared. A
// time grid that shifts slowly against the revolutions hides as much.
constexpr double kLastRateOfThree = 5.1;
constexpr double kDriftOfThree = 9.8;

/// @param bound_rad2 Covariance of the axis.
std::optional<Error> axis_left_open(const Eigen::Matrix2d& bound_rad2) {
  if (bound_rad2.trace() < kOpen_rad * kOpen_rad) {
    return std::nullopt;
  }
  return Error{ErrorCode::Unobservable,
               fmt::format("these edges leave the axis open by {:.0f} deg: a cone about Sun or "
                           "Earth, or less",
                           std::min(std::sqrt(bound_rad2.trace()) / kRadPerDeg, 180.0))};
}

/// Tests the covariance at the starting axis: if the solution slid towards the Sun or the Earth,
/// the edges of one sensor seem to determine the axis there.
std::optional<Error> axis_open_at_start(const Solved& solved, const Eigen::Vector3d& start_icrf) {
  const auto start = initial_state(solved.model, solved.edges, start_icrf);
  if (!start) {
    return std::nullopt;
  }
  const PassInformation there =
      information_of(solved.model, solved.edges, *start, std::numeric_limits<double>::infinity());
  return axis_left_open(Observability{there, solved.of.best.estimated}.axis_covariance_rad2());
}

Error why_diverged(const Solved& solved) {
  const PassInformation& found = solved.of.best.information;
  return {ErrorCode::Unobservable,
          fmt::format("the solution diverged: {} of {} edges are not where it has them",
                      found.outliers, found.outliers + found.edges)};
}

/// Returns all biases but coning. Those not estimated get one step from the state, taken together.
std::vector<BiasEstimate> all_biases(const PassModel& model, const EvaluatedFit& found) {
  const PulseNoise& noise = model.config().noise;
  const BiasPriors priors{model, found.fit.state};
  const SensorBiases stated = priors.stated();
  const SensorBiases& now = found.fit.state.biases;
  const BiasSet all = seen_biases(found.information) | found.estimated;
  PassInformation beside_all = found.beside(considered_prior(noise, priors.alignment_beside(all)));
  for (int i = 0; i < kSensorBiases; ++i) {
    if (!found.estimated[static_cast<std::size_t>(i)]) {
      beside_all.bias_sigmas[i] = stated[i];
    }
  }
  const Observability together{beside_all, all};
  const SensorBiases step = together.bias_step(beside_all, now);
  std::vector<BiasEstimate> biases = together.biases(now + step);
  // Their sigmas have the offsets by elimination, and the alignment by the gains of the solution.
  const PassInformation beside_offsets = found.beside(considered_prior(noise));
  const Observability alone{beside_offsets, found.estimated};
  const Observability::Matrix by_alignment =
      Observability{found.information, found.estimated}.considered(
          found.information, considered_prior(priors.alignment_beside(found.estimated)));
  for (BiasEstimate& bias : biases) {
    bias.estimated = false;
  }
  for (const BiasEstimate& estimated : alone.biases(now, by_alignment)) {
    *std::find_if(biases.begin(), biases.end(), [&](const BiasEstimate& bias) {
      return bias.bias == estimated.bias;
    }) = estimated;
  }
  for (BiasEstimate& bias : biases) {
    bias.stated_sigma = stated[bias.bias];
  }
  std::erase_if(biases, [](const BiasEstimate& bias) {
    return bias.bias == ConingX || bias.bias == ConingY;
  });
  return biases;
}

ConingEstimate coning_of(const EvaluatedFit& found, double excess_noise) {
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
      .verdict = test_coning(coning_rad, covariance_rad2),
      .tilt_sigma_rad = std::sqrt(along.dot(covariance_rad2 * along)),
      .azimuth_sigma_rad = std::sqrt(across.dot(covariance_rad2 * across)) / coning_rad.norm()};
  coning.verdict.detected = coning.verdict.detected && estimated;
  return coning;
}

/// Returns what each edge says to the solution. The sigma of a residual holds the part of the
/// mission file's errors that the solution has not taken up.
std::vector<BatchEdge> said_to(const Solved& solved, const Observability& observed) {
  const EvaluatedFit& best = solved.of.best;
  const PassAtState at = solved.model.at(best.fit.state);
  const SpinAlignment beside =
      BiasPriors{solved.model, best.fit.state}.alignment_beside(best.estimated);
  const Eigen::Matrix<double, kBatchUnknowns, kSpinAlignmentErrors> taken_up =
      observed.moved(best.information).rightCols<kSpinAlignmentErrors>();
  std::vector<BatchEdge> said;
  said.reserve(solved.edges.size());
  for (const PassEdge& edge : solved.edges) {
    const SpinConfig& config = solved.model.config();
    const double noise_s = edge_sigma_s(config.noise, edge.pulse.channel);
    BatchEdge& one = said.emplace_back(
        BatchEdge{.pulse = edge.pulse, .residual_s = {}, .sigma_s = noise_s, .used = false});
    if (auto residual = at.residual(edge.pulse)) {
      one.residual_s = residual->off * noise_s;
      one.used = std::abs(residual->off) < kOutlierSigmas * residual->sigma(config.alignment);
      residual->per_alignment -= residual->slopes * taken_up;
      one.sigma_s = noise_s * residual->sigma(beside);
    }
  }
  return said;
}

/// Returns the error of the mission file that explains most of what those stated leave over; empty
/// where it is exact.
std::optional<AlignmentExcess> excess_of(const PassModel& model, const EvaluatedFit& found) {
  const SpinAlignment& alignment = model.config().alignment;
  return is_stated(alignment) ? worst_excess(alignment_evidence(model, found), alignment)
                              : std::nullopt;
}

/// Returns the fit with edges that are so far off that a wrong model explains them, but no stray.
EvaluatedFit with_far_edges(const Solved& solved, const EvaluatedFit& fit) {
  // Limit of an edge in its sigmas.
  constexpr double kFar = 4.0 * kOutlierSigmas;
  EvaluatedFit far = fit;
  far.information = information_of(solved.model, solved.edges, far.fit.state, kFar);
  return far;
}

/// Returns the size of an error as an angle at the limb.
double as_angle_rad(const PassModel& model, const AlignmentExcess& excess) {
  const OrbitState& at = model.sky_at(model.middle()).spacecraft;
  const double range_km = at.position_icrf_km.norm();
  switch (excess.error) {
    case Co2AltitudeError: {
      const double radius_km = horizon_axes(model.config().horizon).equatorial_km;
      return excess.value / std::sqrt(range_km * range_km - radius_km * radius_km);
    }
    case TimeTagError:
      return excess.value * at.velocity_icrf_km_s.norm() / range_km;
    default:
      return excess.value;
  }
}

/// Returns the reason where the mission file is off by more than it states, or a bias explains what
/// it does not.
/// @param unbiased Fit before biases were added.
std::optional<Reason> model_off(const Solved& solved, const EvaluatedFit& unbiased) {
  const SpinConfig& config = solved.model.config();
  const bool added = !config.batch.biases && solved.of.best.estimated.any();
  const auto beyond = excess_of(solved.model, unbiased);
  if (!beyond || !(added || beyond->gain > significance_gain())) {
    return std::nullopt;
  }
  const auto culprit = excess_of(solved.model, with_far_edges(solved, unbiased));
  if (!culprit) {
    return std::nullopt;
  }
  return Reason{ReasonCode::ModelOff,
                {{"deg", degrees(std::abs(as_angle_rad(solved.model, *culprit)))},
                 {"key", std::string{kSpinAlignmentKeys.at(culprit->error)}}}};
}

/// Returns the solution without assessment, choice and undetermined directions.
/// @param open_rad2 Axis covariance from the choice among biases, as tilts.
/// @param louder Ratio of the model's noise to the stated noise.
BatchSolution solution_of(const Solved& solved, const Eigen::Matrix2d& open_rad2, double louder) {
  const EvaluatedFit& best = solved.of.best;
  const PassInformation& information = best.information;
  const Observability observed{information, best.estimated};
  const Eigen::Matrix2d bound_rad2 = observed.axis_covariance_rad2();
  const double excess_noise = best.excess_noise();
  const Eigen::Matrix2d turned = tangent_from_tilts(best.fit.state.q_icrf_spin);
  const SpinConfig& config = solved.model.config();
  const Observability::Matrix by_offsets =
      observed.considered(information, considered_prior(config.noise));
  const Observability::Matrix beside_biases = observed.considered(
      information,
      considered_prior(BiasPriors{solved.model, best.fit.state}.alignment_beside(best.estimated)));
  // The priors of estimated biases are in the covariance already, but no noise.
  const Observability::Matrix by_alignment =
      observed.considered(information, considered_prior(config.alignment));
  const Observability::Matrix total = observed.covariance() * excess_noise + beside_biases;
  const Eigen::Matrix2d alignment_rad2 =
      turned * by_alignment.topLeftCorner<2, 2>() * turned.transpose();
  const double half_s = solved.model.half_s();
  const double of_grid_rad = best.fit.state.rate_rad_s * grid_sigma_s(config.noise);
  BatchSolution solution{
      .estimate = {.t = solved.edges.back().pulse.t,
                   .estimator = SpinEstimator::Batch,
                   .axis_icrf = best.fit.state.axis_icrf(),
                   .covariance_rad2 =
                       turned *
                       (bound_rad2 * (excess_noise / kEfficiency) + open_rad2 +
                        by_offsets.topLeftCorner<2, 2>() + beside_biases.topLeftCorner<2, 2>()) *
                       turned.transpose(),
                   .spin_rate_rad_s =
                       best.fit.state.rate_rad_s + best.fit.state.drift_rad_s2 * half_s,
                   .spin_rate_sigma_rad_s =
                       std::hypot(std::sqrt(last_rate_variance(total, half_s)),
                                  kLastRateOfThree * of_grid_rad / (2.0 * half_s)),
                   .assessment = {},
                   .alignment_rad2 = alignment_rad2},
      .drift_rad_s2 = best.fit.state.drift_rad_s2,
      .drift_sigma_rad_s2 = std::hypot(std::sqrt(drift_variance(total, half_s)),
                                       kDriftOfThree * of_grid_rad / (4.0 * half_s * half_s)),
      .bound_rad = std::sqrt(bound_rad2.trace()),
      .biases = all_biases(solved.model, best),
      .undetermined = {},
      .singular_values = observed.singular_values(),
      .changed = solved.left_out ? std::optional{solved.left_out->until} : std::nullopt,
      .edges = information.edges,
      .outliers = information.outliers,
      .noise = louder * std::sqrt(excess_noise),
      .iterations = best.fit.iterations,
      .nutation = best.nutation,
      .nutation_t = solved.edges.back().pulse.t,
      .coning = coning_of(best, excess_noise),
      .said = said_to(solved, observed),
      .choice = {},
      .equations = normal_equations(solved.model, best)};
  solution.equations.t = solution.estimate.t;
  if (best.nutation && best.nutation->found) {
    solution.nutation->found = as_fitted(*best.nutation->found, solved.model, best.fit.state);
    solution.nutation_t = later_by_s(solved.model.middle(), best.nutation->found->t_s);
  }
  return solution;
}

std::optional<OtherAxis> other_axis(const Solved& solved,
                                    const std::optional<AxisChoice>& of_pass) {
  if (solved.of.other || !of_pass || !of_pass->other_icrf) {
    return solved.of.other;
  }
  return compared_with(solved.of.best, solved.model, solved.edges, *of_pass->other_icrf);
}

/// Returns whether the solution's axis is the one that the pass had settled on.
bool follows(const Eigen::Vector3d& axis_icrf, const std::optional<OtherAxis>& other,
             const AxisChoice& of_pass) {
  return of_pass.settled_by != SettledBy::Nothing &&
         (!other || angle_between_rad(of_pass.axis_icrf, axis_icrf) <
                        angle_between_rad(of_pass.axis_icrf, other->axis_icrf));
}

AxisShift axis_shift(const Solved& solved) {
  const EvaluatedFit& best = solved.of.best;
  const auto moved = Observability{best.information, best.estimated}.moved(best.information);
  return tangent_basis(best.fit.state.axis_icrf()) *
         tangent_from_tilts(best.fit.state.q_icrf_spin) *
         moved.topRightCorner<2, kSpinAlignmentErrors>() * root_of(solved.model.config().alignment);
}

/// Records which of the competing axes the solution has taken and what settled the choice.
/// @param of_pass Earlier choice of the same pass, if any.
AxisChoice axis_choice(const Solved& solved, const std::optional<AxisChoice>& of_pass) {
  const auto other = other_axis(solved, of_pass);
  AxisChoice choice{.t = solved.edges.back().pulse.t,
                    .estimator = SpinEstimator::Batch,
                    .axis_icrf = solved.of.best.fit.state.axis_icrf(),
                    .other_icrf = {},
                    .delta_chi_square = {},
                    .settled_by = SettledBy::Edges};
  if (other) {
    choice.other_icrf = other->axis_icrf;
    choice.delta_chi_square = other->more_misfit;
  }
  if (solved.of.alternate_axis_icrf) {
    choice.settled_by = SettledBy::Nothing;
  } else if (solved.of.by_prior) {
    choice.settled_by = SettledBy::Prior;
  } else if (of_pass && follows(choice.axis_icrf, other, *of_pass)) {
    choice.settled_by = of_pass->settled_by;
  }
  choice.shifts = {{.estimator = SpinEstimator::Batch, .shift_icrf = axis_shift(solved)}};
  return choice;
}

/// Returns the observed noise of the edges about a state, separately for sun slits and infrared
/// beams, from the median deviation of each channel's edges from their median, so that neither
/// outliers nor a bias affect it. It is never below the stated noise.
PulseNoise noise_seen(const PassModel& model, std::span<const PassEdge> edges,
                      const SpinState& state) {
  std::array<std::vector<double>, kPulseChannels> off;  // Residuals in sigmas.
  const PassAtState at = model.at(state);
  for (const PassEdge& edge : edges) {
    if (const auto met = at.meet(edge.pulse)) {
      off.at(index_of(edge.pulse.channel)).push_back(met->off_rad / met->sigma_rad);
    }
  }
  std::vector<double> of_slits;
  std::vector<double> of_beams;
  for (std::size_t channel = 0; channel < kPulseChannels; ++channel) {
    const double median = upper_median(off.at(channel));
    std::vector<double>& deviations =
        sees_the_sun(static_cast<PulseChannel>(channel)) ? of_slits : of_beams;
    std::transform(off.at(channel).begin(), off.at(channel).end(), std::back_inserter(deviations),
                   [median](double value) { return std::abs(value - median); });
  }
  const auto times_stated = [](std::vector<double>& deviations) {
    return std::max(1.0, upper_median(deviations) / kMedianDeviation);
  };
  const PulseNoise& stated = model.config().noise;
  return {.sun_s = stated.sun_s * times_stated(of_slits),
          .infrared_s = stated.infrared_s * times_stated(of_beams),
          .grid_s = stated.grid_s};
}

struct Heard {
  BatchSolution solution;
  PulseNoise noise;
};

Expected<Heard> solve_with_noise(const SpinConfig& config, const Orbit& orbit,
                                 std::span<const PassEdge> edges, const StartingAxes& starts,
                                 double louder) {
  if (starts.axes_icrf.empty()) {
    return unobservable(
        "no fix has given an axis to begin at, and the mission file has no [spin.prior]");
  }
  auto solved = solve_after_changepoint(config, orbit, edges, starts,
                                        config.batch.biases.value_or(BiasSet{}));
  if (!solved) {
    return Unexpected{solved.error()};
  }
  const EvaluatedFit unbiased = solved->of.best;
  Eigen::Matrix2d open_rad2 = Eigen::Matrix2d::Zero();
  if (!config.batch.biases) {
    auto added = select_biases(solved->model, solved->edges, solved->of.best);
    if (!added) {
      return Unexpected{added.error()};
    }
    solved->of.best = std::move(added->best);
    open_rad2 = added->open_rad2;
  }
  const EvaluatedFit& best = solved->of.best;
  const PassInformation& information = best.information;
  if (auto open = axis_open_at_start(*solved, starts.axes_icrf.front())) {
    return Unexpected{*std::move(open)};
  }
  if (information.outlier_share() > kMostOutliers) {
    return Unexpected{why_diverged(*solved)};
  }
  if (const auto open =
          axis_left_open(Observability{information, best.estimated}.axis_covariance_rad2())) {
    return Unexpected{*open};
  }
  BatchSolution solution = solution_of(*solved, open_rad2, louder);
  // The covariance is not finite when the biases cannot be told apart at all.
  if (!(solution.estimate.covariance_rad2.trace() <= kOpen_rad * kOpen_rad)) {
    return unobservable("the biases that the edges ask for leave the axis open");
  }
  if (solved->left_out && !solved->left_out->fit_one_attitude &&
      rests_on_few(solution, *solved->left_out)) {
    return unobservable(
        fmt::format("no one attitude fits the {} edges before {}, and {} of the {} behind it fit "
                    "this one badly",
                    solved->left_out->edges, format_utc(solved->left_out->until, 0),
                    solution.outliers, solution.edges + solution.outliers));
  }
  solution.choice = axis_choice(*solved, starts.of_pass);
  solution.estimate.shift_icrf = solution.choice.shifts.front().shift_icrf;
  const BiasSet suspected = config.batch.biases.value_or(seen_biases(information));
  solution.undetermined = Observability{information, suspected}.undetermined();
  const auto wanted = most_significant_bias(best.beside_considered(), best.estimated);
  solution.estimate.assessment = assess(
      solution,
      {.alternate_axis_icrf = solved->of.alternate_axis_icrf,
       .revolutions = solved->model.half_s() * solution.estimate.spin_rate_rad_s / std::numbers::pi,
       .left_out = solved->left_out,
       .estimated = best.estimated,
       .at_bound = best.fit.at_bound,
       .coning_by_edges = !config.batch.biases.has_value(),
       .wanted = wanted ? std::optional{wanted->bias} : std::nullopt,
       .model_off = model_off(*solved, unbiased)});
  if (const auto step = step_within(orbit_steps(orbit), solved->edges.front().pulse.t,
                                    solved->edges.back().pulse.t)) {
    doubt(solution.estimate.assessment, reason_of(*step));
  }
  return Heard{.solution = std::move(solution),
               .noise = noise_seen(solved->model, solved->edges, best.fit.state)};
}

double grid_of(const PulseNoise& noise, std::span<const PassEdge> edges) {
  TimeGrid grid{noise};
  for (const PassEdge& edge : edges) {
    grid.learn(edge.pulse);
  }
  return grid.width_s();
}

}  // namespace

Expected<BatchSolution> solve_batch(const SpinConfig& stated, const Orbit& orbit,
                                    std::span<const PassEdge> edges, const StartingAxes& starts) {
  SpinConfig config = stated;
  config.noise.grid_s = grid_of(stated.noise, edges);
  auto as_stated = solve_with_noise(config, orbit, edges, starts, 1.0);
  if (!as_stated) {
    return Unexpected{std::move(as_stated).error()};
  }
  const double louder = std::max(as_stated->noise.sun_s / config.noise.sun_s,
                                 as_stated->noise.infrared_s / config.noise.infrared_s);
  // Too many edges counted as outliers, and slits and beams had wrong weights against each other.
  if (as_stated->solution.noise > 1.0 && louder > kLouder) {
    SpinConfig heard = config;
    heard.noise = as_stated->noise;
    if (auto again = solve_with_noise(heard, orbit, edges, starts, louder)) {
      again->solution.bound_rad = as_stated->solution.bound_rad;
      return std::move(again)->solution;
    }
  }
  return std::move(as_stated)->solution;
}

}  // namespace spindrift
