#include "pipelines/spin/nutation/tilt_signal.h"

#include <Eigen/QR>
#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <iterator>
#include <numbers>
#include <numeric>
#include <tuple>
#include <unsupported/Eigen/FFT>

#include "pipelines/frames/angle.h"

namespace spindrift {
namespace {

using Edges = std::span<const UniformSpinResidual* const>;
using Points = std::vector<std::complex<double>>;
using Residuals = std::vector<const UniformSpinResidual*>;

constexpr int kSlowUnknowns = 4;

Residuals by_channel_and_time(std::span<const UniformSpinResidual> residuals) {
  Residuals sorted(residuals.size());
  std::transform(residuals.begin(), residuals.end(), sorted.begin(),
                 [](const UniformSpinResidual& residual) { return &residual; });
  std::sort(sorted.begin(), sorted.end(),
            [](const UniformSpinResidual* a, const UniformSpinResidual* b) {
              return std::tie(a->channel, a->t_s) < std::tie(b->channel, b->t_s);
            });
  return sorted;
}

/// Returns the stretches, each with one channel and one part of its time.
std::vector<Edges> stretches_of(const Residuals& sorted) {
  std::vector<Edges> stretches;
  for (auto first = sorted.begin(); first != sorted.end();) {
    const auto channel_end = std::find_if(
        first, sorted.end(),
        [&](const UniformSpinResidual* edge) { return edge->channel != (*first)->channel; });
    const double begin_s = (*first)->t_s;
    const double span_s = (*(channel_end - 1))->t_s - begin_s;
    // Within this time Sun and Earth move like a parabola, even on low orbits.
    const double count = std::max(1.0, std::ceil(span_s / 600.0));
    const auto number_of = [&](const UniformSpinResidual* edge) {
      return span_s > 0.0
                 ? std::min(count - 1.0, std::floor((edge->t_s - begin_s) / span_s * count))
                 : 0.0;
    };
    while (first != channel_end) {
      const double number = number_of(*first);
      const auto end = std::find_if(first, channel_end, [&](const UniformSpinResidual* edge) {
        return number_of(edge) != number;
      });
      const Edges stretch{first, end};
      // Fewer edges carry little beside their own parabola.
      if (stretch.size() >= 12) {
        stretches.push_back(stretch);
      }
      first = end;
    }
  }
  return stretches;
}

/// Returns an orthonormal basis of whitened parabolas and the effect of model errors. If that
/// effect resembles a parabola, an arbitrary direction takes its place.
Eigen::MatrixX4d parabolas(Edges stretch) {
  const double begin_s = stretch.front()->t_s;
  const double half_s = std::max(0.5 * (stretch.back()->t_s - begin_s), 1e-9);
  Eigen::MatrixX4d columns(stretch.size(), kSlowUnknowns);
  for (std::size_t i = 0; i < stretch.size(); ++i) {
    const double x = (stretch[i]->t_s - begin_s) / half_s - 1.0;
    columns.row(static_cast<Eigen::Index>(i)) =
        Eigen::RowVector4d{1.0, x, x * x, stretch[i]->expected.phase_per_error.sum()} /
        stretch[i]->sigma_rad;
  }
  const Eigen::HouseholderQR<Eigen::MatrixX4d> qr{columns};
  return qr.householderQ() * Eigen::MatrixX4d::Identity(columns.rows(), kSlowUnknowns);
}

constexpr double kPointsPerTurn = 8.0;

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
  // Points of the spectrum per resolved frequency, at least.
  Points points(power_of_two_from(2.0 * kPointsPerTurn * (span + 1.0)));
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

TiltSignal::TiltSignal(std::span<const UniformSpinResidual> residuals) {
  const Residuals sorted = by_channel_and_time(residuals);
  const std::vector<Edges> stretches = stretches_of(sorted);
  if (stretches.empty()) {
    return;
  }
  const auto edges =
      std::accumulate(stretches.begin(), stretches.end(), Eigen::Index{0},
                      [](Eigen::Index sum, Edges stretch) { return sum + std::ssize(stretch); });
  reserve(edges);
  Eigen::Index first = 0;
  for (const Edges stretch : stretches) {
    add_stretch(stretch, first);
    first += std::ssize(stretch);
  }
  count_from_the_middle(stretches);
  take_out_slow_changes(off_);
}

void TiltSignal::reserve(Eigen::Index edges) {
  turns_.resize(edges);
  off_.resize(edges);
  per_tilt_.resize(edges);
  slow_.resize(edges, kSlowUnknowns);
}

void TiltSignal::add_stretch(Edges stretch, Eigen::Index first) {
  const auto edges = static_cast<Eigen::Index>(stretch.size());
  for (Eigen::Index i = 0; i < edges; ++i) {
    const UniformSpinResidual& residual = *stretch[static_cast<std::size_t>(i)];
    const Eigen::Vector3d& per_rotation = residual.expected.phase_per_rotation;
    turns_[first + i] = residual.turns;
    off_[first + i] = residual.off_rad / residual.sigma_rad;
    per_tilt_[first + i] = std::complex{per_rotation.x(), per_rotation.y()} / residual.sigma_rad;
  }
  slow_.middleRows(first, edges) = parabolas(stretch);
  turns_in_stretch_ = std::max(turns_in_stretch_, stretch.back()->turns - stretch.front()->turns);
  stretches_.push_back({.channel = stretch.front()->channel, .first = first, .edges = edges});
}

void TiltSignal::count_from_the_middle(const std::vector<Edges>& stretches) {
  const double mean = turns_.mean();
  const UniformSpinResidual* first = stretches.front().front();
  const UniformSpinResidual* middle = first;
  const UniformSpinResidual* last = first;
  for (const Edges stretch : stretches) {
    for (const UniformSpinResidual* edge : stretch) {
      first = edge->turns < first->turns ? edge : first;
      last = edge->turns > last->turns ? edge : last;
      const bool nearer = std::abs(edge->turns - mean) < std::abs(middle->turns - mean);
      middle = nearer ? edge : middle;
    }
  }
  middle_s_ = middle->t_s;
  spin_period_s_ = (last->t_s - first->t_s) / (last->turns - first->turns);
  turns_.array() -= middle->turns;
}

double TiltSignal::freedom() const {
  return static_cast<double>(edges()) - kSlowUnknowns * static_cast<double>(stretches_.size());
}

Eigen::MatrixX2d TiltSignal::pattern(double per_turn) const {
  Eigen::MatrixX2d columns(edges(), 2);
  for (Eigen::Index i = 0; i < edges(); ++i) {
    const std::complex<double> q =
        per_tilt_[i] * std::polar(1.0, -kTurn_rad * per_turn * turns_[i]);
    columns.row(i) << q.real(), q.imag();
  }
  return columns;
}

void TiltSignal::take_out_slow_changes(Eigen::Ref<Eigen::MatrixXd> columns) const {
  for (const Stretch& stretch : stretches_) {
    const auto slow = slow_.middleRows(stretch.first, stretch.edges);
    auto rows = columns.middleRows(stretch.first, stretch.edges);
    const Eigen::MatrixXd parts = slow.transpose() * rows;
    rows -= slow * parts;
  }
}

void TiltSignal::weigh_by(const Eigen::VectorXd& rest) {
  std::array<double, kPulseChannels> squares{};
  std::array<double, kPulseChannels> freedom{};
  for (const Stretch& stretch : stretches_) {
    const std::size_t channel = index_of(stretch.channel);
    squares.at(channel) += rest.segment(stretch.first, stretch.edges).squaredNorm();
    freedom.at(channel) += static_cast<double>(stretch.edges - kSlowUnknowns);
  }
  for (const Stretch& stretch : stretches_) {
    const std::size_t channel = index_of(stretch.channel);
    // Residuals without noise still get a finite weight.
    const double scatter = std::max(std::sqrt(squares.at(channel) / freedom.at(channel)), 1e-3);
    off_.segment(stretch.first, stretch.edges) /= scatter;
    per_tilt_.segment(stretch.first, stretch.edges) /= scatter;
  }
}

/// Parabolas leave slow changes of up to three oscillations per stretch.
double unseen_per_turn(const TiltSignal& signal) { return 3.0 / signal.turns_in_stretch(); }

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
