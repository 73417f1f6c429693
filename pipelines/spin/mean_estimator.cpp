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
// Where fewer of the fixes that there might be are settled, the mean is that of a selection.
constexpr double kMostlySettled = 0.5;

}  // namespace

void MeanEstimator::keep(std::int64_t revolution, const RevolutionMeasurements& measured,
                         const Sightlines& sightlines) {
  kept_.push_back({.revolution = revolution, .measured = measured, .sightlines = sightlines});
  if (kept_.size() > static_cast<std::size_t>(config_.screening.window) + 1) {
    kept_.pop_front();
  }
}

bool MeanEstimator::take(const SpinFix& fix) {
  const auto kept = std::find_if(kept_.rbegin(), kept_.rend(), [&](const Kept& candidate) {
    return candidate.revolution == fix.revolution;
  });
  if (kept == kept_.rend() || (began_ && fix.t < *began_)) {
    return false;
  }
  const bool settled = fix.accepted && !fix.grazing;
  if (settled && kept->fate != Fate::Settled) {
    settle(*kept, fix);
  } else if (!settled) {
    leave_out(*kept, fix);
  }
  return settled;
}

/// Revolutions without a root at all are missing besides: next to those that graze hardly any, as
/// long as one of twenty is settled, and as many where one of a thousand is. As long as nothing
/// tells branches apart it is not the noise that leaves their fixes open.
void MeanEstimator::leave_out(Kept& kept, const SpinFix& fix) {
  const bool by_noise = fix.grazing ? fix.accepted || fix.resolution == Resolution::Ambiguous
                                    : mean_ && fix.resolution == Resolution::Ambiguous;
  if (by_noise && kept.fate == Fate::Open) {
    kept.fate = Fate::LeftOut;
    kept.geometry_case = fix.geometry_case;
    kept.stretch = fixes_.next_stretch(fix.geometry_case);
    fixes_.leave_out(kept.geometry_case, kept.stretch);
    if (mean_) {
      mean_ = fixes_.mean();
    }
  }
}

void MeanEstimator::settle(Kept& kept, const SpinFix& fix) {
  if (!mean_) {
    fixes_.begin_at(fix.axis_icrf);
  }
  if (kept.fate == Fate::LeftOut) {
    fixes_.take_back(kept.geometry_case, kept.stretch);
  } else {
    kept.geometry_case = fix.geometry_case;
    kept.stretch = fixes_.next_stretch(fix.geometry_case);
  }
  kept.fate = Fate::Settled;
  add(kept, mean_ ? axis_icrf() : fix.axis_icrf);
  mean_ = fixes_.mean();
  ++settled_;
  if (std::has_single_bit(settled_)) {
    linearise_anew();
  }
  if (mean_->covariance_rad2.trace() < kLinear_rad * kLinear_rad) {
    verdict_ = judge_model(mean_->equations, 0.0);
  }
}

void MeanEstimator::add(const Kept& kept, const Eigen::Vector3d& axis_icrf) {
  fixes_.add(kept.geometry_case, kept.stretch, config_, kept.measured, kept.sightlines, axis_icrf);
}

/// The first are added about a mean that rests on few. While all are kept, they are linear about
/// what they have in common; afterwards the mean hardly moves.
void MeanEstimator::linearise_anew() {
  const auto is_settled = [](const Kept& kept) { return kept.fate == Fate::Settled; };
  if (static_cast<std::size_t>(std::count_if(kept_.begin(), kept_.end(), is_settled)) != settled_) {
    return;
  }
  for (int pass = 0; pass < kMostPasses; ++pass) {
    const Eigen::Vector3d axis = axis_icrf();
    fixes_.begin_at(axis);
    for (const Kept& kept : kept_) {
      if (is_settled(kept)) {
        add(kept, axis);
      }
    }
    mean_ = fixes_.mean();
    if (angle_between_rad(axis, axis_icrf()) < kConverged_rad) {
      return;
    }
  }
}

void MeanEstimator::begin_anew(TaiTime t) {
  *this = MeanEstimator{config_};
  began_ = t;
}

Eigen::Matrix2d MeanEstimator::covariance_rad2() const {
  const Eigen::Matrix<double, 2, kModelErrors> shift = mean_->equations.model_shift();
  return mean_->covariance_rad2 * verdict_.excess_noise +
         shift * verdict_.errors_rad2 * shift.transpose();
}

Eigen::Matrix2d MeanEstimator::covariance_if_moved_rad2() const {
  return verdict_.excess_noise > 1.0 ? mean_->covariance_rad2 : covariance_rad2();
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
  const std::string fixes = fmt::format("{} fixes", mean_->count);
  if (mean_->settled_share < kMostlySettled) {
    return fmt::format("DOUBTFUL, {}, {:.0f} % of such graze or are ambiguous", fixes,
                       100.0 * (1.0 - mean_->settled_share));
  }
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
