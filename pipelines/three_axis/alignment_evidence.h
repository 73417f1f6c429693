/// @file
/// This file holds what the innovations of a filter say of the errors of the mission file.
///
/// With the sensitivity S of its state to the errors b, a filter that assumes b = 0 has innovations
///
///     nu = G b + white,    G = H S + H_b,    cov(white) = E = H P H' + R.
///
/// They thus are independent measurements of b, which are processed here beside the filter (the
/// separate-bias estimation of Friedland 1969): what they say of b, and what b does not explain.

#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <optional>
#include <string_view>

#include "pipelines/three_axis/sensor_errors.h"

namespace spindrift {

/// An error that must lie further beyond the stated knowledge of it than chance explains.
struct ErrorBeyond {
  std::string_view key;  ///< Key of the mission file that states the knowledge.
  double sigmas;         ///< Estimated error in stated standard deviations.
};

using FilterErrors = Eigen::Matrix<double, kFilterErrors, 1>;

/// Returns the kind of error that lies the most stated sigmas off, of those that do so beyond
/// chance; empty if what was measured is explained by errors as stated.
/// @param estimate Errors that explain it best, given their prior.
/// @param prior Covariance that the mission file states.
/// @param left Covariance of the estimate.
std::optional<ErrorBeyond> error_beyond(const FilterErrors& estimate, const FilterAlignment& prior,
                                        const FilterAlignment& left);

class AlignmentEvidence {
 public:
  using Vector = FilterErrors;
  template <int kSize>
  using PerError = Eigen::Matrix<double, kSize, kFilterErrors>;

  explicit AlignmentEvidence(const FilterAlignment& prior) : prior_{prior}, covariance_{prior} {}

  /// Adds an innovation.
  /// @param per_error Its derivative G by the errors.
  /// @param expected Its covariance E if the errors were known.
  /// @return Normalised square of what the errors, as known before, do not explain; chi-square with
  ///         `kSize` degrees of freedom and independent from one innovation to the next.
  template <int kSize>
  double add(const Eigen::Matrix<double, kSize, 1>& innovation, const PerError<kSize>& per_error,
             const Eigen::Matrix<double, kSize, kSize>& expected) {
    const PerError<kSize> weighted = expected.llt().solve(per_error);
    information_.noalias() += per_error.transpose() * weighted;
    score_.noalias() += weighted.transpose() * innovation;

    const PerError<kSize> shared = per_error * covariance_;
    const Eigen::Matrix<double, kSize, kSize> total = expected + shared * per_error.transpose();
    const Eigen::LLT<Eigen::Matrix<double, kSize, kSize>> solver{total};
    const PerError<kSize> gain = solver.solve(shared);
    const Eigen::Matrix<double, kSize, 1> left = innovation - per_error * estimate_;
    estimate_.noalias() += gain.transpose() * left;
    covariance_.noalias() -= gain.transpose() * shared;
    return left.dot(solver.solve(left));
  }

  /// Returns the covariance that the mission file states.
  const FilterAlignment& prior() const { return prior_; }
  /// Returns the information on the errors, sum of G' E^-1 G.
  const FilterAlignment& information() const { return information_; }
  /// Returns the score of the errors at zero, sum of G' E^-1 nu.
  const Vector& score() const { return score_; }

  std::optional<ErrorBeyond> beyond() const { return error_beyond(estimate_, prior_, covariance_); }

 private:
  FilterAlignment prior_;
  FilterAlignment information_ = FilterAlignment::Zero();
  Vector score_ = Vector::Zero();
  Vector estimate_ = Vector::Zero();
  FilterAlignment covariance_;  ///< Covariance of `estimate_`.
};

}  // namespace spindrift
