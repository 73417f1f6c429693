/// @file
/// Position and velocity as a kind of telemetry.

#pragma once

#include <string>
#include <string_view>
#include <tuple>

#include "pipelines/ephemeris/orbit_state.h"
#include "services/telemetry/plausible.h"
#include "services/telemetry/telemetry.h"

namespace spindrift {

template <>
struct Telemetry<TimedOrbitState> {
  static constexpr std::string_view kName = "orbit state";
  static constexpr std::string_view kPlural = "orbit states";
  static constexpr const char* kTopic = "spindrift/orbit_state";
  static constexpr BusMessage kMessage = BusMessage::OrbitState;
  static constexpr std::string_view kTable = "orbit_state_sample";
  static constexpr std::string_view kSensor{};
  static constexpr std::tuple kColumns{
      Column{"x_km",
             [](auto& sample) -> decltype(auto) { return sample.state.position_icrf_km.x(); }},
      Column{"y_km",
             [](auto& sample) -> decltype(auto) { return sample.state.position_icrf_km.y(); }},
      Column{"z_km",
             [](auto& sample) -> decltype(auto) { return sample.state.position_icrf_km.z(); }},
      Column{"vx_km_s",
             [](auto& sample) -> decltype(auto) { return sample.state.velocity_icrf_km_s.x(); }},
      Column{"vy_km_s",
             [](auto& sample) -> decltype(auto) { return sample.state.velocity_icrf_km_s.y(); }},
      Column{"vz_km_s",
             [](auto& sample) -> decltype(auto) { return sample.state.velocity_icrf_km_s.z(); }}};

  /// From below the polar radius of 6357 km to the limit for orbits in the mission file.
  static constexpr double kNearest_km = 6300.0;
  static constexpr double kFarthest_km = 2.0e6;
  /// A body that stays near the Earth is slower.
  static constexpr double kFastest_km_s = 20.0;
  static constexpr double kSlowest_km_s = 0.1;  ///< At the apogee of the highest orbits.

  static std::string why_impossible(const TimedOrbitState& sample) {
    const auto& [position_km, velocity_km_s] = sample.state;
    if (!is_between(position_km, kNearest_km, kFarthest_km)) {
      return impossible("x_km, y_km, z_km", position_km,
                        "be 6300 to 2000000 km from the centre of the Earth") +
             likely_unit(is_between(1e-3 * position_km, kNearest_km, kFarthest_km), "m");
    }
    if (!(is_at_most(velocity_km_s, kFastest_km_s) && velocity_km_s.norm() > 0.0)) {
      return impossible("vx_km_s, vy_km_s, vz_km_s", velocity_km_s, "be above 0, at most 20 km/s") +
             likely_unit(is_between(1e-3 * velocity_km_s, kSlowest_km_s, kFastest_km_s), "m/s");
    }
    return {};
  }
};

}  // namespace spindrift
