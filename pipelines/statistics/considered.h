/// @file
/// Parameters b that one pass cannot check and that do not average out, beside the unknowns x of
/// its normal equations (consider analysis). With whitened equations
///
///     r = J x + J_b b + noise
///
/// and the prior covariance B of b, least squares that take b for zero are off by S b, where
/// S = -(J'J)^-1 J'J_b: their covariance is (J'J)^-1 + S B S'.

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

  /// What the equations say of x whatever b is: b is a draw from its prior and eliminated. With a
  /// prior of zero it is known, and nothing changes.
  /// @param information J'J of x; @param right J'r.
  void eliminate(const Prior& prior, Eigen::Matrix<double, unknowns, unknowns>& information,
                 Eigen::Matrix<double, unknowns, 1>& right) const {
    if ((prior.array() == 0.0).all()) {
      return;
    }
    // The prior may be singular, where some of b is known.
    const Prior known = posterior(prior);
    information -= shared * known * shared.transpose();
    right -= shared * known * score;
  }

  /// By how much less the sum of r^2 is where b is fitted, with its prior.
  double explained(const Prior& prior) const { return score.dot(posterior(prior) * score); }

 private:
  /// Of b, covariance with its prior, x known.
  Prior posterior(const Prior& prior) const {
    return (Prior::Identity() + prior * own).partialPivLu().solve(prior);
  }
};

}  // namespace spindrift
