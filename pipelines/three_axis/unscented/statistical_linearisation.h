/// @file
/// The unscented transform as a statistical linearisation. A random vector x of covariance P = L L'
/// goes through a function f at the sigma points
///
///     mean,    mean + h l_j,    mean - h l_j,
///
/// with the columns l_j of L, h^2 = 3 for the fourth moment of a normal variable. What comes out is
///
///     f(x) = f(mean) + shift + slope (x - mean) + rest,    cov(rest) = curved,
///
/// where the rest is uncorrelated with x. The covariance is that of the central differences of
/// Norgaard, Poulsen and Ravn 2000, which unlike that of the weighted points is never negative and
/// does not depend on components of x that f ignores.

#pragma once

#include <Eigen/Core>
#include <cmath>

namespace spindrift {

/// Returns the lower triangle L with L L' = `covariance`. A component that the ones before it
/// determine, as one that is exactly known, has a column of zeros.
template <int kSize>
Eigen::Matrix<double, kSize, kSize> lower_factor(
    const Eigen::Matrix<double, kSize, kSize>& covariance) {
  constexpr double kRounding = 1e-13;
  Eigen::Matrix<double, kSize, kSize> lower = Eigen::Matrix<double, kSize, kSize>::Zero();
  for (int j = 0; j < kSize; ++j) {
    const double left = covariance(j, j) - lower.row(j).head(j).squaredNorm();
    if (!(left > kRounding * covariance(j, j))) {
      continue;
    }
    lower(j, j) = std::sqrt(left);
    for (int i = j + 1; i < kSize; ++i) {
      lower(i, j) =
          (covariance(i, j) - lower.row(i).head(j).dot(lower.row(j).head(j))) / lower(j, j);
    }
  }
  return lower;
}

template <int kFrom, int kTo>
struct StatisticalLinearisation {
  using Out = Eigen::Matrix<double, kTo, 1>;

  Out shift = Out::Zero();
  Eigen::Matrix<double, kTo, kFrom> slope = Eigen::Matrix<double, kTo, kFrom>::Zero();
  Eigen::Matrix<double, kTo, kTo> curved = Eigen::Matrix<double, kTo, kTo>::Zero();
};

/// @param covariance Covariance of x.
/// @param f Maps the deviation of x from its mean to the deviation of the result from that of the
///        mean.
template <int kTo, int kFrom, class Function>
StatisticalLinearisation<kFrom, kTo> linearised(
    const Eigen::Matrix<double, kFrom, kFrom>& covariance, const Function& f) {
  using Result = StatisticalLinearisation<kFrom, kTo>;
  using Out = typename Result::Out;
  constexpr double kStep2 = 3.0;
  const double step = std::sqrt(kStep2);
  const Eigen::Matrix<double, kFrom, kFrom> lower = lower_factor<kFrom>(covariance);
  Result result;
  for (int j = kFrom - 1; j >= 0; --j) {
    if (lower(j, j) == 0.0) {
      continue;
    }
    const Eigen::Matrix<double, kFrom, 1> away = step * lower.col(j);
    const Out up = f(away);
    const Out down = f(-away);
    const Out bend = (up + down) / (2.0 * kStep2);
    result.shift += bend;
    result.curved += (kStep2 - 1.0) * bend * bend.transpose();
    // Solves slope L = differences from the last column to the first.
    Out rise = (up - down) / (2.0 * step);
    for (int k = j + 1; k < kFrom; ++k) {
      rise -= result.slope.col(k) * lower(k, j);
    }
    result.slope.col(j) = rise / lower(j, j);
  }
  return result;
}

}  // namespace spindrift
