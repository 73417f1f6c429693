/// @file
/// The magnetic field in body axes as a kind of telemetry.

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
struct Telemetry<MagneticField> {
  static constexpr std::string_view kName = "magnetometer";
  static constexpr std::string_view kPlural = "magnetometer samples";
  static constexpr const char* kTopic = "spindrift/magnetometer";
  static constexpr BusMessage kMessage = BusMessage::VectorSample;
  static constexpr std::string_view kTable = "magnetometer_sample";
  static constexpr std::string_view kSensor = "three_axis.magnetometer";
  static constexpr std::tuple kColumns{
      Column{"bx_nt", [](auto& sample) -> decltype(auto) { return sample.field_body_nt.x(); }},
      Column{"by_nt", [](auto& sample) -> decltype(auto) { return sample.field_body_nt.y(); }},
      Column{"bz_nt", [](auto& sample) -> decltype(auto) { return sample.field_body_nt.z(); }}};

  /// At the Earth's surface the field is below 70,000 nT.
  static constexpr double kStrongest_nt = 100'000.0;

  static std::string why_impossible(const MagneticField& sample) {
    return is_at_most(sample.field_body_nt, kStrongest_nt) && sample.field_body_nt.norm() > 0.0
               ? std::string{}
               : impossible("bx_nt, by_nt, bz_nt", sample.field_body_nt,
                            fmt::format("be above 0, at most {} nT together", kStrongest_nt));
  }
};

}  // namespace spindrift
