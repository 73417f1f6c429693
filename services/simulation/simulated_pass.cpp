#include "services/simulation/simulated_pass.h"

#include <type_traits>
#include <utility>

#include "services/simulation/spin_pass.h"
#include "services/simulation/three_axis_pass.h"

namespace spindrift {
namespace {

Expected<SimulatedPass> with_on_board(const Scenario& scenario, SimulatedPass&& pass) {
  if (!scenario.carried_table) {
    return std::move(pass);
  }
  return on_board_pass(scenario, pass.telemetry, *pass.motion).map([&](OnBoardPass&& on_board) {
    pass.truth["on_board"] = to_json(on_board);
    pass.on_board = std::move(on_board);
    return std::move(pass);
  });
}

}  // namespace

Expected<SimulatedPass> simulated_pass(const Scenario& scenario, Progress progress) {
  const auto played = [&]<class Flight>(const Flight& flight) {
    if constexpr (std::is_same_v<Flight, SpinScenario>) {
      return played_pass(scenario, flight, progress);
    } else {
      return played_pass(scenario, flight);
    }
  };
  return std::visit(played, scenario.flight)
      .and_then([&](SimulatedPass&& pass) { return with_on_board(scenario, std::move(pass)); })
      .map_error([](Error&& error) {
        return Error{ErrorCode::InvalidConfiguration, std::move(error.message)};
      });
}

}  // namespace spindrift
