#include "pipelines/spin/batch/steady_residuals.h"

#include <cmath>
#include <numbers>

#include "pipelines/frames/celestial.h"

namespace spindrift {
namespace {

constexpr double kFarthestSigmas = 30.0;

}  // namespace

std::vector<SteadyResidual> steady_residuals(const PassModel& model,
                                             std::span<const PassEdge> edges,
                                             const SpinState& state) {
  std::vector<SteadyResidual> residuals;
  for (const PassEdge& edge : edges) {
    const auto met = model.meet(edge.pulse, state);
    if (met && std::abs(met->off_rad) < kFarthestSigmas * met->sigma_rad) {
      const double expected_rad = met->phase_rad - met->off_rad;
      residuals.push_back({.channel = edge.pulse.channel,
                           .t_s = seconds_between(model.middle(), edge.pulse.t),
                           .turns = expected_rad / (2.0 * std::numbers::pi),
                           .off_rad = met->off_rad,
                           .sigma_rad = met->sigma_rad,
                           .expected = met->expected});
    }
  }
  return residuals;
}

}  // namespace spindrift
