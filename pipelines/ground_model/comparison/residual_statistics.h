/// @file
/// Statistics of the residuals of a channel.

#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "pipelines/ground_model/comparison/compared_sample.h"

namespace spindrift {

/// Accumulates residuals, flight minus model, in the unit of the channel. A statistic is 0 where
/// there are too few residuals for it.
class ResidualStatistics {
 public:
  void add(const ComparedValue& value) {
    const double residual = value.residual();
    const double before = residual - mean_;
    ++count_;
    mean_ += before / static_cast<double>(count_);
    about_mean_ += before * (residual - mean_);
    squares_ += residual * residual;
    normalised_squares_ += value.normalised() * value.normalised();
    most_ = std::max(most_, std::abs(residual));
  }

  std::int64_t count() const { return count_; }
  double mean() const { return mean_; }
  /// Returns the standard deviation about the mean.
  double sigma() const {
    return count_ > 1 ? std::sqrt(about_mean_ / static_cast<double>(count_ - 1)) : 0.0;
  }
  double rms() const { return root_mean(squares_); }
  /// Returns the rms of the residuals divided by their sigma: 1 where only noise makes them.
  double normalised_rms() const { return root_mean(normalised_squares_); }
  double most() const { return most_; }  ///< Largest absolute residual.

 private:
  double root_mean(double squares) const {
    return count_ > 0 ? std::sqrt(squares / static_cast<double>(count_)) : 0.0;
  }

  std::int64_t count_ = 0;
  double mean_ = 0.0;
  double about_mean_ = 0.0;  ///< Sum of squares about the mean.
  double squares_ = 0.0;
  double normalised_squares_ = 0.0;
  double most_ = 0.0;
};

}  // namespace spindrift
