#include "pipelines/reconstruction/chain_covariance.h"

#include <Eigen/Dense>
#include <cmath>

#include "pipelines/frames/rotation_vector.h"
#include "pipelines/reconstruction/chain_fit.h"

namespace spindrift {
namespace {

using Eigen::Matrix3d;
using Eigen::MatrixXd;
using Eigen::Vector3d;

/// The bias and the misalignment of the sun sensor, which the fit estimates.
constexpr Eigen::Index kEstimated = SharedStarTracker;

/// Holds the normal equations of one node and the shared errors.
struct Equations {
  Matrix3d node = Matrix3d::Zero();
  PerShared mixed = PerShared::Zero();
  SharedCovariance shared = SharedCovariance::Zero();
  Vector3d node_score = Vector3d::Zero();
  SharedVector score = SharedVector::Zero();

  void add(const ChainResidual& residual, double weight) {
    const Matrix3d weighted = weight * residual.by_node.transpose();
    const Eigen::Matrix<double, kSharedErrors, 3> weighted_shared =
        weight * residual.by_shared.transpose();
    node += weighted * residual.by_node;
    mixed += weighted * residual.by_shared;
    shared += weighted_shared * residual.by_shared;
    node_score -= weighted * residual.off;
    score -= weighted_shared * residual.off;
  }
};

/// Holds the coefficients of error_node = next error_(node + 1) + shared shared_errors + noise.
struct Smoothing {
  Matrix3d next;
  PerShared shared;
  Matrix3d noise;
};

/// Propagates the equations to the next node. The turn's noise is marginalised without inverting
/// it, so that it may be arbitrarily small.
/// @param off_rad How far the solution's turn is off `turn`, in body axes at the next node.
Smoothing pass_on(const Turn& turn, const Matrix3d& turned, const Vector3d& off_rad,
                  Equations& at) {
  const Matrix3d noise = turned * turn.covariance_rad2 * turned.transpose();
  const Matrix3d left = (Matrix3d::Identity() + at.node * noise).inverse();
  const Matrix3d gain = noise * left;
  const PerShared earlier_per_shared = -turned * turn.per_shared();
  const Matrix3d kept = Matrix3d::Identity() - gain * at.node;
  Smoothing smoothing{.next = kept * turned,
                      .shared = kept * earlier_per_shared - gain * at.mixed,
                      .noise = 0.5 * (gain + gain.transpose())};
  const Matrix3d node = left * at.node;
  const PerShared mixed = left * at.mixed;
  const Vector3d earlier_off_rad = turned * off_rad;
  const Vector3d node_score = left * at.node_score - node * earlier_off_rad;
  at.score -= at.mixed.transpose() * (gain * at.node_score) + mixed.transpose() * earlier_off_rad;
  at.score += earlier_per_shared.transpose() * node_score;
  at.shared -= at.mixed.transpose() * (gain * at.mixed);
  at.shared += earlier_per_shared.transpose() * (node * earlier_per_shared + mixed) +
               mixed.transpose() * earlier_per_shared;
  at.mixed = turned.transpose() * (node * earlier_per_shared + mixed);
  at.node_score = turned.transpose() * node_score;
  const Matrix3d next = turned.transpose() * node * turned;
  at.node = 0.5 * (next + next.transpose());
  return smoothing;
}

/// Returns the covariance of the shared errors after the samples; the prior may be singular.
SharedCovariance left_by(const ChainInformation& known, const SharedCovariance& prior) {
  const SharedCovariance left =
      (SharedCovariance::Identity() + prior * known.shared).partialPivLu().solve(prior);
  return 0.5 * (left + left.transpose());
}

/// Tests the errors that explain the samples best against what their priors let them be.
std::optional<ErrorBeyond> beyond_prior(const SharedVector& best, const SharedCovariance& left,
                                        const AttitudeAlignment& alignment) {
  constexpr int kCount = kSharedErrors - SharedSunSensor;
  FilterErrors estimate = FilterErrors::Zero();
  estimate(kSharedAlignment) = best.tail<kCount>();
  FilterAlignment covariance = alignment.topLeftCorner<kFilterErrors, kFilterErrors>();
  covariance(kSharedAlignment, kSharedAlignment) = left.bottomRightCorner<kCount, kCount>();
  return error_beyond(estimate, alignment.topLeftCorner<kFilterErrors, kFilterErrors>(),
                      covariance);
}

}  // namespace

ChainInformation information_of(const Chain& chain, const ChainState& state) {
  const std::size_t nodes = chain.times_s.size();
  std::vector<Smoothing> smoothings;
  smoothings.reserve(nodes);
  Equations at;
  auto sun = chain.sun.begin();
  auto star = chain.stars.begin();
  for (std::size_t i = 0; i < nodes; ++i) {
    for (; sun != chain.sun.end() && sun->node == i; ++sun) {
      at.add(residual_of(*sun, state),
             weight_of(*sun, chain, state) / (chain.noise.sun_rad * chain.noise.sun_rad));
    }
    for (; star != chain.stars.end() && star->node == i; ++star) {
      at.add(residual_of(*star, state), std::pow(chain.noise.star_rad, -2));
    }
    if (i + 1 < nodes) {
      const Eigen::Quaterniond turned = state.q_icrf_body[i].conjugate() * state.q_icrf_body[i + 1];
      smoothings.push_back(
          pass_on(chain.turns[i], turned.toRotationMatrix(), gyro_residual(chain, i, state), at));
    }
  }
  Matrix3d own = at.node.inverse();
  PerShared per_shared = -own * at.mixed;
  ChainInformation known{.own_rad2 = std::vector<Matrix3d>(nodes),
                         .per_shared = std::vector<PerShared>(nodes),
                         .shared = at.shared + at.mixed.transpose() * per_shared,
                         .score = at.score + per_shared.transpose() * at.node_score};
  for (std::size_t i = nodes; i-- > 0;) {
    if (i + 1 < nodes) {
      const Smoothing& by = smoothings[i];
      own = by.next * own * by.next.transpose() + by.noise;
      per_shared = by.next * per_shared + by.shared;
    }
    known.own_rad2[i] = own;
    known.per_shared[i] = per_shared;
  }
  return known;
}

SharedErrors errors_of(const ChainInformation& known, const ChainNoise& noise) {
  const auto on_misalignment = noise.on_misalignment();
  const Eigen::Index estimated = on_misalignment ? kEstimated : SharedSunSensor;
  MatrixXd on_prior = MatrixXd::Zero(estimated, estimated);
  on_prior.topLeftCorner<3, 3>() = std::pow(noise.bias_rad_s, -2) * Matrix3d::Identity();
  if (on_misalignment) {
    on_prior.bottomRightCorner<3, 3>() = *on_misalignment;
  }
  const MatrixXd samples = known.shared.topLeftCorner(estimated, estimated);
  const MatrixXd gain = (samples + on_prior).inverse();
  // The errors of what is estimated follow those of its priors and those that are considered.
  SharedCovariance follow = SharedCovariance::Identity();
  follow.topLeftCorner(estimated, estimated) = gain * on_prior;
  follow.topRightCorner(estimated, kSharedErrors - estimated) =
      -gain * known.shared.topRightCorner(estimated, kSharedErrors - estimated);
  SharedCovariance by_samples = SharedCovariance::Zero();
  by_samples.topLeftCorner(estimated, estimated) = gain * samples * gain.transpose();
  const SharedCovariance exact = prior_of(noise.bias_rad_s, AttitudeAlignment::Zero());
  return {.total = by_samples + follow * noise.prior() * follow.transpose(),
          .noise = by_samples + follow * exact * follow.transpose()};
}

SharedCovariance least_errors_of(const ChainInformation& known, const ChainNoise& noise) {
  return left_by(known, noise.prior());
}

FittedFile fitted_file(const ChainInformation& known, const ChainNoise& noise,
                       const ChainState& state) {
  SharedVector at = SharedVector::Zero();
  at.segment<3>(SharedGyroBias) = state.bias_rad_s;
  at.segment<3>(SharedSunSensor) = state.misalignment_rad;
  const SharedVector score = known.score + known.shared * at;
  const SharedCovariance prior = noise.prior();
  SharedCovariance of_fit = SharedCovariance::Zero();
  of_fit.topLeftCorner<kEstimated, kEstimated>() = prior.topLeftCorner<kEstimated, kEstimated>();
  const SharedCovariance left = left_by(known, prior);
  const SharedVector best = left * score;
  return {.change = best - left_by(known, of_fit) * score,
          .beyond = beyond_prior(best, left, noise.alignment)};
}

Matrix3d allowed_by_file(const ChainResidual& residual, const PerShared& node_per_shared,
                         const SharedErrors& errors) {
  const PerShared slopes = residual.by_node * node_per_shared + residual.by_shared;
  return slopes * (errors.total - errors.noise) * slopes.transpose();
}

Vector3d left_of(const ChainResidual& residual, const PerShared& node_per_shared,
                 const SharedVector& change) {
  return residual.off + residual.by_node * (node_per_shared * change) + residual.by_shared * change;
}

}  // namespace spindrift
