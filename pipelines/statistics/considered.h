/// @file
/// Consider analysis: parameters b that one pass cannot check and that do not average out, in
/// addition to the unknowns x of its normal equations. With whitened equations
///
///     r = J x + J_b b + noise
///
/// and the prior covariance B of b, a least-squares solution that assumes b = 0 is off by S b,
/// where S = -(J'J)^-1 J'J_b. Its covariance is (J'J)^-1 + S B S'.

#pragma once

#include <Eigen/Core>
#include <Eigen/LU>

namespace spindrift {

template <int unknowns, int parameters>
struct Considered {
  using Prior = Eigen::Matrix<double, parameters, parameters>;

  Eigen::Matrix<double, unknowns, parameters> shared =
      Eigen::Matrix<double, unknowns, parameters>::Zero();  ///< J'J_b
  Prior own = Prior::Zero();                                ///< J_b'J_b
  Eigen::Matrix<double, parameters, 1> score =
      Eigen::Matrix<double, parameters, 1>::Zero();  ///< J_b'r

  Considered& operator+=(const Considered& other) {
    shared += other.shared;
    own += other.own;
    score += other.score;
    return *this;
  }
  Considered& operator*=(double share) {
    shared *= share;
    own *= share;
    score *= share;
    return *this;
  }

  /// Marginalises b over its prior, which leaves the information on x alone. A zero prior means
  /// that b is known and changes nothing.
  /// @param information J'J of x; @param right J'r.
  void eliminate(const Prior& prior, Eigen::Matrix<double, unknowns, unknowns>& information,
                 Eigen::Matrix<double, unknowns, 1>& right) const {
    if ((prior.array() == 0.0).all()) {
      return;
    }
    // The prior may be singular if part of b is known.
    const Prior known = posterior(prior);
    information -= shared * known * shared.transpose();
    right -= shared * known * score;
  }

  /// Returns b fitted with its prior.
  Eigen::Matrix<double, parameters, 1> estimate(const Prior& prior) const {
    return posterior(prior) * score;
  }

  /// Returns the decrease of the sum of r^2 when b is fitted with its prior.
  double explained(const Prior& prior) const { return score.dot(estimate(prior)); }

 private:
  /// Returns the covariance of b with its prior and known x.
  Prior posterior(const Prior& prior) const {
    return (Prior::Identity() + prior * own).partialPivLu().solve(prior);
  }
};

}  // namespace spindrift
