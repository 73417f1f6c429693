#include "pipelines/spin/mean/mean_estimator.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>

#include "pipelines/frames/angle.h"
#include "pipelines/frames/celestial.h"
#include "pipelines/spin/types/convergence.h"
#include "pipelines/statistics/significance.h"

namespace spindrift {
namespace {

// Angles are linear about a mean that is known to 1 deg.
constexpr double kLinear_rad = kRadPerDeg;
// Two differing fixes do not show which is right.
constexpr std::size_t kFewestFixes = 3;

/// Returns the period error of the clock and of a time grid. The number of turns behind the period
/// is the least that a line through times with the noise of a slit needs for this sigma.
double period_sigma_s(const SpinPeriod& period, const PulseNoise& noise) {
  if (noise.grid_s == 0.0) {
    return period.sigma_s;
  }
  const double turns = std::pow(std::sqrt(12.0) * noise.sun_s / period.sigma_s, 2.0 / 3.0);
  return std::hypot(period.sigma_s, std::sqrt(2.0) * grid_sigma_s(noise) / turns);
}

}  // namespace

void MeanEstimator::keep(std::int64_t revolution, const RevolutionMeasurements& measured,
                         const SunEarthDirections& sun_earth) {
  if (std::exchange(noise_, measured.noise) != measured.noise && mean_) {
    conclude();
  }
  kept_.push_back({.revolution = revolution, .measured = measured, .sun_earth = sun_earth});
  if (kept_.size() > static_cast<std::size_t>(config_.screening.window) + 1) {
    kept_.pop_front();
  }
}

bool MeanEstimator::add_fix(const SpinFix& fix) {
  const auto kept = std::find_if(kept_.rbegin(), kept_.rend(), [&](const Kept& candidate) {
    return candidate.revolution == fix.revolution;
  });
  if (kept == kept_.rend() || (began_ && fix.t < *began_)) {
    return false;
  }
  const bool settled = fix.accepted && !fix.near_tangent;
  if (settled && kept->fate != Fate::Settled) {
    settle(*kept, fix);
  } else if (!settled) {
    leave_out(*kept, fix);
  }
  return settled;
}

/// Counts a fix as left out because of noise. Revolutions without any root are not counted; beside
/// the near-tangent ones they are few if one fix in twenty is settled, as many if one in a
/// thousand. Before the mean begins, ambiguous fixes are open because nothing separates branches,
/// not by noise.
void MeanEstimator::leave_out(Kept& kept, const SpinFix& fix) {
  const bool by_noise = fix.near_tangent ? fix.accepted || fix.resolution == Resolution::Ambiguous
                                         : mean_ && fix.resolution == Resolution::Ambiguous;
  if (by_noise && kept.fate == Fate::Open) {
    kept.fate = Fate::LeftOut;
    kept.geometry_case = fix.geometry_case;
    kept.stretch = fixes_.next_stretch(fix.geometry_case);
    fixes_.leave_out(kept.geometry_case, kept.stretch);
    if (mean_) {
      mean_ = fixes_.mean();
      conclude();
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
  average_.add_fix(fix);
  linearise(kept, mean_ ? axis_icrf() : fix.axis_icrf);
  mean_ = fixes_.mean();
  ++settled_;
  // Number of fixes that each trigger a relinearisation.
  if (settled_ < 8 || std::has_single_bit(settled_)) {
    relinearise();
  }
  if (mean_->covariance_rad2.trace() < kLinear_rad * kLinear_rad) {
    verdict_ = test_model(mean_->equations, considered_prior(noise_, config_.alignment));
  }
  conclude();
}

/// Chooses between least squares and plain average. Any change of fixes, noise or model calls for
/// it.
void MeanEstimator::conclude() {
  const Eigen::Matrix2d least_squares_rad2 = least_squares_covariance_rad2();
  by_least_squares_ = agrees_with_average(least_squares_rad2);
  covariance_rad2_ = by_least_squares_ ? least_squares_rad2 : average_covariance_rad2();
  alignment_rad2_ = by_least_squares_ ? considered_rad2(considered_prior(config_.alignment))
                                      : average_.alignment_rad2();
}

void MeanEstimator::linearise(const Kept& kept, const Eigen::Vector3d& axis_icrf) {
  fixes_.add_fix(kept.geometry_case, kept.stretch, config_, kept.measured, kept.sun_earth,
                 axis_icrf);
}

/// Adds all fixes again about their mean while all are kept; later the mean hardly moves. If this
/// does not converge among the fixes, they stay linearised about the plain average.
void MeanEstimator::relinearise() {
  const auto settled = std::count_if(kept_.begin(), kept_.end(),
                                     [](const Kept& kept) { return kept.fate == Fate::Settled; });
  if (static_cast<std::size_t>(settled) != settled_) {
    return;
  }
  Eigen::Vector3d axis = average_.axis_icrf();
  for (int pass = 0; pass < 8; ++pass) {
    linearise_about(axis);
    const Eigen::Vector3d next = mean_->equations.axis_icrf();
    // The first fixes are linear about their mean when relinearising moves it by less than this.
    if (angle_between_rad(axis, next) < 1e-5) {
      return;
    }
    if (!by_least_squares_) {
      break;
    }
    axis = next;
  }
  linearise_about(average_.axis_icrf());
}

void MeanEstimator::linearise_about(const Eigen::Vector3d& axis_icrf) {
  fixes_.begin_at(axis_icrf);
  for (const Kept& kept : kept_) {
    if (kept.fate == Fate::Settled) {
      linearise(kept, axis_icrf);
    }
  }
  mean_ = fixes_.mean();
  conclude();
}

void MeanEstimator::begin_anew(TaiTime t) {
  const std::optional<Eigen::Vector3d> given_up =
      mean_ ? std::optional{axis_icrf()} : abandoned_axis_icrf_;
  *this = MeanEstimator{config_};
  began_ = t;
  abandoned_axis_icrf_ = given_up;
}

Eigen::Vector3d MeanEstimator::axis_icrf() const {
  return by_least_squares_ ? mean_->equations.axis_icrf() : average_.axis_icrf();
}

/// Errors of a plain average do not average out: it is known as well as one fix, and as well as it
/// agrees with a least-squares axis that is determined.
Eigen::Matrix2d MeanEstimator::average_covariance_rad2() const {
  const double off_rad = less_informative_than_one_fix() ? 0.0 : distance_from_average_rad();
  return average_.covariance_rad2() * average_.excess_scatter() *
             static_cast<double>(average_.count()) +
         0.5 * off_rad * off_rad * Eigen::Matrix2d::Identity() + average_.alignment_rad2();
}

Eigen::Matrix2d MeanEstimator::least_squares_covariance_rad2() const {
  const Eigen::Matrix<double, 2, kModelErrors> shift = mean_->equations.model_shift();
  const Eigen::Matrix2d shown_rad2 =
      mean_->covariance_rad2 * excess_noise() + shift * verdict_.errors_rad2 * shift.transpose();
  return shown_rad2 + considered_rad2(considered_prior(noise_, config_.alignment));
}

Eigen::Matrix2d MeanEstimator::considered_rad2(const ConsideredPrior& prior) const {
  return covariance_of_moved(mean_->equations.considered_shift(), prior);
}

std::optional<AxisShift> MeanEstimator::shift_icrf() const {
  if (!by_least_squares_) {
    return std::nullopt;
  }
  return -tangent_basis(mean_->equations.axis_icrf()) *
         mean_->equations.considered_shift().rightCols<kSpinAlignmentErrors>() * alignment_root_;
}

/// Returns the excess noise of the residuals, or of the fixes where these differ and no model error
/// explains it.
double MeanEstimator::excess_noise() const {
  const double scatter = average_.excess_scatter();
  // Ratio of squares beyond which noise and model errors do not explain how far fixes differ.
  return scatter > 9.0 && verdict_.error_rad == 0.0 ? std::max(scatter, verdict_.excess_noise)
                                                    : verdict_.excess_noise;
}

/// Returns the mean square error of one fix, from stated covariances and scatter.
double MeanEstimator::fix_rad2() const {
  return average_.covariance_rad2().trace() * average_.excess_scatter() *
         static_cast<double>(average_.count());
}

/// Short chords are not linear; without them the remaining angles may leave the axis open.
bool MeanEstimator::less_informative_than_one_fix() const {
  return mean_->equations.covariance_rad2().trace() > fix_rad2();
}

double MeanEstimator::distance_from_average_rad() const {
  return angle_between_rad(mean_->equations.axis_icrf(), average_.axis_icrf());
}

/// Tests the distance of least squares and plain average. Besides noise that averages out, the
/// plain average may be off by the error of one fix.
bool MeanEstimator::agrees_with_average(const Eigen::Matrix2d& covariance_rad2) const {
  const double noise_rad2 =
      fix_rad2() / static_cast<double>(average_.count()) + covariance_rad2.trace();
  return !less_informative_than_one_fix() &&
         distance_from_average_rad() <
             std::sqrt(fix_rad2() + kContradictionSigmas * kContradictionSigmas * noise_rad2);
}

Eigen::Matrix2d MeanEstimator::covariance_if_moved_rad2() const {
  if (!by_least_squares_) {
    return average_.covariance_rad2() * static_cast<double>(average_.count());
  }
  const Eigen::Matrix2d noise_rad2 =
      mean_->covariance_rad2 + considered_rad2(considered_prior(noise_));
  return excess_noise() > 1.0 ? noise_rad2 : Eigen::Matrix2d{covariance_rad2_ - alignment_rad2_};
}

SpinEstimate MeanEstimator::estimate(const Revolution& revolution) const {
  const double rate_rad_s = kTurn_rad / revolution.period.period_s;
  return {.t = revolution.t_start,
          .estimator = SpinEstimator::Mean,
          .axis_icrf = mean_ ? axis_icrf() : *abandoned_axis_icrf_,
          .covariance_rad2 = mean_ ? covariance_rad2_ : anywhere_covariance_rad2(),
          .spin_rate_rad_s = rate_rad_s,
          .spin_rate_sigma_rad_s =
              rate_rad_s / revolution.period.period_s * period_sigma_s(revolution.period, noise_),
          .assessment = assess(),
          .alignment_rad2 = alignment_rad2_,
          .shift_icrf = shift_icrf()};
}

/// Returns empty if nothing but the residuals may speak against the mean.
std::optional<Reason> MeanEstimator::doubt() const {
  using enum ReasonCode;
  if (mean_->count < kFewestFixes) {
    return Reason{FewFixes, {{"needed", std::int64_t{kFewestFixes}}}};
  }
  if (less_informative_than_one_fix()) {
    return Reason{BeamsNearLimb};
  }
  if (!by_least_squares_) {
    return Reason{LeastSquaresOff, {{"deg", degrees(distance_from_average_rad())}}};
  }
  if (excess_noise() > verdict_.excess_noise) {
    return Reason{FixesScatter, {{"factor", std::sqrt(excess_noise())}}};
  }
  // Below this settled share the mean is that of a selection.
  if (mean_->settled_share < 0.5) {
    return Reason{FewSettled, {{"open_percent", 100.0 * (1.0 - mean_->settled_share)}}};
  }
  return std::nullopt;
}

Assessment MeanEstimator::assess() const {
  using enum ReasonCode;
  if (!mean_) {
    return {Quality::Lost, {{AwaitingFix}}};
  }
  Assessment assessment{unopposed_quality(static_cast<double>(mean_->count)),
                        {{Fixes, {{"count", static_cast<std::int64_t>(mean_->count)}}}}};
  if (auto doubted = doubt()) {
    assessment.quality = Quality::Doubtful;
    assessment.reasons.push_back(*std::move(doubted));
    return assessment;
  }
  const bool noisy = verdict_.excess_noise > 1.0;
  if (noisy || verdict_.beyond_allowance) {
    assessment.quality = Quality::Doubtful;
  }
  if (verdict_.error_rad > 0.0) {
    assessment.reasons.push_back(verdict_.reason());
  }
  if (noisy) {
    assessment.reasons.push_back({Noise, {{"factor", std::sqrt(verdict_.excess_noise)}}});
  }
  if (began_ && assessment.reasons.size() == 1) {
    assessment.reasons.push_back({Since, {{"since_tai_ns", tai_ns(*began_)}}});
  }
  return assessment;
}

}  // namespace spindrift
