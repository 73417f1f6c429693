#include "pipelines/spin/mean/angle_equations.h"

#include <Eigen/Dense>
#include <cmath>
#include <optional>

#include "pipelines/frames/celestial.h"
#include "pipelines/spin/measurement/errors_of_alignment.h"
#include "pipelines/spin/screening/screening.h"

namespace spindrift {
namespace {

constexpr int kMostAngles = 5;

using Errors = Eigen::Matrix<double, kModelErrors, 1>;

/// Slopes of a measured angle.
struct Slope {
  Eigen::Vector3d by_axis;  ///< Slope in ICRF, across the axis.
  Errors by_errors = Errors::Zero();
  double by_late_tag = 0.0;  ///< Slope by the time tag, per second that it is late.
};

/// Holds a direction relative to the axis.
struct Seen {
  double angle_rad;
  Eigen::Vector3d towards;  ///< Unit vector across the axis.
  Eigen::Vector3d beside;   ///< Unit vector a quarter turn about the axis further.

  Seen(const Eigen::Vector3d& axis, const Eigen::Vector3d& direction)
      : angle_rad{angle_between_rad(axis, direction)} {
    beside = axis.cross(direction).normalized();
    towards = beside.cross(axis);
  }
};

/// Returns the change of an angle per second that each edge is late, from its noise part.
Eigen::Matrix<double, 1, kPulseChannels> per_second(const EdgeNoise& noise_rad,
                                                    const PulseNoise& noise) {
  Eigen::Matrix<double, 1, kPulseChannels> slopes;
  for (std::size_t i = 0; i < kPulseChannels; ++i) {
    const auto column = static_cast<Eigen::Index>(i);
    slopes(column) = noise_rad(column) / edge_sigma_s(noise, static_cast<PulseChannel>(i));
  }
  return slopes;
}

class Slopes {
 public:
  Slopes(const SpinConfig& config, const SunEarthDirections& sun_earth, const Eigen::Vector3d& axis)
      : config_{config},
        disc_rad_{sun_earth.disc_rad},
        sun_{axis, sun_earth.sun_icrf},
        earth_{axis, sun_earth.earth_icrf},
        errors_of_alignment_{
            spindrift::errors_of_alignment(config, {.sun_angle_rad = sun_.angle_rad,
                                                    .earth_angle_rad = earth_.angle_rad,
                                                    .disc_rad = sun_earth.disc_rad})} {
    const Eigen::Vector3d& motion = sun_earth.earth_motion_icrf_s;
    const Eigen::Vector3d outwards =
        std::cos(earth_.angle_rad) * earth_.towards - std::sin(earth_.angle_rad) * axis;
    earth_angle_per_s_ = motion.dot(outwards);
    dihedral_per_s_ = motion.dot(earth_.beside) / std::sin(earth_.angle_rad);
    disc_per_s_ = -std::tan(disc_rad_) * motion.dot(sun_earth.earth_icrf);
  }

  /// Returns the slope of an angle by errors of the mission file.
  Eigen::Matrix<double, 1, kSpinAlignmentErrors> by_alignment(const Slope& slope) const {
    Eigen::Matrix<double, 1, kSpinAlignmentErrors> by =
        slope.by_errors.transpose() * errors_of_alignment_;
    by(TimeTagError) += slope.by_late_tag;
    return by;
  }

  /// Returns empty for an angle that is not linear.
  std::optional<Slope> of(SpinQuantity quantity, const Measured& value,
                          double predicted_rad) const {
    using enum SpinQuantity;
    switch (quantity) {
      case SunAngle:
        return of_sun_angle();
      case NorthDihedral:
      case SouthDihedral:
        return of_dihedral(value.noise_rad);
      case NorthChord:
        return of_chord(config_.north->mount_angle_rad, predicted_rad, NorthLimb);
      case SouthChord:
        return of_chord(config_.south->mount_angle_rad, predicted_rad, SouthLimb);
      case MixedAzimuth:
        return of_mixed_azimuth(value.noise_rad);
      case Period:
        break;
    }
    return std::nullopt;
  }

 private:
  Slope of_sun_angle() const {
    return {.by_axis = -sun_.towards, .by_errors = Errors::Unit(SunAngleError)};
  }

  /// Averages the azimuth errors of the beams whose edges take part.
  Slope of_dihedral(const EdgeNoise& noise_rad) const {
    const auto rests_on = [&](PulseChannel channel) {
      return noise_rad(static_cast<Eigen::Index>(channel)) != 0.0 ? 1.0 : 0.0;
    };
    const double north = rests_on(PulseChannel::NorthIn);
    const double south = rests_on(PulseChannel::SouthIn);
    return {.by_axis =
                sun_.beside / std::tan(sun_.angle_rad) - earth_.beside / std::tan(earth_.angle_rad),
            .by_errors = (north * Errors::Unit(NorthAzimuth) + south * Errors::Unit(SouthAzimuth)) /
                         (north + south),
            .by_late_tag = -dihedral_per_s_};
  }

  /// Slope of predict_mixed_azimuth_rad(): the dihedral less the lag of slit 2.
  Slope of_mixed_azimuth(const EdgeNoise& noise_rad) const {
    const double tan_cant = std::tan(config_.sun_sensor.slit_cant_rad);
    const double sine = std::sin(sun_.angle_rad);
    const double sin_lag = tan_cant / std::tan(sun_.angle_rad);
    const double by_sun_angle = tan_cant / (sine * sine * std::sqrt(1.0 - sin_lag * sin_lag));
    Slope slope = of_dihedral(noise_rad);
    slope.by_axis -= by_sun_angle * sun_.towards;
    slope.by_errors += by_sun_angle * Errors::Unit(SunAngleError);
    return slope;
  }

  /// Slope of predict_chord_rad(); a limb error makes the disc of the model too large.
  std::optional<Slope> of_chord(double mount_angle_rad, double chord_rad, ModelError limb) const {
    const double sine = std::sin(earth_.angle_rad);
    const double steepness = 2.0 / (std::sin(mount_angle_rad) * sine * std::sin(0.5 * chord_rad));
    const double by_limb = steepness * std::sin(disc_rad_);
    const double by_earth_angle =
        -steepness / sine *
        (std::cos(mount_angle_rad) - std::cos(disc_rad_) * std::cos(earth_.angle_rad));
    // Slope of a chord with the limb beyond which the chord is not linear.
    if (!(by_limb < 10.0)) {
      return std::nullopt;
    }
    return Slope{.by_axis = -by_earth_angle * earth_.towards,
                 .by_errors = -by_limb * Errors::Unit(limb),
                 .by_late_tag = -by_earth_angle * earth_angle_per_s_ - by_limb * disc_per_s_};
  }

  const SpinConfig& config_;
  double disc_rad_;
  Seen sun_;
  Seen earth_;
  ErrorsOfAlignment errors_of_alignment_;
  double earth_angle_per_s_;
  double dihedral_per_s_;
  double disc_per_s_;
};

}  // namespace

void AngleEquations::add(const SpinConfig& config, const RevolutionMeasurements& measured,
                         const SunEarthDirections& sun_earth, const Eigen::Vector3d& axis_icrf) {
  const Eigen::Matrix<double, 3, 2> basis = tangent_basis(reference_icrf_);
  const Slopes slopes{config, sun_earth, axis_icrf};
  Eigen::Matrix<double, kMostAngles, kUnknowns> design;
  Eigen::Matrix<double, kMostAngles, 1> off_rad;
  Eigen::Matrix<double, kMostAngles, kPulseChannels> noise_rad;
  Eigen::Matrix<double, kMostAngles, kSpinConsidered> by_considered;
  int rows = 0;
  for (const AngleResidual& residual : residuals(config, measured, sun_earth, axis_icrf)) {
    const Measured value = *good_value_of(measured, residual.quantity);
    if (const auto slope =
            slopes.of(residual.quantity, value, value.value_rad - residual.value_rad)) {
      design.row(rows) << slope->by_axis.transpose() * basis, slope->by_errors.transpose();
      off_rad(rows) = residual.value_rad + slope->by_axis.dot(axis_icrf - reference_icrf_);
      noise_rad.row(rows) = value.noise_rad.transpose();
      by_considered.row(rows) << per_second(value.noise_rad, measured.noise),
          slopes.by_alignment(*slope);
      ++rows;
    }
  }
  if (rows == 0) {
    return;
  }
  // One edge fixes the phase, so angles are fewer than their edges and the covariance has full
  // rank.
  const Eigen::LLT<Eigen::MatrixXd> covariance{noise_rad.topRows(rows) *
                                               noise_rad.topRows(rows).transpose()};
  const auto white_design = covariance.matrixL().solve(design.topRows(rows)).eval();
  const auto white_off = covariance.matrixL().solve(off_rad.head(rows)).eval();
  // These sizes are too small for the blocks of a general product to pay.
  normal_ += white_design.transpose().lazyProduct(white_design);
  right_ += white_design.transpose() * white_off;
  squares_ += white_off.squaredNorm();
  const auto white_considered = covariance.matrixL().solve(by_considered.topRows(rows)).eval();
  considered_.shared += white_design.transpose().lazyProduct(white_considered);
  considered_.own += white_considered.transpose().lazyProduct(white_considered);
  considered_.score += white_considered.transpose() * white_off;
  angles_ += rows;
}

AngleEquations& AngleEquations::operator+=(const AngleEquations& other) {
  normal_ += other.normal_;
  right_ += other.right_;
  squares_ += other.squares_;
  considered_ += other.considered_;
  angles_ += other.angles_;
  return *this;
}

/// Information of the axis with a weak prior of one radian for directions without angles.
Eigen::Matrix2d AngleEquations::axis_information() const {
  return normal_.topLeftCorner<2, 2>() + Eigen::Matrix2d::Identity();
}

Eigen::Vector3d AngleEquations::axis_icrf() const {
  return (reference_icrf_ +
          tangent_basis(reference_icrf_) * axis_information().ldlt().solve(right_.head<2>()))
      .normalized();
}

/// Transforms the tangent plane at the reference to that at the axis, as near a celestial pole
/// their east differs.
Eigen::Matrix2d AngleEquations::tangent_from_reference() const {
  return tangent_basis(axis_icrf()).transpose() * tangent_basis(reference_icrf_);
}

Eigen::Matrix2d AngleEquations::covariance_rad2() const {
  const Eigen::Matrix2d turned = tangent_from_reference();
  return turned * axis_information().ldlt().solve(turned.transpose());
}

Eigen::Matrix2d AngleEquations::scatter_rad2(const Eigen::Matrix2d& of_right) const {
  const Eigen::Matrix2d moved =
      axis_information().ldlt().solve(tangent_from_reference().transpose()).transpose();
  return moved * of_right * moved.transpose();
}

Eigen::Matrix<double, 2, kModelErrors> AngleEquations::model_shift() const {
  return tangent_from_reference() *
         axis_information().ldlt().solve(normal_.topRightCorner<2, kModelErrors>());
}

Eigen::Matrix<double, 2, kSpinConsidered> AngleEquations::considered_shift() const {
  return tangent_from_reference() *
         axis_information().ldlt().solve(considered_.shared.topRows<2>());
}

ErrorInformation AngleEquations::less_axis() const {
  const auto axis = axis_information().ldlt();
  const Eigen::Matrix<double, 2, kModelErrors> coupling = normal_.topRightCorner<2, kModelErrors>();
  const Eigen::Matrix<double, kModelErrors, 2> taken = axis.solve(coupling).transpose();
  const auto shared = considered_.shared.topRows<2>();
  const Eigen::Matrix<double, kSpinConsidered, 2> of_considered = axis.solve(shared).transpose();
  ErrorInformation left;
  left.information = normal_.bottomRightCorner<kModelErrors, kModelErrors>() - taken * coupling;
  left.score = right_.tail<kModelErrors>() - taken * right_.head<2>();
  left.considered = {.shared = considered_.shared.bottomRows<kModelErrors>() - taken * shared,
                     .own = considered_.own - of_considered.lazyProduct(shared),
                     .score = considered_.score - of_considered * right_.head<2>()};
  return left;
}

}  // namespace spindrift
