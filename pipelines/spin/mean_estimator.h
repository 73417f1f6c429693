/// @file
/// The estimator `mean`: the weighted mean of the accepted fixes, and how far it is to be believed.
/// Its covariance holds the noise of the fixes, what those that nothing settled may have moved it
/// by, and what the residuals show to be wrong with noise and model.

#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

#include "pipelines/spin/association.h"
#include "pipelines/spin/config.h"
#include "pipelines/spin/mean_axis.h"
#include "pipelines/spin/model_check.h"
#include "pipelines/spin/products.h"

namespace spindrift {

class MeanEstimator {
 public:
  explicit MeanEstimator(const SpinConfig& config) : config_{config}, check_{config} {}

  /// @param newest The revolution at whose end the fix was settled.
  /// @return Whether it is in the mean now: it is accepted, does not graze, and is not of before
  /// the
  ///         mean began.
  bool take(const SpinFix& fix, std::int64_t newest);

  /// A revolution whose fix is in the mean.
  void check(const RevolutionMeasurements& measured, const Sightlines& sightlines);

  /// When the axis has moved, a mean of the whole pass would lie where it never was.
  void begin_anew(TaiTime t);

  /// Of fixes in the mean; the following need one.
  std::size_t count() const { return axis_.count(); }
  Eigen::Vector3d axis_icrf() const { return axis_.axis_icrf(); }
  Eigen::Matrix2d covariance_rad2() const;  ///< In the tangent plane: east, north.
  /// Likewise, against the question whether the axis has moved: a wrong model moves the mean and
  /// lets residuals scatter as before; a move does not.
  Eigen::Matrix2d covariance_if_moved_rad2() const;

  /// What each error of the model moves it by, for every radian of it; in that plane.
  Eigen::Matrix<double, 2, kModelErrors> model_shift() const { return axis_.model_shift(); }

  SpinEstimate estimate(const Revolution& revolution) const;

 private:
  Eigen::Matrix2d noise_rad2() const;
  std::string status() const;

  SpinConfig config_;
  MeanAxis axis_;
  ModelCheck check_;
  ModelVerdict verdict_;
  std::int64_t unsettled_ = 0;    ///< AMBIGUOUS fixes since the mean began.
  std::optional<TaiTime> began_;  ///< Empty: with the pass.
};

}  // namespace spindrift
