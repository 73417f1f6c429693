#include "services/scenario/simulated_pass.h"

#include <algorithm>
#include <vector>

#include "services/progress/progress_bar.h"

namespace spindrift {
namespace {

constexpr int kSlices = 200;

}  // namespace

Expected<SimulatedPass> simulated_pass(const Scenario& scenario) {
  SpinEdges source{scenario.truth, scenario.orbit};
  std::vector<TrueEdge> edges;
  ProgressBar progress{"simulating", kSlices};
  for (int slice = 1; slice <= kSlices; ++slice) {
    const auto more = source.until(scenario.duration_s * slice / kSlices);
    if (!more) {
      return Unexpected{{ErrorCode::InvalidConfiguration, more.error().message}};
    }
    edges.insert(edges.end(), more->begin(), more->end());
    progress.advance_to(static_cast<std::uint64_t>(slice));
  }
  return SimulatedPass{.received = receive(scenario.link, edges, scenario.truth.start,
                                           scenario.duration_s, source.revolutions()),
                       .revolutions = source.revolutions()};
}

std::int64_t count_of(Damage damage, const SimulatedPass& pass) {
  const auto& pulses = pass.received.pulses;
  return std::count_if(pulses.begin(), pulses.end(),
                       [damage](const ReceivedPulse& pulse) { return pulse.damage == damage; });
}

}  // namespace spindrift
