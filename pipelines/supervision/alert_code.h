/// @file
/// What alerts are about: the keys that programs match on.

#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <string_view>

namespace spindrift {

enum class AlertCode {
  ChannelSilent,  ///< About a channel.
  SpinInterference,
  SpinPeriod,
  SpinRejection,
  SpinAmbiguous,
  SpinDoubtful,
  SpinSigma,
  SpinDisagree,
  SpinOffTarget,
  SpinNutation,
  SpinRate,
  AttitudeLost,
  ReconstructionLauncher,
};
inline constexpr int kAlertCodes = static_cast<int>(AlertCode::ReconstructionLauncher) + 1;

constexpr std::string_view name_of(AlertCode code) {
  constexpr std::array<std::string_view, kAlertCodes> kNames = {
      "channel.silent",         "spin.interference", "spin.period", "spin.rejection",
      "spin.ambiguous",         "spin.doubtful",     "spin.sigma",  "spin.disagree",
      "spin.off_target",        "spin.nutation",     "spin.rate",   "attitude.lost",
      "reconstruction.launcher"};
  return kNames.at(static_cast<std::size_t>(code));
}

/// "channel.silent:north_in". @param about Empty: the spacecraft as a whole.
inline std::string alert_key(AlertCode code, std::string_view about) {
  std::string key{name_of(code)};
  if (!about.empty()) {
    key.append(":").append(about);
  }
  return key;
}

enum class AlertSeverity { Info, Warning, Critical };
constexpr std::string_view name_of(AlertSeverity severity) {
  constexpr std::array<std::string_view, 3> kNames = {"info", "warning", "critical"};
  return kNames.at(static_cast<std::size_t>(severity));
}

constexpr AlertSeverity severity_of(AlertCode code) {
  switch (code) {
    case AlertCode::AttitudeLost:
      return AlertSeverity::Critical;
    case AlertCode::SpinInterference:
      return AlertSeverity::Info;
    default:
      return AlertSeverity::Warning;
  }
}

}  // namespace spindrift
