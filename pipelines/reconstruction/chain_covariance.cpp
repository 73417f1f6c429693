#include "pipelines/reconstruction/chain_covariance.h"

#include <Eigen/Dense>
#include <cmath>
#include <iterator>
#include <utility>

#include "pipelines/frames/rotation_vector.h"
#include "pipelines/reconstruction/chain_fit.h"
#include "pipelines/statistics/considered.h"
#include "pipelines/three_axis/named_equations.h"

namespace spindrift {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

/// Holds the information on a node, and what it shares with the shared errors.
struct Information {
  Matrix3d node = Matrix3d::Zero();
  PerShared mixed = PerShared::Zero();

  void add(const ChainResidual& residual, double weight) {
    const Matrix3d weighted = weight * residual.by_node.transpose();
    node += weighted * residual.by_node;
    mixed += weighted * residual.by_shared;
  }
};

/// Holds error_node = turned (error_(node + 1) - slopes (errors of the gyro)) + noise, with the
/// slopes of the turn, and the information on the node without that noise.
struct Link {
  Matrix3d turned;
  Matrix3d noise;
  Matrix3d left;  ///< Share of the node's information that the noise leaves.
  Information passed_on;
};

/// Propagates the information to the next node. The turn's noise is marginalised without inverting
/// it, so that it may be arbitrarily small.
Link pass_on(const Turn& turn, const Matrix3d& turned, Information& at) {
  const Matrix3d noise = turned * turn.covariance_rad2 * turned.transpose();
  const Matrix3d left = (Matrix3d::Identity() + at.node * noise).inverse();
  const Link link{.turned = turned,
                  .noise = noise,
                  .left = left,
                  .passed_on = {.node = left * at.node, .mixed = left * at.mixed}};
  const Matrix3d next = turned.transpose() * link.passed_on.node * turned;
  at.node = 0.5 * (next + next.transpose());
  at.mixed = turned.transpose() * link.passed_on.mixed;
  at.mixed.middleCols<kTurnErrors>(SharedGyroBias) -= next * turn.per_error();
  return link;
}

/// Smooths back from the last node and sums up what the samples say of the shared errors.
class Smoother {
 public:
  Smoother(const Information& last, std::size_t nodes)
      : own_{last.node.inverse()},
        per_shared_{-own_ * last.mixed},
        known_{.own_rad2 = std::vector<Matrix3d>(nodes),
               .per_shared = std::vector<PerShared>(nodes),
               .shared = SharedCovariance::Zero(),
               .score = SharedVector::Zero()} {}

  void see(std::size_t node) {
    known_.own_rad2[node] = own_;
    known_.per_shared[node] = per_shared_;
  }

  void add(const ChainResidual& residual, double weight) {
    const PerShared slopes = residual.by_node * per_shared_ + residual.by_shared;
    known_.shared += weight * residual.by_shared.transpose() * slopes;
    known_.score -= weight * slopes.transpose() * residual.off;
  }

  /// @param off_rad How far the solution's turn is off the measured one.
  void step_back(const Link& link, const Turn& turn, const Vector3d& off_rad) {
    const PerTurnError slopes = turn.per_error();
    per_shared_.middleCols<kTurnErrors>(SharedGyroBias) -= slopes;
    per_shared_ = link.turned * per_shared_;
    const PerShared pull = link.passed_on.node * per_shared_ + link.passed_on.mixed;
    const PerShared pull_later = link.turned.transpose() * pull;
    known_.shared.middleRows<kTurnErrors>(SharedGyroBias) -= slopes.transpose() * pull_later;
    known_.score -= pull_later.transpose() * off_rad;
    per_shared_ -= link.noise * pull;
    const Matrix3d kept = (Matrix3d::Identity() - link.noise * link.passed_on.node) * link.turned;
    const Matrix3d gain = link.noise * link.left;
    own_ = kept * own_ * kept.transpose() + 0.5 * (gain + gain.transpose());
  }

  ChainInformation known() && {
    known_.shared = 0.5 * (known_.shared + known_.shared.transpose()).eval();
    return std::move(known_);
  }

 private:
  Matrix3d own_;
  PerShared per_shared_;
  ChainInformation known_;
};

/// Returns the score of the shared errors where all are zero.
SharedVector score_at_zero(const ChainInformation& known, const ChainState& state) {
  SharedVector at = SharedVector::Zero();
  at.segment<3>(SharedGyroBias) = state.bias_rad_s;
  at.segment<3>(SharedSunSensor) = state.misalignment_rad;
  return known.score + known.shared * at;
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
  FilterErrors estimate = FilterErrors::Zero();
  estimate(kOfAlignment) = best(kOfFile);
  FilterAlignment covariance = alignment.topLeftCorner<kFilterErrors, kFilterErrors>();
  covariance(kOfAlignment, kOfAlignment) = left(kOfFile, kOfFile);
  return error_beyond(estimate, alignment.topLeftCorner<kFilterErrors, kFilterErrors>(),
                      covariance);
}

}  // namespace

ChainInformation information_of(const Chain& chain, const ChainState& state) {
  const std::size_t nodes = chain.times_s.size();
  const auto sun_weight = [&](const ChainSun& sun) {
    return weight_of(sun, chain, state) / (chain.noise.sun_rad * chain.noise.sun_rad);
  };
  const double star_weight = 1.0 / (chain.noise.star_rad * chain.noise.star_rad);
  std::vector<Link> links;
  links.reserve(nodes);
  Information at;
  auto sun = chain.sun.begin();
  auto star = chain.stars.begin();
  for (std::size_t i = 0; i < nodes; ++i) {
    for (; sun != chain.sun.end() && sun->node == i; ++sun) {
      at.add(residual_of(*sun, state), sun_weight(*sun));
    }
    for (; star != chain.stars.end() && star->node == i; ++star) {
      at.add(residual_of(*star, state), star_weight);
    }
    if (i + 1 < nodes) {
      const Eigen::Quaterniond turned = state.q_icrf_body[i].conjugate() * state.q_icrf_body[i + 1];
      links.push_back(pass_on(chain.turns[i], turned.toRotationMatrix(), at));
    }
  }
  Smoother smoother{at, nodes};
  for (std::size_t i = nodes; i-- > 0;) {
    if (i + 1 < nodes) {
      smoother.step_back(links[i], chain.turns[i], gyro_residual(chain, i, state));
    }
    smoother.see(i);
    for (; sun != chain.sun.begin() && std::prev(sun)->node == i; --sun) {
      smoother.add(residual_of(*std::prev(sun), state), sun_weight(*std::prev(sun)));
    }
    for (; star != chain.stars.begin() && std::prev(star)->node == i; --star) {
      smoother.add(residual_of(*std::prev(star), state), star_weight);
    }
  }
  return std::move(smoother).known();
}

NormalEquations normal_equations(const ChainInformation& known, const ChainNoise& noise,
                                 const ChainState& state, TaiTime t) {
  using OfFile = Eigen::Matrix<double, kFileErrors, 1>;
  const SharedVector score = score_at_zero(known, state);
  Considered<kFileErrors, 3> bias;
  bias.shared = known.shared(kOfFile, Eigen::seqN(SharedGyroBias, Eigen::fix<3>));
  bias.own = known.shared.block<3, 3>(SharedGyroBias, SharedGyroBias);
  bias.score = score.segment<3>(SharedGyroBias);
  Eigen::Matrix<double, kFileErrors, kFileErrors> information = known.shared(kOfFile, kOfFile);
  OfFile of_file = score(kOfFile);
  bias.eliminate(noise.prior().block<3, 3>(SharedGyroBias, SharedGyroBias), information, of_file);
  return named_equations(t, kOfAlignment, information, of_file);
}

SharedErrors errors_of(const ChainInformation& known, const ChainNoise& noise) {
  using Estimated = Eigen::Matrix<double, kEstimatedErrors, kEstimatedErrors>;
  constexpr int kConsidered = kSharedErrors - kEstimatedErrors;
  Estimated on_prior = Estimated::Zero();
  on_prior.block<3, 3>(SharedSunSensor, SharedSunSensor) = noise.on_misalignment();
  on_prior.diagonal().segment<3>(SharedGyroBias).setConstant(std::pow(noise.bias_rad_s, -2));
  const Estimated samples = known.shared.topLeftCorner<kEstimatedErrors, kEstimatedErrors>();
  const Estimated gain = (samples + on_prior).inverse();
  // The errors of what is estimated follow those of its priors and those that are considered.
  SharedCovariance follow = SharedCovariance::Identity();
  follow.topLeftCorner<kEstimatedErrors, kEstimatedErrors>() = gain * on_prior;
  follow.topRightCorner<kEstimatedErrors, kConsidered>() =
      -gain * known.shared.topRightCorner<kEstimatedErrors, kConsidered>();
  const auto followed = [&](const AttitudeAlignment& alignment) -> SharedCovariance {
    SharedCovariance errors = follow * prior_of(noise.bias_rad_s, alignment) * follow.transpose();
    errors.topLeftCorner<kEstimatedErrors, kEstimatedErrors>() += gain * samples * gain.transpose();
    return errors;
  };
  return {
      .total = followed(noise.alignment),
      .noise =
          followed(AttitudeAlignment::Zero()).topLeftCorner<kEstimatedErrors, kEstimatedErrors>()};
}

SharedCovariance least_errors_of(const ChainInformation& known, const ChainNoise& noise) {
  return left_by(known, noise.prior());
}

FittedFile fitted_file(const ChainInformation& known, const ChainNoise& noise,
                       const ChainState& state) {
  const SharedVector score = score_at_zero(known, state);
  const SharedCovariance prior = noise.prior();
  SharedCovariance of_fit = SharedCovariance::Zero();
  of_fit.topLeftCorner<kEstimatedErrors, kEstimatedErrors>() =
      prior.topLeftCorner<kEstimatedErrors, kEstimatedErrors>();
  const SharedCovariance left = left_by(known, prior);
  const SharedVector best = left * score;
  return {.change = best - left_by(known, of_fit) * score,
          .beyond = beyond_prior(best, left, noise.alignment)};
}

Matrix3d allowed_by_file(const ChainResidual& residual, const PerShared& node_per_shared,
                         const SharedErrors& errors) {
  const PerShared slopes = residual.by_node * node_per_shared + residual.by_shared;
  SharedCovariance by_file = errors.total;
  by_file.topLeftCorner<kEstimatedErrors, kEstimatedErrors>() -= errors.noise;
  return slopes * by_file * slopes.transpose();
}

Vector3d left_of(const ChainResidual& residual, const PerShared& node_per_shared,
                 const SharedVector& change) {
  return residual.off + residual.by_node * (node_per_shared * change) + residual.by_shared * change;
}

}  // namespace spindrift
