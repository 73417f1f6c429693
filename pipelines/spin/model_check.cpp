#include "pipelines/spin/model_check.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <optional>

#include "pipelines/frames/celestial.h"
#include "pipelines/spin/geometry.h"
#include "pipelines/spin/screening.h"

namespace spindrift {
namespace {

constexpr int kMostAngles = 5;
using Errors = Eigen::Matrix<double, kModelErrors, 1>;
using ErrorMatrix = Eigen::Matrix<double, kModelErrors, kModelErrors>;

// Chances as sigmas of a normal variable: that right models are called wrong, one in ten thousand,
// since a pass asks a thousand times;
// that the errors are greater than said, one in ten.
constexpr double kSignificant = 3.72;
constexpr double kUpperEnd = 1.28;
// A combination of errors that is known no better than this is not seen.
constexpr double kUnseen_rad = 0.1;
// A chord that changes by more than so many times what the limb moves is not linear.
constexpr double kSteepest = 10.0;
// The noise is judged by so many angles at most, lest a little more than stated be called wrong.
constexpr double kNoiseAngles = 300.0;
constexpr double kNoiseSigmas = 5.0;

/// By Wilson and Hilferty.
double chi_square_quantile(double freedom, double sigmas) {
  const double variance = 2.0 / (9.0 * freedom);
  return freedom * std::pow(std::max(0.0, 1.0 - variance + sigmas * std::sqrt(variance)), 3);
}

/// How a measured angle moves.
struct Slope {
  Eigen::Vector3d by_axis;  ///< In ICRF, across the axis.
  Errors by_errors = Errors::Zero();
};

/// A direction as the axis sees it.
struct Seen {
  double angle_rad;
  Eigen::Vector3d towards;  ///< Unit, across the axis.
  Eigen::Vector3d beside;   ///< Unit, a quarter turn about the axis further.

  Seen(const Eigen::Vector3d& axis, const Eigen::Vector3d& direction)
      : angle_rad{angle_between_rad(axis, direction)} {
    beside = axis.cross(direction).normalized();
    towards = beside.cross(axis);
  }
};

class Slopes {
 public:
  Slopes(const Sightlines& sightlines, const Eigen::Vector3d& axis)
      : disc_rad_{sightlines.disc_rad},
        sun_{axis, sightlines.sun_icrf},
        earth_{axis, sightlines.earth_icrf} {}

  Slope of_sun_angle() const {
    return {.by_axis = -sun_.towards, .by_errors = Errors::Unit(SunAngleError)};
  }
  Slope of_dihedral(ModelError azimuth) const {
    return {.by_axis =
                sun_.beside / std::tan(sun_.angle_rad) - earth_.beside / std::tan(earth_.angle_rad),
            .by_errors = Errors::Unit(azimuth)};
  }
  /// Of what predict_chord_rad() gives; an error makes the disc of the model too large.
  Slope of_chord(double mount_angle_rad, double chord_rad, ModelError limb) const {
    const double sine = std::sin(earth_.angle_rad);
    const double steepness = 2.0 / (std::sin(mount_angle_rad) * sine * std::sin(0.5 * chord_rad));
    const double by_earth_angle =
        -steepness / sine *
        (std::cos(mount_angle_rad) - std::cos(disc_rad_) * std::cos(earth_.angle_rad));
    return {.by_axis = -by_earth_angle * earth_.towards,
            .by_errors = -steepness * std::sin(disc_rad_) * Errors::Unit(limb)};
  }

 private:
  double disc_rad_;
  Seen sun_;
  Seen earth_;
};

/// Empty for what rests on more errors than one, or is not linear.
std::optional<Slope> slope_of(const SpinConfig& config, const Slopes& slopes, SpinQuantity quantity,
                              double predicted_rad) {
  using enum SpinQuantity;
  const auto chord_slope = [&](Side side, ModelError limb) {
    const Slope slope =
        slopes.of_chord(sensor_of(config, side)->mount_angle_rad, predicted_rad, limb);
    return slope.by_errors.norm() < kSteepest ? std::optional{slope} : std::nullopt;
  };
  switch (quantity) {
    case SunAngle:
      return slopes.of_sun_angle();
    case NorthDihedral:
      return slopes.of_dihedral(NorthAzimuth);
    case SouthDihedral:
      return slopes.of_dihedral(SouthAzimuth);
    case NorthChord:
      return chord_slope(Side::North, NorthLimb);
    case SouthChord:
      return chord_slope(Side::South, SouthLimb);
    case MixedAzimuth:
    case Period:
      break;
  }
  return std::nullopt;
}

/// The errors, the axis eliminated, along the axes of their information.
class Spectrum {
 public:
  Spectrum(const ErrorMatrix& information, const Errors& score, double noise)
      : noise_{noise}, solver_{information}, scores_{solver_.eigenvectors().transpose() * score} {}

  double freedom() const { return static_cast<double>(seen().count()); }

  /// Where each error has this variance besides the noise.
  double chi_square(double error_rad2) const {
    const auto& informations = solver_.eigenvalues().array();
    return seen()
        .select(scores_.array().square() / (informations * (noise_ + informations * error_rad2)),
                0.0)
        .sum();
  }

  /// The greatest variance of the errors that is not unlikely.
  double upper_end_rad2() const {
    const double least = chi_square_quantile(freedom(), -kUpperEnd);
    double low_rad = 0.0;
    double high_rad = 1.0;
    for (int i = 0; i < kHalvings; ++i) {
      const double middle_rad = 0.5 * (low_rad + high_rad);
      (chi_square(middle_rad * middle_rad) > least ? low_rad : high_rad) = middle_rad;
    }
    return high_rad * high_rad;
  }

  /// Mean products of errors that had this variance before they were seen.
  ErrorMatrix mean_products_rad2(double error_rad2) const {
    const Errors gain = error_rad2 / (noise_ + error_rad2 * solver_.eigenvalues().array().max(0.0));
    const Errors seen_rad = gain.cwiseProduct(scores_);
    const ErrorMatrix rest_rad2 = (noise_ * gain).asDiagonal();
    return solver_.eigenvectors() * (rest_rad2 + seen_rad * seen_rad.transpose()) *
           solver_.eigenvectors().transpose();
  }

 private:
  static constexpr int kHalvings = 30;

  Eigen::Array<bool, kModelErrors, 1> seen() const {
    return solver_.eigenvalues().array() > 1.0 / (kUnseen_rad * kUnseen_rad);
  }

  double noise_;
  Eigen::SelfAdjointEigenSolver<ErrorMatrix> solver_;
  Errors scores_;
};

}  // namespace

void ModelCheck::add(const RevolutionMeasurements& measured, const Sightlines& sightlines,
                     const Eigen::Vector3d& axis_icrf) {
  if (angles_ == 0) {
    reference_icrf_ = axis_icrf;
  }
  const Eigen::Matrix<double, 3, 2> basis = tangent_basis(reference_icrf_);
  const Slopes slopes{sightlines, axis_icrf};
  Eigen::Matrix<double, kMostAngles, kUnknowns> design;
  Eigen::Matrix<double, kMostAngles, 1> off_rad;
  Eigen::Matrix<double, kMostAngles, kPulseChannels> noise_rad;
  int rows = 0;
  for (const Residual& residual : residuals(config_, measured, sightlines, axis_icrf)) {
    const Measured value = *good_value_of(measured, residual.quantity);
    if (const auto slope =
            slope_of(config_, slopes, residual.quantity, value.value_rad - residual.value_rad)) {
      design.row(rows) << slope->by_axis.transpose() * basis, slope->by_errors.transpose();
      off_rad(rows) = residual.value_rad + slope->by_axis.dot(axis_icrf - reference_icrf_);
      noise_rad.row(rows) = value.noise_rad.transpose();
      ++rows;
    }
  }
  if (rows == 0) {
    return;
  }
  // Edges are fewer than what they determine by one, the phase: the covariance has full rank.
  const Eigen::LLT<Eigen::MatrixXd> covariance{noise_rad.topRows(rows) *
                                               noise_rad.topRows(rows).transpose()};
  const auto white_design = covariance.matrixL().solve(design.topRows(rows)).eval();
  const auto white_off = covariance.matrixL().solve(off_rad.head(rows)).eval();
  normal_ += white_design.transpose() * white_design;
  right_ += white_design.transpose() * white_off;
  squares_ += white_off.squaredNorm();
  angles_ += rows;
}

double ModelCheck::excess_noise() const {
  using Normal = decltype(normal_);
  // What no angle fixes stays where it is.
  const double fitted = right_.dot((normal_ + Normal::Identity()).ldlt().solve(right_));
  const double freedom = angles_ - kUnknowns;
  if (!(freedom > 0.0)) {
    return 1.0;
  }
  const double excess = (squares_ - fitted) / freedom;
  const double scatter = std::sqrt(2.0 / std::min(freedom, kNoiseAngles));
  return excess > 1.0 + kNoiseSigmas * scatter ? excess : 1.0;
}

ModelVerdict ModelCheck::verdict(double allowed_rad) const {
  const auto axis = (normal_.topLeftCorner<2, 2>() + Eigen::Matrix2d::Identity()).ldlt();
  const Eigen::Matrix<double, 2, kModelErrors> coupling = normal_.topRightCorner<2, kModelErrors>();
  const ErrorMatrix information = normal_.bottomRightCorner<kModelErrors, kModelErrors>() -
                                  coupling.transpose() * axis.solve(coupling);
  const Errors score =
      right_.tail<kModelErrors>() - coupling.transpose() * axis.solve(right_.head<2>());
  return verdict_on({.information = information, .score = score}, excess_noise(), allowed_rad);
}

ModelVerdict verdict_on(const ErrorInformation& errors, double excess_noise, double allowed_rad) {
  ModelVerdict verdict{.excess_noise = excess_noise};
  const Spectrum spectrum{errors.information, errors.score, excess_noise};
  if (spectrum.freedom() == 0.0) {
    return verdict;
  }
  const double significant = chi_square_quantile(spectrum.freedom(), kSignificant);
  const double allowed_rad2 = allowed_rad * allowed_rad;
  if (!(spectrum.chi_square(allowed_rad2) > significant)) {
    return verdict;
  }
  const double error_rad2 = spectrum.upper_end_rad2();
  verdict.error_rad = std::sqrt(error_rad2);
  verdict.errors_rad2 = spectrum.mean_products_rad2(error_rad2);
  verdict.beyond_allowance =
      spectrum.chi_square(allowed_rad2 + kModelError_rad * kModelError_rad) > significant;
  return verdict;
}

}  // namespace spindrift
