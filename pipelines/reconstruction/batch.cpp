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

namespace spindrift {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

// A noise estimate requires more residuals than this.
constexpr std::int64_t kFewResiduals = 10;

SensorResiduals sun_residuals(const Observations& all, const ChainSolution& fine,
                              std::vector<Observation>& said) {
  const Chain& chain = fine.solved.chain;
  const Matrix3d noise_rad2 = std::pow(chain.noise.sun_rad, 2) * Matrix3d::Identity();
  SensorResiduals residuals;
  double squares = 0.0;
  for (const ChainSun& sun : chain.sun) {
    Observation one = sun_observation(
        all, sun.of, sun.of.measured_body - predicted_sun(fine.solved.state, sun), noise_rad2);
    one.limit = squares_of(0.5);
    if (one.nis > one.limit) {
      one.rejected_by = Rejection::Innovation;
      ++residuals.outliers;
    } else {
      squares += one.nis;
      ++residuals.count;
    }
    said.push_back(one);
  }
  if (residuals.count > kFewResiduals) {
    residuals.noise =
        fine.louder_sun * std::sqrt(squares / (2.0 * static_cast<double>(residuals.count)));
  }
  return residuals;
}

/// Counts a fix that agrees with its neighbours as used, however far off the solution is; its
/// observation is the one relative to its neighbours.
SensorResiduals star_residuals(const ChainSolution& fine, std::vector<Observation>& said) {
  const Chain& chain = fine.solved.chain;
  said.insert(said.end(), fine.stars.said.begin(), fine.stars.said.end());
  SensorResiduals residuals{.count = std::ssize(chain.stars),
                            .outliers = std::ssize(fine.stars.gated())};
  double squares = 0.0;
  for (const ChainStar& star : chain.stars) {
    const Vector3d off_rad = rotation_vector_of(
        fine.solved.state.q_icrf_body[star.node].conjugate() * star.of.q_icrf_body);
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
NodeEstimates nodes_of(const SolvedChain& solved, const ChainCovariance& known,
                       double gyro_noise_rad_s) {
  return {.times_s = solved.chain.times_s,
          .q_icrf_body = solved.state.q_icrf_body,
          .covariances_rad2 = known.nodes_rad2,
          .bias_rad_s = solved.state.bias_rad_s,
          .bias_covariance_rad2_s2 = known.shared.topLeftCorner<3, 3>(),
          .start_bias_covariance = known.node_shared.front().leftCols<3>(),
          .gyro_noise_rad_s = gyro_noise_rad_s};
}

/// Returns the history with the stated noise, whatever noise the samples show.
History bound_of(const ReconstructionRequest& request, const Observations& all,
                 const ChainSolution& fine) {
  SolvedChain stated = fine.solved;
  const double stated_rad_s = request.sensors.gyro->noise_rad_s;
  stated.chain.noise.sun_rad /= fine.louder_sun;
  stated.chain.noise.star_rad /= fine.louder_star;
  for (Turn& turn : stated.chain.turns) {
    turn.covariance_rad2 *= std::pow(stated_rad_s / all.gyro_noise_rad_s, 2);
  }
  return history_of(request, all,
                    nodes_of(stated, covariance_of(stated.chain, stated.state), stated_rad_s));
}

std::vector<ReconstructedEvent> bounded_events(const ReconstructionRequest& request,
                                               const Observations& all, const ChainSolution& fine,
                                               const History& history) {
  std::vector<ReconstructedEvent> events = events_of(all, history);
  const History bound = bound_of(request, all, fine);
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
  const ChainCovariance known = covariance_of(solved.chain, solved.state);
  History history = history_of(request, all, nodes_of(solved, known, all.gyro_noise_rad_s));
  const Matrix3d bias_covariance_rad2_s2 = known.shared.topLeftCorner<3, 3>();
  std::vector<Observation> said;
  const SensorResiduals sun = sun_residuals(all, *fine, said);
  const SensorResiduals star = star_residuals(*fine, said);
  add_gyro_left_out(all, said);
  Reconstruction result{.method = ReconstructionMethod::Batch,
                        .events = bounded_events(request, all, *fine, history),
                        .history = std::move(history.attitudes),
                        .bias = GyroBias{solved.state.bias_rad_s, bias_covariance_rad2_s2},
                        .misalignment = std::nullopt,
                        .open_bias = open_directions(all, *fine, bias_covariance_rad2_s2),
                        .gyro = gyro_residuals(all),
                        .sun = sun,
                        .star = star,
                        .said = std::move(said),
                        .assessment = {},
                        .iterations = solved.iterations};
  if (solved.chain.noise.misalignment_rad) {
    result.misalignment =
        SunMisalignment{solved.state.misalignment_rad, known.shared.bottomRightCorner<3, 3>()};
  }
  result.assessment = assess(request, all, result, fine->stars);
  return result;
}

}  // namespace spindrift
