/// @file
/// Fixes of the star tracker as a kind of telemetry.

#pragma once

#include <fmt/format.h>

#include <string>
#include <string_view>
#include <tuple>

#include "pipelines/three_axis/samples.h"
#include "services/telemetry/plausible.h"
#include "services/telemetry/telemetry.h"

namespace spindrift {

template <>
struct Telemetry<StarFix> {
  static constexpr std::string_view kName = "star";
  static constexpr std::string_view kPlural = "star fixes";
  static constexpr const char* kTopic = "spindrift/star";
  static constexpr BusMessage kMessage = BusMessage::StarFix;
  static constexpr std::string_view kTable = "star_sample";
  static constexpr std::string_view kSensor = "three_axis.star_tracker";
  static constexpr std::tuple kColumns{
      Column{"qx", [](auto& fix) -> decltype(auto) { return fix.q_icrf_sensor.x(); }},
      Column{"qy", [](auto& fix) -> decltype(auto) { return fix.q_icrf_sensor.y(); }},
      Column{"qz", [](auto& fix) -> decltype(auto) { return fix.q_icrf_sensor.z(); }},
      Column{"qw", [](auto& fix) -> decltype(auto) { return fix.q_icrf_sensor.w(); }}};

  static std::string why_impossible(const StarFix& fix) {
    return is_unit(fix.q_icrf_sensor.coeffs())
               ? std::string{}
               : impossible("qx, qy, qz, qw", fix.q_icrf_sensor.coeffs(),
                            fmt::format("have length 1 within {}", kUnitTolerance));
  }
};

}  // namespace spindrift
