#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>
#include <optional>
#include <utility>

#include "pipelines/frames/celestial.h"
#include "pipelines/frames/rotation_vector.h"
#include "pipelines/reconstruction/chain_covariance.h"
#include "pipelines/reconstruction/chain_fit.h"
#include "pipelines/reconstruction/chain_solution.h"
#include "pipelines/reconstruction/history.h"
#include "pipelines/reconstruction/methods.h"
#include "pipelines/reconstruction/observations.h"
#include "pipelines/reconstruction/reconstruction_assessment.h"
#include "pipelines/reconstruction/star_consensus.h"
#include "pipelines/statistics/significance.h"
#include "pipelines/time/time_span.h"

namespace spindrift {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

// A noise estimate requires more residuals than this.
constexpr std::int64_t kFewResiduals = 10;

/// Holds a solution with what the samples say of it.
struct Judged {
  const ChainSolution& fine;
  ChainInformation known;
  SharedErrors errors;
  FittedFile file;
};

Judged judged(const ChainSolution& fine) {
  const SolvedChain& solved = fine.solved;
  ChainInformation known = information_of(solved.chain, solved.state);
  const SharedErrors errors = errors_of(known, solved.chain.noise);
  const FittedFile file = fitted_file(known, solved.chain.noise, solved.state);
  return {.fine = fine, .known = std::move(known), .errors = errors, .file = file};
}

SensorResiduals sun_residuals(const Observations& all, const Judged& judged,
                              std::vector<Observation>& said) {
  const SolvedChain& solved = judged.fine.solved;
  const double variance_rad2 = std::pow(solved.chain.noise.sun_rad, 2);
  SensorResiduals residuals;
  double squares = 0.0;
  for (const ChainSun& sun : solved.chain.sun) {
    const ChainResidual residual = residual_of(sun, solved.state);
    const PerShared& node = judged.known.per_shared[sun.node];
    Observation one = sun_observation(
        all, sun.of, -residual.off,
        variance_rad2 * Matrix3d::Identity() + allowed_by_file(residual, node, judged.errors));
    one.limit = squares_of(0.5);
    if (one.nis > one.limit) {
      one.rejected_by = Rejection::Innovation;
      ++residuals.outliers;
    } else {
      squares += left_of(residual, node, judged.file.change).squaredNorm() / variance_rad2;
      ++residuals.count;
    }
    said.push_back(one);
  }
  if (residuals.count > kFewResiduals) {
    residuals.noise =
        judged.fine.louder_sun * std::sqrt(squares / (2.0 * static_cast<double>(residuals.count)));
  }
  return residuals;
}

/// Counts a fix that agrees with its neighbours as used, however far off the solution is; its
/// observation is the one relative to its neighbours.
SensorResiduals star_residuals(const Judged& judged, std::vector<Observation>& said) {
  const ChainSolution& fine = judged.fine;
  const Chain& chain = fine.solved.chain;
  said.insert(said.end(), fine.stars.said.begin(), fine.stars.said.end());
  SensorResiduals residuals{.count = std::ssize(chain.stars),
                            .outliers = std::ssize(fine.stars.gated())};
  double squares = 0.0;
  for (const ChainStar& star : chain.stars) {
    const Vector3d off_rad = left_of(residual_of(star, fine.solved.state),
                                     judged.known.per_shared[star.node], judged.file.change);
    squares += off_rad.squaredNorm() / std::pow(chain.noise.star_rad, 2);
  }
  if (fine.louder_star > 1.0) {
    residuals.noise = fine.louder_star;
  } else if (residuals.count > kFewResiduals) {
    residuals.noise = std::sqrt(squares / (3.0 * static_cast<double>(residuals.count - 1)));
  }
  return residuals;
}

std::vector<OpenBiasDirection> open_directions(const Observations& all, const ChainSolution& fine,
                                               const Matrix3d& covariance_rad2_s2) {
  const Eigen::SelfAdjointEigenSolver<Matrix3d> axes{covariance_rad2_s2};
  std::vector<OpenBiasDirection> open;
  for (Eigen::Index i = 3; i-- > 0;) {
    const double sigma_rad_s = std::sqrt(axes.eigenvalues()[i]);
    const double share = sigma_rad_s / fine.solved.chain.noise.bias_rad_s;
    if (share > kObservableShare) {
      const Vector3d axis = axes.eigenvectors().col(i);
      std::optional<double> off_sun_rad;
      if (!all.sun.empty()) {
        const double angle_rad = angle_between_rad(axis, all.sun.back().measured_body);
        off_sun_rad = std::min(angle_rad, std::numbers::pi - angle_rad);
      }
      open.push_back({.axis_body = axis,
                      .sigma_rad_s = sigma_rad_s,
                      .share = share,
                      .off_sun_rad = off_sun_rad});
    }
  }
  return open;
}

/// @param gyro_noise_rad_s Noise that the turns of the chain were built with.
NodeEstimates nodes_of(const SolvedChain& solved, ChainInformation known,
                       const SharedErrors& errors, double gyro_noise_rad_s) {
  return {.times_s = solved.chain.times_s,
          .q_icrf_body = solved.state.q_icrf_body,
          .own_rad2 = std::move(known.own_rad2),
          .per_shared = std::move(known.per_shared),
          .bias_rad_s = solved.state.bias_rad_s,
          .shared = errors,
          .gyro_noise_rad_s = gyro_noise_rad_s};
}

/// Returns the nodes of the events with the stated noise, whatever noise the samples show, and with
/// the least errors that any estimate leaves.
NodeEstimates bounds_of(const ReconstructionRequest& request, const Observations& all,
                        const Judged& judged) {
  const ChainSolution& fine = judged.fine;
  const ChainState& state = fine.solved.state;
  const double stated_rad_s = request.sensors.gyro->noise_rad_s;
  std::optional<ChainInformation> quieter;
  ChainNoise noise = fine.solved.chain.noise;
  if (fine.louder_sun > 1.0 || fine.louder_star > 1.0 || all.gyro_noise_rad_s > stated_rad_s) {
    Chain stated = fine.solved.chain;
    stated.noise.sun_rad /= fine.louder_sun;
    stated.noise.star_rad /= fine.louder_star;
    for (Turn& turn : stated.turns) {
      turn.covariance_rad2 *= std::pow(stated_rad_s / all.gyro_noise_rad_s, 2);
    }
    quieter = information_of(stated, state);
    noise = stated.noise;
  }
  const ChainInformation& known = quieter ? *quieter : judged.known;
  NodeEstimates bounds{
      .times_s = {},
      .q_icrf_body = {},
      .own_rad2 = {},
      .per_shared = {},
      .bias_rad_s = state.bias_rad_s,
      .shared = {.total = least_errors_of(known, noise), .noise = judged.errors.noise},
      .gyro_noise_rad_s = stated_rad_s};
  for (auto event = all.events.begin() + 1; event != all.events.end(); ++event) {
    const std::size_t node = node_at(fine.solved.chain, all.seconds_of(event->t));
    bounds.times_s.push_back(fine.solved.chain.times_s[node]);
    bounds.q_icrf_body.push_back(state.q_icrf_body[node]);
    bounds.own_rad2.push_back(known.own_rad2[node]);
    bounds.per_shared.push_back(known.per_shared[node]);
  }
  return bounds;
}

std::vector<ReconstructedEvent> bounded_events(const ReconstructionRequest& request,
                                               const Observations& all, const History& history,
                                               const NodeEstimates& bounds) {
  std::vector<ReconstructedEvent> events = events_of(all, history);
  const History bound = history_of(request, all, bounds);
  for (std::size_t i = 0; i < events.size(); ++i) {
    events[i].bound_rad = bound.attitudes[bound.events[i]].sigma_rad();
  }
  return events;
}

}  // namespace

Expected<Reconstruction> reconstruct_batch(const ReconstructionRequest& request,
                                           const Observations& all) {
  const auto fine = solution_of(request, all);
  if (!fine) {
    return Unexpected{fine.error()};
  }
  const SolvedChain& solved = fine->solved;
  Judged at = judged(*fine);
  const Matrix3d bias_covariance_rad2_s2 =
      at.errors.total.block<3, 3>(SharedGyroBias, SharedGyroBias);
  std::vector<Observation> said;
  const SensorResiduals sun = sun_residuals(all, at, said);
  const SensorResiduals star = star_residuals(at, said);
  add_gyro_left_out(all, said);
  const NodeEstimates bounds = bounds_of(request, all, at);
  NormalEquations equations = normal_equations(at.known, solved.chain.noise, solved.state,
                                               later_by_s(all.origin, all.end_s));
  History history = history_of(
      request, all, nodes_of(solved, std::move(at.known), at.errors, all.gyro_noise_rad_s));
  Reconstruction result{.method = ReconstructionMethod::Batch,
                        .events = bounded_events(request, all, history, bounds),
                        .history = std::move(history.attitudes),
                        .bias = GyroBias{solved.state.bias_rad_s, bias_covariance_rad2_s2},
                        .misalignment = std::nullopt,
                        .open_bias = open_directions(all, *fine, bias_covariance_rad2_s2),
                        .gyro = gyro_residuals(all),
                        .sun = sun,
                        .star = star,
                        .said = std::move(said),
                        .equations = std::move(equations),
                        .assessment = {},
                        .iterations = solved.iterations};
  if (solved.chain.noise.estimates_misalignment() && !all.sun.empty()) {
    result.misalignment =
        SunMisalignment{solved.state.misalignment_rad,
                        at.errors.total.block<3, 3>(SharedSunSensor, SharedSunSensor)};
  }
  result.assessment = assess(request, all, result, fine->stars, at.file);
  return result;
}

}  // namespace spindrift
