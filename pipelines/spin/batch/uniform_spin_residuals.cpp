#include "pipelines/spin/batch/uniform_spin_residuals.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "pipelines/frames/angle.h"
#include "pipelines/statistics/significance.h"

namespace spindrift {
namespace {

// Nutation of 0.2 deg moves edges by ten sigmas.
constexpr double kFarthestSigmas = 30.0;
}  // namespace

double scatter_of(std::span<const UniformSpinResidual> residuals) {
  std::vector<double> sizes(residuals.size());
  std::transform(residuals.begin(), residuals.end(), sizes.begin(),
                 [](const UniformSpinResidual& residual) {
                   return std::abs(residual.off_rad) / residual.sigma_rad;
                 });
  const auto middle = sizes.begin() + std::ssize(sizes) / 2;
  std::nth_element(sizes.begin(), middle, sizes.end());
  return middle == sizes.end() ? 1.0 : std::max(1.0, *middle / kMedianDeviation);
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
  const double farthest = kFarthestSigmas * scatter_of(residuals);
  std::erase_if(residuals, [&](const UniformSpinResidual& residual) {
    return !(std::abs(residual.off_rad) < farthest * residual.sigma_rad);
  });
  return residuals;
}

}  // namespace spindrift
