#include "pipelines/reconstruction/chain_covariance.h"

#include <Eigen/Dense>
#include <cmath>

#include "pipelines/frames/rotation_vector.h"
#include "pipelines/reconstruction/chain_fit.h"

namespace spindrift {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

/// Holds the information matrix of one node and the shared unknowns.
struct Information {
  Matrix3d node;
  PerShared mixed;
  Shared shared;
};

/// Holds the coefficients of error_node = next error_(node + 1) + shared shared_error + noise.
struct Smoothing {
  Matrix3d next;
  PerShared shared;
  Matrix3d noise;
};

Eigen::Index unknowns_of(const Chain& chain) { return chain.noise.misalignment_rad ? 6 : 3; }

Information prior_of(const Chain& chain) {
  const Eigen::Index unknowns = unknowns_of(chain);
  Information prior{.node = Matrix3d::Zero(),
                    .mixed = PerShared::Zero(3, unknowns),
                    .shared = Shared::Zero(unknowns, unknowns)};
  prior.shared.diagonal().head<3>().setConstant(std::pow(chain.noise.bias_rad_s, -2));
  if (chain.noise.misalignment_rad) {
    prior.shared.diagonal().tail<3>().setConstant(std::pow(*chain.noise.misalignment_rad, -2));
  }
  return prior;
}

void add(const ChainSun& sun, const Chain& chain, const ChainState& state, Information& at) {
  const Vector3d predicted = predicted_sun(state, sun);
  const double variance = chain.noise.sun_rad * chain.noise.sun_rad;
  const double weight =
      weight_of((predicted - sun.of.measured_body).squaredNorm() / variance) / variance;
  const Matrix3d aligned = quaternion_by(state.misalignment_rad).toRotationMatrix();
  const Matrix3d by_node = aligned * cross_matrix(aligned.transpose() * predicted);
  at.node += weight * by_node.transpose() * by_node;
  if (chain.noise.misalignment_rad) {
    const Matrix3d by_shared =
        -cross_matrix(predicted) * right_jacobian(state.misalignment_rad).transpose();
    at.mixed.rightCols<3>() += weight * by_node.transpose() * by_shared;
    at.shared.bottomRightCorner<3, 3>() += weight * by_shared.transpose() * by_shared;
  }
}

/// Propagates the information to the next node. The turn's noise is marginalised without inverting
/// it, so that it may be arbitrarily small.
Smoothing pass_on(const Turn& turn, const Matrix3d& turned, Information& at) {
  PerShared later_per_shared = PerShared::Zero(3, at.mixed.cols());
  later_per_shared.leftCols<3>() = turn.per_bias_s;
  const Matrix3d noise = turned * turn.covariance_rad2 * turned.transpose();
  const Matrix3d left = (Matrix3d::Identity() + at.node * noise).inverse();
  const Matrix3d gain = noise * left;
  const PerShared earlier_per_shared = -turned * later_per_shared;
  const Matrix3d kept = Matrix3d::Identity() - gain * at.node;
  Smoothing smoothing{.next = kept * turned,
                      .shared = kept * earlier_per_shared - gain * at.mixed,
                      .noise = 0.5 * (gain + gain.transpose())};
  const Matrix3d node = left * at.node;
  const PerShared mixed = left * at.mixed;
  at.shared -= at.mixed.transpose() * gain * at.mixed;
  at.shared += earlier_per_shared.transpose() * (node * earlier_per_shared + mixed) +
               mixed.transpose() * earlier_per_shared;
  at.mixed = turned.transpose() * (node * earlier_per_shared + mixed);
  const Matrix3d next = turned.transpose() * node * turned;
  at.node = 0.5 * (next + next.transpose());
  return smoothing;
}

}  // namespace

ChainCovariance covariance_of(const Chain& chain, const ChainState& state) {
  const std::size_t nodes = chain.times_s.size();
  std::vector<Smoothing> smoothings;
  smoothings.reserve(nodes);
  Information at = prior_of(chain);
  auto sun = chain.sun.begin();
  auto star = chain.stars.begin();
  for (std::size_t i = 0; i < nodes; ++i) {
    for (; sun != chain.sun.end() && sun->node == i; ++sun) {
      add(*sun, chain, state, at);
    }
    for (; star != chain.stars.end() && star->node == i; ++star) {
      at.node.diagonal().array() += 1.0 / (chain.noise.star_rad * chain.noise.star_rad);
    }
    if (i + 1 < nodes) {
      const Matrix3d turned =
          (state.q_icrf_body[i].conjugate() * state.q_icrf_body[i + 1]).toRotationMatrix();
      smoothings.push_back(pass_on(chain.turns[i], turned, at));
    }
  }
  Matrix3d own = at.node.inverse();
  PerShared per_shared = -own * at.mixed;
  const Shared shared = Shared{at.shared + at.mixed.transpose() * per_shared}.inverse();
  ChainCovariance all{.shared = shared,
                      .nodes_rad2 = std::vector<Matrix3d>(nodes),
                      .node_shared = std::vector<PerShared>(nodes)};
  for (std::size_t i = nodes; i-- > 0;) {
    if (i + 1 < nodes) {
      const Smoothing& by = smoothings[i];
      own = by.next * own * by.next.transpose() + by.noise;
      per_shared = by.next * per_shared + by.shared;
    }
    all.node_shared[i] = per_shared * shared;
    all.nodes_rad2[i] = own + all.node_shared[i] * per_shared.transpose();
  }
  return all;
}

}  // namespace spindrift
