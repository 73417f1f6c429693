/// @file
/// The estimator `mean`: the mean of the accepted fixes, and how far it is to be believed.
///
/// To first order in its measurements, a fix is a displacement from the mean so far, and the mean
/// of all is the axis that fits their measurements best (angle_equations.h). So each counts by what
/// its geometry is worth there. Rejected: the mean of the unit vectors, weighted by the covariances
/// that the fixes state. Both depend on the noise of the fix, in the second order, and do not
/// average out: where one beam is all there is, it lay up to nine of its sigmas to one side.
///
/// That mean of unit vectors, the plain average, lies among its fixes whatever they are. So it is
/// where the least squares begin, and what they are held against: where they leave it, or the
/// angles are not linear and leave the axis open, the plain average stands in for them.
///
/// Its covariance holds the noise of the fixes, what a grid of their times leaves open, what it may
/// have moved it by that others were left out for their noise (fixes_by_case.h), and what the
/// residuals show to be wrong with noise and model. Cases that it may move by more than they help
/// are not in it. Its quality is
///     OK         all is well, or the model is off within its allowance
///     CONVERGING likewise, but of too few fixes (convergence.h)
///     DOUBTFUL   the residuals scatter more than their noise, or the model is off by more; or most
///                fixes like those that it rests on were left out; or it is a plain average, or
///                of fixes that differ, or of so few that nothing checks them
///     LOST       the axis has moved, or the mean was wrong, and no fix has come since

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
#include "pipelines/spin/types/sun_earth_directions.h"

namespace spindrift {

class MeanEstimator {
 public:
  explicit MeanEstimator(SpinConfig config)
      : config_{std::move(config)}, fixes_{static_cast<std::size_t>(config_.screening.window)} {}

  /// The measurements of a revolution, before its fix is taken: a fix may be settled as late as the
  /// window of screening allows.
  void keep(std::int64_t revolution, const RevolutionMeasurements& measured,
            const SunEarthDirections& sun_earth);

  /// @return Whether it may be in the mean: it is accepted, does not graze, and is not of before
  ///         the mean began.
  bool take(const SpinFix& fix);

  /// When the axis has moved, a mean of the whole pass would lie where it never was.
  void begin_anew(TaiTime t);

  /// Of fixes in the mean; the following need one.
  std::size_t count() const { return mean_ ? mean_->count : 0; }
  Eigen::Vector3d axis_icrf() const;
  Eigen::Matrix2d covariance_rad2() const;  ///< In the tangent plane: east, north.
  /// Likewise, against the question whether the axis has moved: a wrong model moves the mean and
  /// lets residuals scatter as before; a move does not.
  Eigen::Matrix2d covariance_if_moved_rad2() const;

  /// Of the mean, or of that which was given up; there must be one of them.
  SpinEstimate estimate(const Revolution& revolution) const;

 private:
  enum class Fate { Open, LeftOut, Settled };
  struct Kept {
    std::int64_t revolution;
    RevolutionMeasurements measured;
    SunEarthDirections sun_earth;
    Fate fate = Fate::Open;
    int geometry_case = 0;  ///< Of its fix, unless open; likewise the following.
    std::int64_t stretch = 0;
  };

  void leave_out(Kept& kept, const SpinFix& fix);
  void settle(Kept& kept, const SpinFix& fix);
  void add(const Kept& kept, const Eigen::Vector3d& axis_icrf);
  void relinearise();
  void linearise_about(const Eigen::Vector3d& axis_icrf);
  Eigen::Matrix2d least_squares_covariance_rad2() const;
  Eigen::Matrix2d offsets_rad2() const;
  double excess_noise() const;
  double fix_rad2() const;
  bool less_informative_than_one_fix() const;
  double distance_from_average_rad() const;
  bool agrees_with_average() const;
  std::optional<Reason> doubt() const;
  Assessment assess() const;

  SpinConfig config_;
  PulseNoise noise_{config_.noise};  ///< Of the last measurements.
  std::deque<Kept> kept_;            ///< The last revolutions.
  FixesByCase fixes_;
  std::size_t settled_ = 0;          ///< So many are in these.
  std::optional<MeanOfCases> mean_;  ///< The least squares.
  MeanAxis average_;                 ///< Of the same fixes.
  ModelTest verdict_;
  std::optional<TaiTime> began_;  ///< Empty: with the pass.
  std::optional<Eigen::Vector3d> abandoned_axis_icrf_;
};

}  // namespace spindrift
