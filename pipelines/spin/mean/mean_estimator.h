/// @file
/// The estimator `mean`: the mean of the accepted fixes and its quality.
///
/// To first order in its measurements, a fix is a displacement from the mean so far, and the mean
/// of all is the axis that fits their measurements best (angle_equations.h), so that each fix
/// counts by its geometry. Rejected: the mean of the unit vectors, weighted by the covariances that
/// the fixes state. Both depend on the noise of the fix in second order, which does not average
/// out: with only one beam, that mean was biased by up to nine of its sigmas.
///
/// The mean of unit vectors, the plain average, always lies among its fixes. So the least squares
/// start there and are checked against it; where they leave it, or the angles are not linear and
/// leave the axis open, the plain average is used instead.
///
/// The covariance holds the noise of the fixes, the errors that the mission file states, of a time
/// grid, the shift by fixes left
/// out because of their noise (fixes_by_case.h), and the errors of noise and model that the
/// residuals show. Cases that may shift the mean by more than they help are not in it. The
/// qualities are
///     OK         none of the following applies, or the model is off within its allowance
///     CONVERGING as OK, but from too few fixes (convergence.h)
///     DOUBTFUL   the residuals scatter more than their noise, or the model is off by more; or most
///                fixes of its kind were left out; or the mean is a plain average, or of fixes that
///                differ or are too few to check each other
///     LOST       the axis has moved, or the mean was wrong, and no fix has come since
/// The pass (pass/spin_pass.h) may doubt it further.

#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <utility>

#include "pipelines/spin/mean/angle_equations.h"
#include "pipelines/spin/mean/fixes_by_case.h"
#include "pipelines/spin/mean/mean_axis.h"
#include "pipelines/spin/mean/model_check.h"
#include "pipelines/spin/measurement/measurement.h"
#include "pipelines/spin/types/config.h"
#include "pipelines/spin/types/products.h"
#include "pipelines/spin/types/revolution.h"
#include "pipelines/spin/types/sky.h"

namespace spindrift {

class MeanEstimator {
 public:
  explicit MeanEstimator(SpinConfig config)
      : config_{std::move(config)},
        alignment_root_{root_of(config_.alignment)},
        fixes_{static_cast<std::size_t>(config_.screening.window)} {}

  /// Keeps the measurements of a revolution, since its fix may be settled as late as the window of
  /// screening allows.
  void keep(std::int64_t revolution, const RevolutionMeasurements& measured,
            const SunEarthDirections& sun_earth);

  /// @return True if the fix may be in the mean: it is accepted, not near-tangent, and not older
  /// than the mean.
  bool add_fix(const SpinFix& fix);

  /// Restarts the mean when the axis has moved, since old and new fixes would average to neither
  /// axis.
  void begin_anew(TaiTime t);

  /// Number of fixes in the mean; axis and covariances need one.
  std::size_t count() const { return mean_ ? mean_->count : 0; }
  Eigen::Vector3d axis_icrf() const;
  /// Total, tangent plane: east, north.
  Eigen::Matrix2d covariance_rad2() const { return covariance_rad2_; }
  /// Part of the covariance that errors of the mission file make.
  Eigen::Matrix2d alignment_rad2() const { return alignment_rad2_; }
  /// Returns how errors of the mission file move the axis; empty of the plain average.
  std::optional<AxisShift> shift_icrf() const;
  /// Covariance by noise for testing whether the axis has moved. Scatter beyond the stated noise,
  /// which a move causes, does not enlarge it.
  Eigen::Matrix2d covariance_if_moved_rad2() const;

  /// Estimate of the mean, or of the one given up; one of them must exist.
  SpinEstimate estimate(const Revolution& revolution) const;

 private:
  enum class Fate { Open, LeftOut, Settled };
  struct Kept {
    std::int64_t revolution;
    RevolutionMeasurements measured;
    SunEarthDirections sun_earth;
    Fate fate = Fate::Open;
    int geometry_case = 0;  ///< Geometry case of the fix, unless open.
    std::int64_t stretch = 0;
  };

  void leave_out(Kept& kept, const SpinFix& fix);
  void settle(Kept& kept, const SpinFix& fix);
  void linearise(const Kept& kept, const Eigen::Vector3d& axis_icrf);
  void relinearise();
  void linearise_about(const Eigen::Vector3d& axis_icrf);
  void conclude();
  Eigen::Matrix2d least_squares_covariance_rad2() const;
  Eigen::Matrix2d average_covariance_rad2() const;
  Eigen::Matrix2d considered_rad2(const ConsideredPrior& prior) const;
  double excess_noise() const;
  double fix_rad2() const;
  bool less_informative_than_one_fix() const;
  double distance_from_average_rad() const;
  bool agrees_with_average(const Eigen::Matrix2d& covariance_rad2) const;
  std::optional<Reason> doubt() const;
  Assessment assess() const;

  SpinConfig config_;
  SpinAlignment alignment_root_;
  PulseNoise noise_{config_.noise};  ///< Noise of the last measurements.
  std::deque<Kept> kept_;            ///< Last revolutions.
  FixesByCase fixes_;
  std::size_t settled_ = 0;          ///< Number of fixes in `fixes_`.
  std::optional<MeanOfCases> mean_;  ///< Least-squares mean.
  MeanAxis average_;                 ///< Plain average of the same fixes.
  ModelTest verdict_;
  bool by_least_squares_ = false;  ///< Whether the axis is not that of the plain average.
  Eigen::Matrix2d covariance_rad2_ = Eigen::Matrix2d::Zero();
  Eigen::Matrix2d alignment_rad2_ = Eigen::Matrix2d::Zero();
  std::optional<TaiTime> began_;  ///< Empty if begun with the pass.
  std::optional<Eigen::Vector3d> abandoned_axis_icrf_;
};

}  // namespace spindrift
