#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "pipelines/frames/angle.h"
#include "services/mission/mission_three_axis.h"
#include "services/mission/values.h"
#include "services/simulation/three_axis_scenario.h"

namespace spindrift {
namespace {

SeparationTruth truth_of(const TomlValues& values, const ThreeAxisConfig& said, TaiTime start) {
  return {.body = body_truth(values, said, start),
          .control = {.thrusters = {.torque_nm = number(values, "control.torque_nm"),
                                    .shortest_s = number(values, "control.shortest_pulse_s"),
                                    .longest_s = number(values, "control.longest_pulse_s")},
                      .dead_band_rad_s = radians(values, "control.dead_band_deg_s"),
                      .slew_rad_s = radians(values, "control.slew_deg_s"),
                      .period_s = number(values, "control.period_s")},
          .control_on_s = number(values, "separation.control_on_s"),
          .acquisition_s = number(values, "separation.acquisition_s")};
}

std::optional<LauncherTelling> launcher_of(const TomlValues& values) {
  const auto sigma_rad = radians_if(values, "separation.launcher.sigma_deg");
  return sigma_rad ? std::optional{LauncherTelling{
                         .sigma_rad = *sigma_rad,
                         .off_rad = radians_vector_if(values, "separation.launcher.off_deg")}}
                   : std::nullopt;
}

/// Refuses relays so strong that the body would oscillate between the ends of the dead band.
void check_relays(TomlDocument& document) {
  const auto torque_nm = value_if<double>(document.values, "control.torque_nm");
  const auto dead_band_deg_s = value_if<double>(document.values, "control.dead_band_deg_s");
  const auto period_s = value_if<double>(document.values, "control.period_s");
  const auto longest_s = value_if<double>(document.values, "control.longest_pulse_s");
  const auto kg_m2 = value_if<std::vector<double>>(document.values, "three_axis.inertia.kg_m2");
  const auto factor = value_if<double>(document.values, "truth.inertia.factor");
  if (!torque_nm || !dead_band_deg_s || !period_s || !longest_s || !kg_m2 || !factor) {
    return;
  }
  const double on_s = std::min(*period_s, *longest_s);
  const auto body = RigidBody::make(*factor * Eigen::Map<const Eigen::Matrix3d>{kg_m2->data()});
  if (!body) {
    return;
  }
  const double change_deg_s =
      body->acceleration_rad_s2(Eigen::Vector3d::Zero(), Eigen::Vector3d::Constant(*torque_nm),
                                Eigen::Vector3d::Zero())
          .cwiseAbs()
          .maxCoeff() *
      on_s * kDegPerRad;
  if (!(change_deg_s <= *dead_band_deg_s)) {
    add_problem(
        document, "control.torque_nm",
        fmt::format("control.torque_nm = {}: changes the rate by {:.3g} deg/s in {} s: must "
                    "not change it by more than control.dead_band_deg_s = {}",
                    *torque_nm, change_deg_s, on_s, *dead_band_deg_s));
  }
}

}  // namespace

void check_separation_scenario(TomlDocument& document) {
  check_within_pass(document, "separation.first_star_fix_s");
  check_sensors_on_board(document);
  check_body_step(document, "control.period_s");
  check_relays(document);
}

SeparationScenario separation_scenario(const TomlValues& values, TaiTime start) {
  const ThreeAxisConfig said = three_axis_config(values);
  const SeparationTruth truth = truth_of(values, said, start);
  const double first_star_fix_s = number(values, "separation.first_star_fix_s");
  return {.view = three_axis_view(values, said,
                                  {.gyro_s = truth.control_on_s,
                                   .sun_s = truth.acquisition_s,
                                   .star_s = first_star_fix_s,
                                   .magnetometer_s = truth.control_on_s}),
          .truth = truth,
          .first_star_fix_s = first_star_fix_s,
          .launcher = launcher_of(values)};
}

}  // namespace spindrift
