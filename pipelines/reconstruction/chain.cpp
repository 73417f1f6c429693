#include "pipelines/reconstruction/chain.h"

#include <Eigen/LU>
#include <algorithm>
#include <iterator>
#include <utility>

#include "pipelines/frames/rotation_vector.h"

namespace spindrift {
namespace {

/// Least noise of a turn per axis. Two samples a nanosecond apart would otherwise get a weight at
/// which double precision loses the rest of the information.
constexpr double kLeastNoise_rad = 1e-8;
/// Sigma of a misalignment about an axis about which the prior has none.
constexpr double kLeastMisalignment_rad = 1e-9;

}  // namespace

bool ChainNoise::estimates_misalignment() const {
  return !alignment.block<3, 3>(SunSensorError, SunSensorError).isZero(0.0);
}

Eigen::Matrix3d ChainNoise::on_misalignment() const {
  Eigen::Matrix3d known_rad2 = alignment.block<3, 3>(SunSensorError, SunSensorError);
  known_rad2.diagonal().array() += kLeastMisalignment_rad * kLeastMisalignment_rad;
  return known_rad2.inverse();
}

std::size_t node_at(const Chain& chain, double t_s) {
  const auto found = std::lower_bound(chain.times_s.begin(), chain.times_s.end(), t_s);
  return static_cast<std::size_t>(std::distance(chain.times_s.begin(), found));
}

Chain chain_of(const RateTrack& rates, std::vector<double> times_s,
               std::span<const SunObservation> sun, std::span<const StarObservation> stars,
               const Eigen::Vector3d& bias_rad_s, const ChainNoise& noise) {
  for (const SunObservation& one : sun) {
    times_s.push_back(one.t_s);
  }
  for (const StarObservation& one : stars) {
    times_s.push_back(one.t_s);
  }
  std::sort(times_s.begin(), times_s.end());
  times_s.erase(std::unique(times_s.begin(), times_s.end()), times_s.end());
  Chain chain{.times_s = std::move(times_s),
              .turns = {},
              .bias_rad_s = bias_rad_s,
              .sun = {},
              .stars = {},
              .noise = noise};
  chain.turns = rates.turns(chain.times_s, bias_rad_s);
  for (Turn& turn : chain.turns) {
    turn.covariance_rad2.diagonal().array() += kLeastNoise_rad * kLeastNoise_rad;
  }
  for (const SunObservation& one : sun) {
    chain.sun.push_back({.node = node_at(chain, one.t_s),
                         .of = one,
                         .rate_body_rad_s = rates.rate_at(one.t_s) - bias_rad_s});
  }
  for (const StarObservation& one : stars) {
    chain.stars.push_back({.node = node_at(chain, one.t_s),
                           .of = one,
                           .rate_body_rad_s = rates.rate_at(one.t_s) - bias_rad_s});
  }
  return chain;
}

ChainState started_at(const Chain& chain, const ChainStar& star) {
  ChainState state{.q_icrf_body = std::vector<Eigen::Quaterniond>(chain.times_s.size()),
                   .bias_rad_s = chain.bias_rad_s};
  std::vector<Eigen::Quaterniond>& q = state.q_icrf_body;
  q[star.node] = star.of.q_icrf_body;
  for (std::size_t i = star.node; i > 0; --i) {
    q[i - 1] = (q[i] * chain.turns[i - 1].turn.conjugate()).normalized();
  }
  for (std::size_t i = star.node; i < chain.turns.size(); ++i) {
    q[i + 1] = (q[i] * chain.turns[i].turn).normalized();
  }
  return state;
}

Eigen::Vector3d predicted_sun(const ChainState& state, const ChainSun& sun) {
  return quaternion_by(state.misalignment_rad) *
         (state.q_icrf_body[sun.node].conjugate() * sun.of.sun_icrf);
}

ChainResidual residual_of(const ChainSun& sun, const ChainState& state) {
  const Eigen::Matrix3d aligned = quaternion_by(state.misalignment_rad).toRotationMatrix();
  const Eigen::Vector3d predicted = predicted_sun(state, sun);
  const Eigen::Vector3d sun_body = aligned.transpose() * predicted;
  ChainResidual residual{.off = predicted - sun.of.measured_body,
                         .by_node = aligned * cross_matrix(sun_body),
                         .by_shared = PerShared::Zero()};
  residual.by_shared.middleCols<3>(SharedSunSensor) =
      -cross_matrix(predicted) * right_jacobian(state.misalignment_rad).transpose();
  residual.by_shared.col(SharedSunTime) = aligned * sun.rate_body_rad_s.cross(sun_body);
  return residual;
}

ChainResidual residual_of(const ChainStar& star, const ChainState& state) {
  ChainResidual residual{
      .off = rotation_vector_of(star.of.q_icrf_body.conjugate() * state.q_icrf_body[star.node]),
      .by_node = Eigen::Matrix3d::Identity(),
      .by_shared = PerShared::Zero()};
  residual.by_shared.middleCols<3>(SharedStarTracker) = -Eigen::Matrix3d::Identity();
  residual.by_shared.col(SharedStarTime) = -star.rate_body_rad_s;
  return residual;
}

Eigen::Vector3d gyro_residual(const Chain& chain, std::size_t i, const ChainState& state) {
  const Turn& turn = chain.turns[i];
  const Eigen::Quaterniond expected =
      turn.turn * quaternion_by(turn.per_bias_s * (state.bias_rad_s - chain.bias_rad_s));
  return rotation_vector_of(expected.conjugate() *
                            (state.q_icrf_body[i].conjugate() * state.q_icrf_body[i + 1]));
}

}  // namespace spindrift
