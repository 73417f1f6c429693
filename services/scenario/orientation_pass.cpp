#include "services/scenario/orientation_pass.h"

#include <utility>

#include "services/scenario/three_axis_pass.h"
#include "services/units/degrees.h"

namespace spindrift {
namespace {

using nlohmann::ordered_json;

ordered_json number_or_null(const std::optional<double>& number) {
  return number ? ordered_json(*number) : ordered_json(nullptr);
}

void add_outcome(const OrientationOutcome& outcome, ordered_json& truth) {
  truth["pointing_s"] = number_or_null(outcome.pointing_s);
  truth["settled_s"] = number_or_null(outcome.settled_s);
  truth["last_off_deg"] = kDegPerRad * outcome.last_off_rad;
  truth["wheel_nms_most"] = outcome.most_nms;
  truth["wheel_rpm_most"] = kRpmPerRad_s * outcome.most_rad_s;
}

}  // namespace

Expected<SimulatedPass> played_pass(const Scenario& scenario, const OrientationScenario& flight) {
  return flown(flight, scenario.orbit).and_then([&](FlownOrientation&& orientation) {
    return start_and_end(scenario, orientation.body.motion).map([&](ordered_json&& truth) {
      add_outcome(orientation.outcome, truth);
      SimulatedPass pass = three_axis_pass(flight.view.sensors, std::move(orientation.body),
                                           std::move(truth), scenario.mission_toml);
      pass.control = std::move(orientation.record);
      return pass;
    });
  });
}

}  // namespace spindrift
