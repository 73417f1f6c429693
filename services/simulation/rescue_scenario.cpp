#include <optional>
#include <string>
#include <vector>

#include "services/mission/mission_three_axis.h"
#include "services/mission/values.h"
#include "services/simulation/three_axis_scenario.h"

namespace spindrift {
namespace {

RescueControl rescue_control_of(const TomlValues& values, const ThreeAxisConfig& said) {
  RescueControl control{.commanded = said.nominal.value(),
                        .failure = std::nullopt,
                        .thrusters = {.torque_nm = number(values, "thrusters.torque_nm"),
                                      .shortest_s = number(values, "thrusters.shortest_s"),
                                      .longest_s = number(values, "thrusters.longest_s")},
                        .moments_kg_m2 = said.inertia->kg_m2.diagonal(),
                        .frequency_rad_s = number(values, "control.frequency_rad_s"),
                        .damping = number(values, "control.damping"),
                        .slew_rad_s = radians(values, "control.slew_deg_s"),
                        .period_s = number(values, "control.period_s")};
  if (const auto turns_rad_s = radians_vector_if(values, "rescue.turns_deg_s")) {
    control.failure =
        SensorFailure{.t_s = number(values, "rescue.fails_s"), .turns_rad_s = *turns_rad_s};
  }
  return control;
}

}  // namespace

void check_rescue_scenario(TomlDocument& document) {
  check_within_pass(document, "rescue.fails_s");
  check_sensors_on_board(document);
  check_body_step(document, "control.period_s");
}

RescueScenario rescue_scenario(const TomlValues& values, TaiTime start) {
  const ThreeAxisConfig said = three_axis_config(values);
  const ThreeAxisView view = three_axis_view(values, said, {});
  return {.view = view,
          .truth = {.body = body_truth(values, said, start),
                    .magnetometer = view.sensors.magnetometer.value(),
                    .control = rescue_control_of(values, said),
                    .filter = {.inertia_kg_m2 = said.inertia->kg_m2, .alignment = said.alignment}}};
}

}  // namespace spindrift
