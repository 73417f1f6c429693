#include "services/simulation/tumbling_pass.h"

#include <utility>

#include "services/simulation/three_axis_pass.h"

namespace spindrift {

Expected<SimulatedPass> played_pass(const Scenario& scenario, const TumblingScenario& flight) {
  return flown(flight, scenario.orbit).and_then([&](FlownBody&& body) {
    return start_and_end(scenario, body.motion).map([&](nlohmann::ordered_json&& truth) {
      return three_axis_pass(flight.view.sensors, std::move(body), std::move(truth),
                             scenario.mission_toml);
    });
  });
}

}  // namespace spindrift
