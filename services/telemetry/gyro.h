/// @file
/// Rates of the gyro triad as a kind of telemetry.

#pragma once

#include <string>
#include <string_view>
#include <tuple>

#include "pipelines/three_axis/samples.h"
#include "services/base/degrees.h"
#include "services/telemetry/plausible.h"
#include "services/telemetry/telemetry.h"

namespace spindrift {

template <>
struct Telemetry<GyroSample> {
  static constexpr std::string_view kName = "gyro";
  static constexpr std::string_view kPlural = "gyro samples";
  static constexpr const char* kTopic = "spindrift/gyro";
  static constexpr BusMessage kMessage = BusMessage::VectorSample;
  static constexpr std::string_view kTable = "gyro_sample";
  static constexpr std::string_view kSensor = "three_axis.gyro";
  static constexpr std::tuple kColumns{
      Column{"wx_rad_s", [](auto& sample) -> decltype(auto) { return sample.rate_body_rad_s.x(); }},
      Column{"wy_rad_s", [](auto& sample) -> decltype(auto) { return sample.rate_body_rad_s.y(); }},
      Column{"wz_rad_s",
             [](auto& sample) -> decltype(auto) { return sample.rate_body_rad_s.z(); }}};

  /// A faster body would have broken apart.
  static constexpr double kFastest_deg_s = 1000.0;

  static std::string why_impossible(const GyroSample& sample) {
    return is_at_most(sample.rate_body_rad_s, kFastest_deg_s / kDegPerRad)
               ? std::string{}
               : impossible("wx_rad_s, wy_rad_s, wz_rad_s", sample.rate_body_rad_s,
                            "be at most 1000 deg/s together");
  }
};

}  // namespace spindrift
