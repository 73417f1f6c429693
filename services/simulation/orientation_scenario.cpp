#include <fmt/format.h>

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "pipelines/frames/angle.h"
#include "pipelines/ground_model/flights/channel_margins.h"
#include "services/mission/mission_three_axis.h"
#include "services/mission/values.h"
#include "services/simulation/three_axis_scenario.h"

namespace spindrift {
namespace {

/// Returns the spin axes of the wheels; the body axes where none is given.
std::vector<Eigen::Vector3d> wheel_axes(const TomlValues& values) {
  std::vector<Eigen::Vector3d> axes;
  while (const auto axis = vector_if(values, fmt::format("wheels.axis[{}].body", axes.size()))) {
    axes.push_back(*axis);
  }
  if (axes.empty()) {
    axes = {Eigen::Vector3d::UnitX(), Eigen::Vector3d::UnitY(), Eigen::Vector3d::UnitZ()};
  }
  return axes;
}

WheelDesign wheels_of(const TomlValues& values, const std::vector<Eigen::Vector3d>& axes) {
  const double speed_rad_s = number(values, "wheels.speed_rpm_most") / kRpmPerRad_s;
  WheelDesign design{.axes_body = WheelAxes{3, static_cast<Eigen::Index>(axes.size())},
                     .inertia_kg_m2 = number(values, "wheels.momentum_nms_most") / speed_rad_s,
                     .torque_nm_most = number(values, "wheels.torque_nm_most"),
                     .speed_rad_s_most = speed_rad_s};
  for (std::size_t i = 0; i < axes.size(); ++i) {
    design.axes_body.col(static_cast<Eigen::Index>(i)) = axes[i];
  }
  return design;
}

std::optional<GyroPropagation> by_gyro(const TomlValues& values) {
  const auto by = value_of<std::string>(values, "control.attitude_by");
  if (by == "truth") {
    return std::nullopt;
  }
  return by == "composition" ? GyroPropagation::Composition : GyroPropagation::RungeKutta;
}

OrientationControl control_of(const TomlValues& values, const ThreeAxisConfig& said) {
  const auto q = value_of<std::vector<double>>(values, "orientation.q_start_target");
  return {.plan = {.control_on_s = number(values, "orientation.control_on_s"),
                   .damped_rad_s = radians(values, "orientation.damped_deg_s"),
                   .pointing_at_s = number(values, "orientation.pointing_at_s")},
          .q_start_target = Eigen::Quaterniond{q.data()}.normalized(),
          .wheels = wheels_of(values, wheel_axes(values)),
          .moments_kg_m2 = said.inertia->kg_m2.diagonal(),
          .frequency_rad_s = number(values, "control.frequency_rad_s"),
          .damping = number(values, "control.damping"),
          .slew_rad_s = radians(values, "control.slew_deg_s"),
          .variable_limit = value_of<std::string>(values, "control.law") == "variable_limit",
          .period_s = number(values, "control.period_s"),
          .periods_late = static_cast<int>(value_of<std::int64_t>(values, "control.periods_late")),
          .by_gyro = by_gyro(values)};
}

void check_wheels(TomlDocument& document) {
  const TomlValues& values = document.values;
  for (const char* const key :
       {"wheels.momentum_nms_most", "wheels.speed_rpm_most", "wheels.torque_nm_most"}) {
    if (!values.contains(key)) {
      return;
    }
  }
  const std::vector<Eigen::Vector3d> axes = wheel_axes(values);
  if (axes.size() > static_cast<std::size_t>(kMostWheels)) {
    add_problem(
        document, "wheels.axis",
        fmt::format("[[wheels.axis]]: {} wheels: must be {} at most", axes.size(), kMostWheels));
  } else if (const auto wheels = Wheels::make(wheels_of(values, axes)); !wheels) {
    add_problem(document, "wheels.axis",
                fmt::format("[[wheels.axis]]: {}", wheels.error().message));
  }
}

/// Checks the control loop once the scenario has no other problem.
void check_loop(TomlDocument& document) {
  if (!document.problems.empty()) {
    return;
  }
  const OrientationTruth truth = orientation_scenario(document.values, TaiTime{}).truth;
  if (const auto stable = check_margins(truth); !stable) {
    add_problem(document, "control.period_s",
                fmt::format("control.period_s = {}, periods_late = {}: {}", truth.control.period_s,
                            truth.control.periods_late, stable.error().message));
  }
}

void check_gyro(TomlDocument& document) {
  const auto by = value_if<std::string>(document.values, "control.attitude_by");
  if (by && *by != "truth" && !document.table.at_path("three_axis.gyro")) {
    add_problem(document, "control.attitude_by",
                fmt::format("control.attitude_by = \"{}\": there is no [three_axis.gyro]: must be "
                            "\"truth\"",
                            *by));
  }
}

}  // namespace

void check_orientation_scenario(TomlDocument& document) {
  for (const char* const key : {"first_star_fix_s", "control_on_s", "pointing_at_s"}) {
    check_within_pass(document, fmt::format("orientation.{}", key));
  }
  check_sensors_on_board(document);
  check_wheels(document);
  check_body_step(document, "control.period_s");
  check_gyro(document);
  check_loop(document);
}

OrientationScenario orientation_scenario(const TomlValues& values, TaiTime start) {
  const ThreeAxisConfig said = three_axis_config(values);
  return {.view = three_axis_view(values, said,
                                  {.star_s = number(values, "orientation.first_star_fix_s")}),
          .truth = {.body = body_truth(values, said, start), .control = control_of(values, said)}};
}

}  // namespace spindrift
