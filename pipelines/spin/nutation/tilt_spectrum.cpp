#include "pipelines/spin/nutation/tilt_spectrum.h"

#include <cmath>
#include <complex>
#include <numbers>
#include <unsupported/Eigen/FFT>
#include <vector>

namespace spindrift {
namespace {

constexpr double kPointsPerTurn = 8.0;
// Points of the spectrum per resolved frequency, at least.
constexpr double kFineness = 2.0;
// Residual oscillations per stretch that parabolas leave of slow changes.
constexpr double kSlowest = 3.0;

using Points = std::vector<std::complex<double>>;

std::size_t power_of_two_from(double size) {
  std::size_t power = 1;
  while (static_cast<double>(power) < size) {
    power *= 2;
  }
  return power;
}

/// Divides each edge between the two grid points beside it.
Points spread(const TiltSignal& signal) {
  const double first = signal.turns().minCoeff();
  const double span = signal.turns().maxCoeff() - first;
  Points points(power_of_two_from(kFineness * kPointsPerTurn * (span + 1.0)));
  for (Eigen::Index i = 0; i < signal.edges(); ++i) {
    const double place = (signal.turns()[i] - first) * kPointsPerTurn;
    const double whole = std::floor(place);
    const auto point = static_cast<std::size_t>(whole);
    const std::complex<double> said = signal.off()[i] * signal.per_tilt()[i];
    points[point] += (1.0 - (place - whole)) * said;
    points[point + 1] += (place - whole) * said;
  }
  return points;
}

/// Corrects for the division between points, which weakens fast oscillations by (sin(a)/a)^2.
double strengthened(double power, double per_turn) {
  const double a = std::numbers::pi * per_turn / kPointsPerTurn;
  return power * std::pow(a / std::sin(a), 4);
}

}  // namespace

double unseen_per_turn(const TiltSignal& signal) { return kSlowest / signal.turns_in_stretch(); }

double strongest_per_turn(const TiltSignal& signal) {
  const Points points = spread(signal);
  Points spectrum;
  Eigen::FFT<double>{}.fwd(spectrum, points);
  const double step = kPointsPerTurn / static_cast<double>(points.size());
  const double unseen = unseen_per_turn(signal);
  double best_per_turn = 0.5;
  double best_power = 0.0;
  const auto end = static_cast<std::size_t>(kFastestPerTurn / step);
  for (std::size_t i = 1; i <= end; ++i) {
    const double per_turn = static_cast<double>(i) * step;
    const bool seen = std::abs(per_turn - std::round(per_turn)) > unseen;
    const double power = strengthened(std::norm(spectrum[i]), per_turn);
    if (seen && power > best_power) {
      best_power = power;
      best_per_turn = per_turn;
    }
  }
  return best_per_turn;
}

}  // namespace spindrift
