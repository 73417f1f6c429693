#include "services/simulation/orientation_pass.h"

#include <array>
#include <cmath>
#include <utility>

#include "pipelines/frames/angle.h"
#include "pipelines/ground_model/flights/channel_margins.h"
#include "services/simulation/three_axis_pass.h"

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

/// Adds the margins of the loops as flown, about X, Y and Z.
Expected<void> add_margins(const OrientationTruth& flight, ordered_json& truth) {
  return channel_margins(flight).map([&](const std::array<ChannelMargins, 3>& channels) {
    for (const ChannelMargins& channel : channels) {
      const LoopMargins& margins = channel.flown_margins;
      truth["phase_margin_deg"].push_back(kDegPerRad * margins.phase_rad);
      truth["gain_margin_db"].push_back(20.0 * std::log10(*margins.gain));
      truth["crossover_rad_s"].push_back(margins.crossover_rad_s);
    }
  });
}

}  // namespace

Expected<SimulatedPass> played_pass(const Scenario& scenario, const OrientationScenario& flight) {
  return flown(flight, scenario.orbit).and_then([&](FlownOrientation&& orientation) {
    auto truth = start_and_end(scenario, orientation.body.motion);
    if (!truth) {
      return Expected<SimulatedPass>{Unexpected{std::move(truth.error())}};
    }
    add_outcome(orientation.outcome, *truth);
    return add_margins(flight.truth, *truth).map([&] {
      SimulatedPass pass = three_axis_pass(flight.view.sensors, std::move(orientation.body),
                                           *std::move(truth), scenario.mission_toml);
      pass.control = std::move(orientation.record);
      return pass;
    });
  });
}

}  // namespace spindrift
