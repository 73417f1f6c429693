/// @file
/// Directions of the Sun in body axes as a kind of telemetry.

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
struct Telemetry<SunDirection> {
  static constexpr std::string_view kName = "sun";
  static constexpr std::string_view kPlural = "sun vectors";
  static constexpr const char* kTopic = "spindrift/sun";
  static constexpr BusMessage kMessage = BusMessage::VectorSample;
  static constexpr std::string_view kTable = "sun_sample";
  static constexpr std::string_view kSensor = "three_axis.sun_sensor";
  static constexpr std::tuple kColumns{
      Column{"sx", [](auto& sample) -> decltype(auto) { return sample.sun_body.x(); }},
      Column{"sy", [](auto& sample) -> decltype(auto) { return sample.sun_body.y(); }},
      Column{"sz", [](auto& sample) -> decltype(auto) { return sample.sun_body.z(); }}};

  static std::string why_impossible(const SunDirection& sample) {
    return is_unit(sample.sun_body)
               ? std::string{}
               : impossible("sx, sy, sz", sample.sun_body,
                            fmt::format("have length 1 within {}", kUnitTolerance));
  }
};

}  // namespace spindrift
