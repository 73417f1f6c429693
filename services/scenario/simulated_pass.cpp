#include "services/scenario/simulated_pass.h"

#include <type_traits>
#include <utility>

#include "services/scenario/orientation_pass.h"
#include "services/scenario/separation_pass.h"
#include "services/scenario/spin_pass.h"
#include "services/scenario/tumbling_pass.h"

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
