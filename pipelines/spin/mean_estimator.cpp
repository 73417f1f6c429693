#include "pipelines/spin/mean_estimator.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "pipelines/spin/geometry.h"
#include "pipelines/time/utc.h"

namespace spindrift {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;
// A mean that is known so well is near enough for angles to be linear about it.
constexpr double kLinear_rad = kDegree;

}  // namespace

bool MeanEstimator::take(const SpinFix& fix, std::int64_t newest) {
  // Where two roots come together within the noise the covariance is too small, and revolutions
  // without a root are missing: the mean of such fixes lies to one side.
  const bool settled = fix.accepted && !fix.grazing;
  unsettled_ += fix.resolution == Resolution::Ambiguous || (fix.accepted && fix.grazing) ? 1 : 0;
  unsettled_ -= settled && fix.revolution != newest ? 1 : 0;
  if (!settled || (began_ && fix.t < *began_)) {
    return false;
  }
  axis_.add(fix);
  return true;
}

void MeanEstimator::check(const RevolutionMeasurements& measured, const Sightlines& sightlines) {
  if (axis_.covariance_rad2().trace() > kLinear_rad * kLinear_rad) {
    return;
  }
  check_.add(measured, sightlines, axis_.axis_icrf());
  verdict_ = check_.verdict(
      config_.horizon.model == HorizonModel::Sphere ? 0.0 : oblateness_rad(sightlines.disc_rad));
}

void MeanEstimator::begin_anew(TaiTime t) {
  *this = MeanEstimator{config_};
  began_ = t;
}

/// Where a share s of the fixes is left out because nothing settles them, those that are settled
/// lie to one side: by up to s sigma of a single fix, which their number does not reduce.
Eigen::Matrix2d MeanEstimator::noise_rad2() const {
  const auto settled = static_cast<double>(axis_.count());
  const double unsettled = std::max(0.0, static_cast<double>(unsettled_));
  const double share = unsettled / (settled + unsettled);
  return axis_.covariance_rad2() * (1.0 + settled * share * share);
}

Eigen::Matrix2d MeanEstimator::covariance_rad2() const {
  const Eigen::Matrix<double, 2, kModelErrors> shift = axis_.model_shift();
  return noise_rad2() * verdict_.excess_noise + shift * verdict_.errors_rad2 * shift.transpose();
}

Eigen::Matrix2d MeanEstimator::covariance_if_moved_rad2() const {
  return verdict_.excess_noise > 1.0 ? noise_rad2() : covariance_rad2();
}

SpinEstimate MeanEstimator::estimate(const Revolution& revolution) const {
  const double rate_rad_s = 2.0 * std::numbers::pi / revolution.period.period_s;
  return {
      .t = revolution.t_start,
      .estimator = SpinEstimator::Mean,
      .axis_icrf = axis_.axis_icrf(),
      .covariance_rad2 = covariance_rad2(),
      .spin_rate_rad_s = rate_rad_s,
      .spin_rate_sigma_rad_s = rate_rad_s / revolution.period.period_s * revolution.period.sigma_s,
      .status = status()};
}

std::string MeanEstimator::status() const {
  const bool noisy = verdict_.excess_noise > 1.0;
  const bool off = verdict_.error_rad > 0.0;
  const std::string fixes = fmt::format("{} fixes", axis_.count());
  if (!noisy && !off) {
    return fmt::format("OK, {}{}, spherical horizon", fixes,
                       began_ ? " since " + format_utc(*began_, 0) : "");
  }
  return fmt::format(
      "{}{}{}{}", verdict_.beyond_allowance || noisy ? "DOUBTFUL, " : "OK, ", fixes,
      off ? fmt::format(", model off by {:.2g} deg", verdict_.error_rad / kDegree) : "",
      noisy ? fmt::format(", noise x {:.1f}", std::sqrt(verdict_.excess_noise)) : "");
}

}  // namespace spindrift
