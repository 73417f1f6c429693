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
#include <array>
#include <cstddef>
#include <span>

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
  /// @return The decrease of the sum of r^2 when b is fitted with its prior.
  double eliminate(const Prior& prior, Eigen::Matrix<double, unknowns, unknowns>& information,
                   Eigen::Matrix<double, unknowns, 1>& right) const {
    const Unknown unknown{prior};
    if (unknown.count() == 0) {
      return 0.0;
    }
    const Some<unknowns> of_unknown = shared(Eigen::all, unknown.indices());
    const Some<Eigen::Dynamic> known = posterior(prior, unknown);
    const Some<unknowns> moved = of_unknown.lazyProduct(known);
    const auto of_score = score(unknown.indices());
    information -= moved.lazyProduct(of_unknown.transpose());
    right -= moved.lazyProduct(of_score);
    return of_score.dot(known.lazyProduct(of_score));
  }

  /// Returns b fitted with its prior.
  Eigen::Matrix<double, parameters, 1> estimate(const Prior& prior) const {
    Eigen::Matrix<double, parameters, 1> fitted = Eigen::Matrix<double, parameters, 1>::Zero();
    if (const Unknown unknown{prior}; unknown.count() > 0) {
      fitted(unknown.indices()) =
          posterior(prior, unknown).lazyProduct(score(unknown.indices())).eval();
    }
    return fitted;
  }

  /// Returns the decrease of the sum of r^2 when b is fitted with its prior.
  double explained(const Prior& prior) const { return score.dot(estimate(prior)); }

 private:
  /// Matrix with one column for each unknown parameter.
  template <int rows>
  using Some = Eigen::Matrix<double, rows, Eigen::Dynamic, 0,
                             rows == Eigen::Dynamic ? parameters : rows, parameters>;

  /// Indices of the parameters that the prior, which may be singular, leaves unknown.
  class Unknown {
   public:
    explicit Unknown(const Prior& prior) {
      for (int i = 0; i < parameters; ++i) {
        if (prior(i, i) > 0.0) {
          indices_.at(count_++) = i;
        }
      }
    }
    std::size_t count() const { return count_; }
    std::span<const int> indices() const { return {indices_.data(), count_}; }

   private:
    std::array<int, parameters> indices_{};
    std::size_t count_ = 0;
  };

  /// Returns the covariance of the unknown parameters with their prior and known x.
  Some<Eigen::Dynamic> posterior(const Prior& prior, const Unknown& unknown) const {
    const std::span<const int> indices = unknown.indices();
    const auto size = static_cast<Eigen::Index>(unknown.count());
    const Some<Eigen::Dynamic> of_unknown = prior(indices, indices);
    const Some<Eigen::Dynamic> relative =
        Some<Eigen::Dynamic>::Identity(size, size) + of_unknown.lazyProduct(own(indices, indices));
    return relative.partialPivLu().solve(of_unknown);
  }
};

/// Returns the covariance that b with this prior gives to a solution.
/// @param moved Shift of the solution per unit of b: S.
template <int unknowns, int parameters>
Eigen::Matrix<double, unknowns, unknowns> covariance_of_moved(
    const Eigen::Matrix<double, unknowns, parameters>& moved,
    const Eigen::Matrix<double, parameters, parameters>& prior) {
  // These sizes are too small for the blocks of a general product to pay.
  const Eigen::Matrix<double, unknowns, parameters> by_prior = moved.lazyProduct(prior);
  return by_prior.lazyProduct(moved.transpose());
}

}  // namespace spindrift
