#include "pipelines/spin/nutation/nutation.h"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

#include "pipelines/frames/angle.h"
#include "pipelines/frames/celestial.h"
#include "pipelines/spin/nutation/tilt_signal.h"
#include "pipelines/statistics/significance.h"

namespace spindrift {
namespace {

constexpr double kFewestTurns = 20.0;
// Limits the spectrum's memory to 2 GiB.
constexpr double kMostTurns = 4e6;

/// Returns the span as twice the largest distance from the middle.
double span_turns(const TiltSignal& signal) { return 2.0 * signal.turns().cwiseAbs().maxCoeff(); }

/// Holds a rotating tilt g (1 + growth x / half a span).
struct Fit {
  double per_turn;
  Eigen::Vector4d tilt;  ///< Real and imaginary part of g, then of g times the growth.
  Eigen::Matrix4d covariance;
  Eigen::VectorXd rest;

  std::complex<double> g() const { return {tilt[0], tilt[1]}; }
  /// Relative growth over half a span; its imaginary part is the phase advance in radians.
  std::complex<double> growth() const { return std::complex{tilt[2], tilt[3]} / g(); }
};

Fit fitted(const TiltSignal& signal, double per_turn) {
  Eigen::MatrixX4d columns(signal.edges(), 4);
  columns.leftCols<2>() = signal.pattern(per_turn);
  const Eigen::VectorXd place = signal.turns() / (0.5 * span_turns(signal));
  columns.rightCols<2>() = place.asDiagonal() * columns.leftCols<2>();
  signal.take_out_slow_changes(columns);
  const auto normal = (columns.transpose() * columns).eval().ldlt();
  const Eigen::Vector4d tilt = normal.solve(columns.transpose() * signal.off());
  return {.per_turn = per_turn,
          .tilt = tilt,
          .covariance = normal.solve(Eigen::Matrix4d::Identity()),
          .rest = signal.off() - columns * tilt};
}

/// Climbs to the top of the spectral line that contains `per_turn`.
Fit climbed(const TiltSignal& signal, double per_turn) {
  Fit fit = fitted(signal, per_turn);
  const double line = 1.0 / span_turns(signal);
  for (int step = 0; step < 8; ++step) {
    const double lines = 2.0 * fit.growth().imag() / kTurn_rad;
    // The negated comparison also ends the loop for NaN, which a zero tilt gives.
    // Convergence limit in spectral lines; a line is one cycle wide over the pass.
    if (!(std::abs(lines) > 1e-6)) {
      break;
    }
    fit = fitted(signal, fit.per_turn + std::clamp(lines, -0.5, 0.5) * line);
  }
  return fit;
}

/// Returns the chi-square that a tilt with this frequency explains.
double chi_square(const TiltSignal& signal, double per_turn) {
  Eigen::MatrixX2d columns = signal.pattern(per_turn);
  const double whole = columns.squaredNorm();
  signal.take_out_slow_changes(columns);
  const Eigen::Vector2d right = columns.transpose() * signal.off();
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> normal;
  normal.computeDirect(columns.transpose() * columns);
  // Minimum share of a pattern that must remain without its slow changes.
  return normal.eigenvalues()[0] > 1e-6 * whole ? (normal.eigenvectors().transpose() * right)
                                                      .cwiseAbs2()
                                                      .cwiseQuotient(normal.eigenvalues())
                                                      .sum()
                                                : 0.0;
}

/// Returns the aliases for a sensor that looks once a turn, at least a line away from `per_turn`.
std::vector<double> aliases_of(double per_turn, double line) {
  std::vector<double> aliases;
  for (const double sense : {1.0, -1.0}) {
    for (double whole = -kFastestPerTurn; whole <= 2.0 * kFastestPerTurn; whole += 1.0) {
      const double alias = whole + sense * per_turn;
      if (alias > 0.0 && alias <= kFastestPerTurn && std::abs(alias - per_turn) > line) {
        aliases.push_back(alias);
      }
    }
  }
  return aliases;
}

struct Choice {
  double per_turn;
  double chi_square;
  std::vector<double> others;  ///< Others that explain the residuals nearly as well.
};

Choice likeliest(const TiltSignal& signal, double per_turn) {
  std::vector<Choice> choices = {
      {.per_turn = per_turn, .chi_square = chi_square(signal, per_turn), .others = {}}};
  for (const double alias : aliases_of(per_turn, 1.0 / span_turns(signal))) {
    choices.push_back({.per_turn = alias, .chi_square = chi_square(signal, alias), .others = {}});
  }
  Choice best = *std::max_element(
      choices.begin(), choices.end(),
      [](const Choice& a, const Choice& b) { return a.chi_square < b.chi_square; });
  for (const Choice& choice : choices) {
    // Chi-square difference of a likelihood ratio of a thousand.
    if (choice.per_turn != best.per_turn && choice.chi_square > best.chi_square - 13.8) {
      best.others.push_back(choice.per_turn);
    }
  }
  return best;
}

/// Returns W of the false-alarm formula.
double width_of(const TiltSignal& signal) {
  const double variance = (signal.turns().array() - signal.turns().mean()).square().mean();
  return kFastestPerTurn * std::sqrt(4.0 * std::numbers::pi * variance);
}

/// The bound holds beyond its maximum, which is at z = 1/2.
double false_alarm_of(double width, double chi_square) {
  const double z = std::max(0.5, 0.5 * chi_square);
  return std::min(1.0, width * std::sqrt(z) * std::exp(-z));
}

/// Returns the z that noise exceeds with the probability kFalseAlarm.
double threshold_of(double width) {
  constexpr int kSteps = 20;
  double z = 10.0;
  for (int step = 0; step < kSteps; ++step) {
    z = std::log(width * std::sqrt(z) / kFalseAlarm);
  }
  return z;
}

double detectable_rad(const TiltSignal& signal, double threshold) {
  const double seen = signal.freedom() / static_cast<double>(signal.edges());
  const double information = 0.5 * seen * signal.per_tilt().squaredNorm();
  return (std::sqrt(2.0 * threshold) + kDetectionSigmas) / std::sqrt(information);
}

FoundNutation nutation_of(const TiltSignal& signal, const Fit& fit,
                          const std::vector<double>& others) {
  const double period_s = signal.spin_period_s();
  const double half_span_turns = 0.5 * span_turns(signal);
  const double half_angle_rad = std::abs(fit.g());
  const std::complex<double> along = fit.g() / half_angle_rad;
  const auto sigma = [&](Eigen::Index first, const std::complex<double>& direction) {
    const Eigen::Vector2d d{direction.real(), direction.imag()};
    return std::sqrt(d.dot(fit.covariance.block<2, 2>(first, first) * d));
  };
  const std::complex<double> across = along * std::complex{0.0, 1.0};
  const double per_turn_sigma = sigma(2, across) / (half_angle_rad * half_span_turns * kTurn_rad);
  const double half_span_s = half_span_turns * period_s;
  FoundNutation found = {
      .t_s = signal.middle_s(),
      .half_angle_rad = {.value = half_angle_rad, .sigma = sigma(0, along)},
      .growth_per_s = {.value = fit.growth().real() / half_span_s,
                       .sigma = sigma(2, along) / (half_angle_rad * half_span_s)},
      .period_s = {.value = period_s / fit.per_turn,
                   .sigma = period_s / fit.per_turn * per_turn_sigma / fit.per_turn},
      .lean_azimuth_rad = {.value = wrapped_rad(std::arg(fit.g()) - 0.25 * kTurn_rad),
                           .sigma = sigma(0, across) / half_angle_rad},
      .per_turn = fit.per_turn,
      .other_periods_s = {}};
  for (const double per_turn : others) {
    found.other_periods_s.push_back(period_s / per_turn);
  }
  return found;
}

Expected<void> check_numbers(std::span<const UniformSpinResidual> residuals) {
  const auto sound = [](const UniformSpinResidual& residual) {
    const auto& slopes = residual.expected.phase_per_rotation;
    return residual.sigma_rad > 0.0 && std::isfinite(residual.sigma_rad) &&
           std::isfinite(residual.off_rad) && std::isfinite(residual.t_s) &&
           std::isfinite(residual.turns) && slopes.allFinite();
  };
  const auto bad = std::find_if_not(residuals.begin(), residuals.end(), sound);
  if (bad == residuals.end()) {
    return {};
  }
  return Unexpected{
      {ErrorCode::InvalidInput,
       fmt::format("residual of {} at {} s, {} turns: {} rad with sigma {} rad: all must be "
                   "finite, sigma above 0",
                   name_of(bad->channel), bad->t_s, bad->turns, bad->off_rad, bad->sigma_rad)}};
}

Expected<void> check_extent(const TiltSignal& signal) {
  if (!(signal.turns_in_stretch() >= kFewestTurns && signal.per_tilt().squaredNorm() > 0.0)) {
    return Unexpected{
        {ErrorCode::Unobservable,
         fmt::format("nutation: {} edges, at most {:.1f} turns of one channel, tilt by 1 rad moves "
                     "them by {:.3g} sigmas: must be {} turns at least, and move",
                     signal.edges(), signal.turns_in_stretch(), signal.per_tilt().norm(),
                     kFewestTurns)}};
  }
  if (!(span_turns(signal) <= kMostTurns)) {
    return Unexpected{{ErrorCode::Unobservable,
                       fmt::format("nutation: {:.0f} turns: must be {} at most; give a part of the "
                                   "pass",
                                   span_turns(signal), kMostTurns)}};
  }
  return {};
}

}  // namespace

Expected<NutationSearch> find_nutation(std::span<const UniformSpinResidual> residuals) {
  if (auto sound = check_numbers(residuals); !sound) {
    return Unexpected{std::move(sound.error())};
  }
  TiltSignal signal{residuals};
  if (auto enough = check_extent(signal); !enough) {
    return Unexpected{std::move(enough.error())};
  }
  const Fit first = climbed(signal, strongest_per_turn(signal));
  signal.weigh_by(first.rest);
  const Choice choice = likeliest(signal, first.per_turn);
  const double width = width_of(signal);
  const double threshold = threshold_of(width);
  NutationSearch search = {.found = std::nullopt,
                           .false_alarm = false_alarm_of(width, choice.chi_square),
                           .detectable_rad = detectable_rad(signal, threshold)};
  if (0.5 * choice.chi_square > threshold) {
    search.found = nutation_of(signal, climbed(signal, choice.per_turn), choice.others);
  }
  return search;
}

}  // namespace spindrift
