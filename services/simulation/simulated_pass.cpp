#include "services/simulation/simulated_pass.h"

#include <type_traits>
#include <utility>

#include "services/simulation/spin_pass.h"
#include "services/simulation/three_axis_pass.h"

namespace spindrift {

Expected<SimulatedPass> simulated_pass(const Scenario& scenario, Progress progress) {
  const auto played = [&]<class Flight>(const Flight& flight) {
    if constexpr (std::is_same_v<Flight, SpinScenario>) {
      return played_pass(scenario, flight, progress);
    } else {
      return played_pass(scenario, flight);
    }
  };
  return std::visit(played, scenario.flight).map_error([](Error&& error) {
    return Error{ErrorCode::InvalidConfiguration, std::move(error.message)};
  });
}

}  // namespace spindrift
