#include "pipelines/spin/batch/pass_nutation.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <complex>

#include "pipelines/frames/angle.h"
#include "pipelines/frames/celestial.h"
#include "pipelines/statistics/median.h"
#include "pipelines/statistics/significance.h"
#include "pipelines/time/time_span.h"

namespace spindrift {
namespace {

// A stretch is a quarter of an hour at 100 rpm; nutation that grows by e within it is still found.
// The search takes 2 KiB of memory per edge.
constexpr std::size_t kStretchEdges = 10'000;

double phase_rad(const SpinState& state, double t_s) {
  return (state.rate_rad_s + 0.5 * state.drift_rad_s2 * t_s) * t_s;
}

NutationStretch stretch_of(std::span<const PassEdge> edges, const FoundNutation& found,
                           const PassModel& model, const SpinState& state) {
  NutationStretch stretch{.begin = edges.front().pulse.t,
                          .end = edges.back().pulse.t + std::chrono::nanoseconds{1},
                          .per_turn = found.per_turn,
                          .unknowns = {}};
  const double kappa = found.growth_per_s.value * stretch.half_s();
  const double x =
      (found.t_s - seconds_between(model.middle(), stretch.begin)) / stretch.half_s() - 1.0;
  const std::complex<double> g = std::polar(
      found.half_angle_rad.value * std::exp(-kappa * x),
      found.lean_azimuth_rad.value + kQuarter_rad - found.per_turn * phase_rad(state, found.t_s));
  stretch.unknowns << g.real(), g.imag(), kappa, 0.0;
  return stretch;
}

}  // namespace

double scatter_of(std::span<const UniformSpinResidual> residuals) {
  std::vector<double> sizes(residuals.size());
  std::transform(residuals.begin(), residuals.end(), sizes.begin(),
                 [](const UniformSpinResidual& residual) {
                   return std::abs(residual.off_rad) / residual.sigma_rad;
                 });
  return std::max(1.0, upper_median(sizes) / kMedianDeviation);
}

std::vector<UniformSpinResidual> uniform_spin_residuals(const PassModel& model,
                                                        std::span<const PassEdge> edges,
                                                        const SpinState& state) {
  const PassAtState at = model.at(state);
  std::vector<UniformSpinResidual> residuals;
  for (const PassEdge& edge : edges) {
    const auto met = at.meet(edge.pulse);
    if (met) {
      const double expected_rad = met->phase_rad - met->off_rad;
      residuals.push_back({.channel = edge.pulse.channel,
                           .t_s = seconds_between(model.middle(), edge.pulse.t),
                           .turns = expected_rad / kTurn_rad,
                           .off_rad = met->off_rad,
                           .sigma_rad = met->sigma_rad,
                           .expected = met->expected});
    }
  }
  // Nutation of 0.2 deg moves edges by ten sigmas.
  const double farthest = 30.0 * scatter_of(residuals);
  std::erase_if(residuals, [&](const UniformSpinResidual& residual) {
    return !(std::abs(residual.off_rad) < farthest * residual.sigma_rad);
  });
  return residuals;
}

PassNutation find_pass_nutation(const PassModel& model, std::span<const PassEdge> edges,
                                SpinState state) {
  state.nutation.clear();
  const std::size_t count = (edges.size() + kStretchEdges - 1) / kStretchEdges;
  PassNutation nutation;
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t first = i * edges.size() / count;
    const auto part = edges.subspan(first, (i + 1) * edges.size() / count - first);
    const auto search = find_nutation(uniform_spin_residuals(model, part, state));
    if (!search) {
      continue;
    }
    const bool found =
        search->found && search->false_alarm * static_cast<double>(count) < kFalseAlarm;
    if (found) {
      nutation.stretches.push_back(stretch_of(part, *search->found, model, state));
    }
    if (found || nutation.stretches.empty()) {
      nutation.last = *search;
    }
  }
  if (nutation.stretches.empty() && nutation.last) {
    nutation.last->found.reset();
  }
  return nutation;
}

FoundNutation as_fitted(const FoundNutation& found, const PassModel& model,
                        const SpinState& state) {
  const NutationStretch& stretch = state.nutation.back();
  const TaiTime t = later_by_s(model.middle(), found.t_s);
  const Eigen::Vector2d tilt_rad = tilt_at(stretch, t, phase_rad(state, found.t_s)).rotation_rad;
  const double rate_rad_s = state.rate_rad_s + state.drift_rad_s2 * found.t_s;
  FoundNutation fitted = found;
  fitted.half_angle_rad.value = tilt_rad.norm();
  fitted.growth_per_s.value = stretch.unknowns[2] / stretch.half_s();
  fitted.per_turn = stretch.per_turn + stretch.unknowns[3] / (stretch.half_s() * rate_rad_s);
  fitted.period_s.value = kTurn_rad / (rate_rad_s * fitted.per_turn);
  fitted.lean_azimuth_rad.value =
      wrapped_rad(std::atan2(tilt_rad.y(), tilt_rad.x()) - kQuarter_rad);
  return fitted;
}

PassInformation less_nutation(PassInformation information, const PassModel& model,
                              std::span<const PassEdge> edges, const SpinState& state) {
  const PassAtState at = model.at(state);
  const SpinAlignment& alignment = model.config().alignment;
  auto edge = edges.begin();
  for (const NutationStretch& stretch : state.nutation) {
    Eigen::Matrix4d own = Eigen::Matrix4d::Zero();
    Eigen::Matrix<double, kBatchUnknowns, kNutationUnknowns> shared =
        Eigen::Matrix<double, kBatchUnknowns, kNutationUnknowns>::Zero();
    Eigen::Matrix<double, kSpinAlignmentErrors, kNutationUnknowns> of_alignment =
        Eigen::Matrix<double, kSpinAlignmentErrors, kNutationUnknowns>::Zero();
    for (; edge != edges.end() && edge->pulse.t < stretch.end; ++edge) {
      const auto residual = at.residual(edge->pulse);
      if (residual && std::abs(residual->off) < kOutlierSigmas * residual->sigma(alignment)) {
        own += residual->nutation_slopes.transpose() * residual->nutation_slopes;
        shared += residual->slopes.transpose() * residual->nutation_slopes;
        of_alignment += residual->per_alignment.transpose() * residual->nutation_slopes;
      }
    }
    const auto solved = own.ldlt();
    information.information -= shared * solved.solve(shared.transpose());
    const auto of_nutation = solved.solve(of_alignment.transpose()).eval();
    information.considered.shared.rightCols<kSpinAlignmentErrors>() -= shared * of_nutation;
    information.considered.own.bottomRightCorner<kSpinAlignmentErrors, kSpinAlignmentErrors>() -=
        of_alignment * of_nutation;
  }
  return information;
}

}  // namespace spindrift
