#include "pipelines/spin/mean_estimator.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>

#include "pipelines/frames/celestial.h"
#include "pipelines/time/utc.h"

namespace spindrift {
namespace {

// A mean that is known so well (1 deg) is near enough for angles to be linear about it.
constexpr double kLinear_rad = std::numbers::pi / 180.0;
// Where a pass of the first fixes moves their mean by less, they are linear about it.
constexpr double kConverged_rad = 1e-5;
constexpr int kMostPasses = 8;

}  // namespace

void MeanEstimator::keep(std::int64_t revolution, const RevolutionMeasurements& measured,
                         const Sightlines& sightlines) {
  kept_.push_back({.revolution = revolution, .measured = measured, .sightlines = sightlines});
  if (kept_.size() > static_cast<std::size_t>(config_.screening.window) + 1) {
    kept_.pop_front();
  }
}

bool MeanEstimator::take(const SpinFix& fix, std::int64_t newest) {
  // Where two roots come together within the noise, revolutions without a root are missing: the
  // mean of such fixes lies to one side.
  const bool settled = fix.accepted && !fix.grazing;
  unsettled_ += fix.resolution == Resolution::Ambiguous || (fix.accepted && fix.grazing) ? 1 : 0;
  unsettled_ -= settled && fix.revolution != newest ? 1 : 0;
  if (!settled || (began_ && fix.t < *began_)) {
    return false;
  }
  const auto kept = std::find_if(kept_.rbegin(), kept_.rend(), [&](const Kept& candidate) {
    return candidate.revolution == fix.revolution;
  });
  if (kept == kept_.rend()) {
    return false;
  }
  if (!kept->in_mean) {
    add(*kept, fix);
  }
  return true;
}

void MeanEstimator::add(Kept& kept, const SpinFix& fix) {
  if (!equations_) {
    equations_.emplace(fix.axis_icrf);
  }
  equations_->add(config_, kept.measured, kept.sightlines, axis_icrf());
  kept.in_mean = true;
  ++count_;
  if (std::has_single_bit(count_)) {
    linearise_anew();
  }
  if (noise_rad2().trace() < kLinear_rad * kLinear_rad) {
    verdict_ = judge_model(*equations_, 0.0);
  }
}

/// The first are added about a mean that rests on few. While all are kept, they are linear about
/// what they have in common; afterwards the mean hardly moves.
void MeanEstimator::linearise_anew() {
  const auto in_mean = [](const Kept& kept) { return kept.in_mean; };
  if (static_cast<std::size_t>(std::count_if(kept_.begin(), kept_.end(), in_mean)) != count_) {
    return;
  }
  for (int pass = 0; pass < kMostPasses; ++pass) {
    const Eigen::Vector3d axis = axis_icrf();
    equations_.emplace(axis);
    for (const Kept& kept : kept_) {
      if (kept.in_mean) {
        equations_->add(config_, kept.measured, kept.sightlines, axis);
      }
    }
    if (angle_between_rad(axis, axis_icrf()) < kConverged_rad) {
      return;
    }
  }
}

void MeanEstimator::begin_anew(TaiTime t) {
  *this = MeanEstimator{config_};
  began_ = t;
}

/// Where a share s of the fixes is left out because nothing settles them, those that are settled
/// lie to one side: by up to s sigma of a single fix, which their number does not reduce.
Eigen::Matrix2d MeanEstimator::noise_rad2() const {
  const auto settled = static_cast<double>(count_);
  const double unsettled = std::max(0.0, static_cast<double>(unsettled_));
  const double share = unsettled / (settled + unsettled);
  return equations_->covariance_rad2() * (1.0 + settled * share * share);
}

Eigen::Matrix2d MeanEstimator::covariance_rad2() const {
  const Eigen::Matrix<double, 2, kModelErrors> shift = equations_->model_shift();
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
      .axis_icrf = axis_icrf(),
      .covariance_rad2 = covariance_rad2(),
      .spin_rate_rad_s = rate_rad_s,
      .spin_rate_sigma_rad_s = rate_rad_s / revolution.period.period_s * revolution.period.sigma_s,
      .status = status()};
}

std::string MeanEstimator::status() const {
  const bool noisy = verdict_.excess_noise > 1.0;
  const bool off = verdict_.error_rad > 0.0;
  const std::string fixes = fmt::format("{} fixes", count_);
  if (!noisy && !off) {
    return fmt::format("OK, {}{}", fixes, began_ ? " since " + format_utc(*began_, 0) : "");
  }
  return fmt::format(
      "{}{}{}{}", verdict_.beyond_allowance || noisy ? "DOUBTFUL, " : "OK, ", fixes,
      off ? fmt::format(", model off by {:.2g} deg", verdict_.error_rad * 180.0 / std::numbers::pi)
          : "",
      noisy ? fmt::format(", noise x {:.1f}", std::sqrt(verdict_.excess_noise)) : "");
}

}  // namespace spindrift
