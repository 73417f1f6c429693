/// @file
/// The measured angles of many revolutions as one linear least-squares problem,
///
///     r = H x + B b + C c + noise,
///
/// with the residuals r against an axis near the true one, the displacement x of the axis in the
/// tangent plane, the errors b of the model, the offsets c of the channels' times, and the noise of
/// the edges that the angles share. The slopes H and B are those at the axis that the angles are
/// compared with, never at what was measured: what an angle weighs must not depend on its own
/// noise, or the mean lies to one side.

#pragma once

#include <Eigen/Core>
#include <utility>

#include "pipelines/spin/measurement/measurement.h"
#include "pipelines/spin/types/channel_offsets.h"
#include "pipelines/spin/types/config.h"
#include "pipelines/spin/types/model_allowance.h"
#include "pipelines/spin/types/sun_earth_directions.h"
#include "pipelines/statistics/considered.h"

namespace spindrift {

class AngleEquations {
 public:
  static constexpr int kUnknowns = 2 + kModelErrors;  ///< x, then b.

  /// @param reference_icrf Unit: where x counts from.
  explicit AngleEquations(Eigen::Vector3d reference_icrf)
      : reference_icrf_{std::move(reference_icrf)} {}

  /// The good angles of one revolution, those left out that are not linear.
  /// @param axis_icrf Unit; so near the true one that the others are linear in between.
  void add(const SpinConfig& config, const RevolutionMeasurements& measured,
           const SunEarthDirections& sun_earth, const Eigen::Vector3d& axis_icrf);

  /// @param other Of the same reference, and of other revolutions.
  AngleEquations& operator+=(const AngleEquations& other);

  /// The axis that fits best where the model has no errors. Unit; a direction that no angle fixes
  /// stays at the reference.
  Eigen::Vector3d axis_icrf() const;
  /// In the tangent plane at that axis: east, north. A direction that no angle fixes has a radian.
  Eigen::Matrix2d covariance_rad2() const;
  /// What the axis scatters by, likewise, where the right sides of its two equations do so by that.
  Eigen::Matrix2d scatter_rad2(const Eigen::Matrix2d& of_right) const;
  /// What each error of the model moves the axis by, for every radian of it; likewise.
  Eigen::Matrix<double, 2, kModelErrors> model_shift() const;

  /// What the offset of each channel's times moves the axis by, rad/s; likewise.
  Eigen::Matrix<double, 2, kChannelOffsets> offset_shift() const;

  /// @name The normal equations of x and b
  /// @{
  const Eigen::Matrix<double, kUnknowns, kUnknowns>& normal() const { return normal_; }
  const Eigen::Matrix<double, kUnknowns, 1>& right() const { return right_; }
  double squares() const { return squares_; }  ///< Of the residuals against the reference.
  int angles() const { return angles_; }
  const Considered<kUnknowns, kChannelOffsets>& offsets() const { return offsets_; }
  /// @}

 private:
  Eigen::Matrix2d axis_information() const;
  Eigen::Matrix2d tangent_from_reference() const;

  Eigen::Vector3d reference_icrf_;
  Eigen::Matrix<double, kUnknowns, kUnknowns> normal_ =
      Eigen::Matrix<double, kUnknowns, kUnknowns>::Zero();
  Eigen::Matrix<double, kUnknowns, 1> right_ = Eigen::Matrix<double, kUnknowns, 1>::Zero();
  double squares_ = 0.0;
  int angles_ = 0;
  Considered<kUnknowns, kChannelOffsets> offsets_;
};

}  // namespace spindrift
