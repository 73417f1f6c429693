#include "services/simulation/separation_pass.h"

#include <fmt/format.h>

#include <array>
#include <utility>

#include "pipelines/frames/angle.h"
#include "services/simulation/three_axis_pass.h"

namespace spindrift {
namespace {

/// Returns T1 to T4, in seconds since the start.
std::array<double, 4> events_s(const SeparationScenario& flight) {
  return {0.0, flight.truth.control_on_s, flight.truth.acquisition_s, flight.first_star_fix_s};
}

Expected<nlohmann::ordered_json> truth_of(const Scenario& scenario,
                                          const SeparationScenario& flight,
                                          const BodyMotion& motion) {
  nlohmann::ordered_json truth;
  int number = 1;
  for (const double t_s : events_s(flight)) {
    auto event = true_state(scenario, motion, t_s);
    if (!event) {
      return Unexpected{std::move(event.error())};
    }
    truth[fmt::format("T{}", number++)] = std::move(*event);
  }
  return truth;
}

std::string reconstruction_text(const Scenario& scenario, const SeparationScenario& flight,
                                const std::optional<Euler312>& told) {
  std::string text = "\n[reconstruction]\n";
  if (!disturbs(flight.truth.body.disturbances)) {
    text += "disturbance_deg_s2 = 0\n";
  }
  int number = 1;
  for (const double t_s : events_s(flight)) {
    text += fmt::format("t{}_tai_ns = {}\n", number++, tai_ns(shifted(scenario.start, t_s)));
  }
  if (told) {
    text +=
        fmt::format("\n[reconstruction.launcher]\neuler312_deg = [{}, {}, {}]\nsigma_deg = {}\n",
                    told->phi_rad * kDegPerRad, told->theta_rad * kDegPerRad,
                    told->psi_rad * kDegPerRad, flight.launcher->sigma_rad * kDegPerRad);
  }
  return text;
}

}  // namespace

Expected<SimulatedPass> played_pass(const Scenario& scenario, const SeparationScenario& flight) {
  return flown(flight, scenario.orbit).and_then([&](FlownSeparation&& separation) {
    return truth_of(scenario, flight, separation.body.motion)
        .map([&](nlohmann::ordered_json&& truth) {
          return three_axis_pass(
              flight.view.sensors, std::move(separation.body), std::move(truth),
              scenario.mission_toml + reconstruction_text(scenario, flight, separation.told));
        });
  });
}

}  // namespace spindrift
