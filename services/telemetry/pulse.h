/// @file
/// Sensor edges as a kind of telemetry.

#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <tuple>

#include "pipelines/spin/types/pulse.h"
#include "services/telemetry/telemetry.h"

namespace spindrift {

template <>
struct Telemetry<Pulse> {
  static constexpr std::string_view kName = "pulses";
  static constexpr std::string_view kPlural = "edges";
  static constexpr const char* kTopic = "spindrift/pulse";
  static constexpr BusMessage kMessage = BusMessage::Pulse;
  static constexpr std::string_view kTable = "pulse";
  static constexpr std::string_view kSensor = "spin.sun_sensor";
  static constexpr std::tuple kColumns{
      Column{"channel", [](auto& pulse) -> decltype(auto) { return (pulse.channel); }}};

  static std::string why_impossible(const Pulse& /*pulse*/) { return {}; }
  static constexpr std::size_t place(const Pulse& pulse) { return index_of(pulse.channel); }
};

}  // namespace spindrift
