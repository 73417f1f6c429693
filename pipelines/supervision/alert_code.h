/// @file
/// The alert codes, whose names are the keys that programs match on.

#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace spindrift {

enum class AlertCode {
  LinkSilent,
  LinkLate,
  LinkAhead,
  LinkGap,  ///< Per source, as are LinkRestarted, LinkRepeated and LinkContradiction.
  LinkRejected,
  LinkRepeated,
  LinkRestarted,
  LinkContradiction,
  ServiceTwice,
  AlertsUndelivered,
  ChannelSilent,  ///< One alert for each channel.
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
  SpinNoAnswer,
  AttitudeLost,
  AttitudeDoubtful,
  AttitudeNoAnswer,
  AttitudeDiverged,
  SensorContradicts,  ///< Per culprit, `unknown` where nothing tells which of two it is.
  SensorStuck,        ///< One alert for each sensor.
  ReconstructionLauncher,
  ModelDeparture,  ///< One alert for each channel.
  ArchiveBacklog,
  ArchiveWrite,
  ArchiveDisk,
  ArchiveLog,
  ClockDisagree,
  ClockJump,
  DataOutdated,  ///< Per item of reference data, such as the orbit.
};
inline constexpr int kAlertCodes = static_cast<int>(AlertCode::DataOutdated) + 1;

constexpr std::string_view name_of(AlertCode code) {
  constexpr std::array<std::string_view, kAlertCodes> kNames = {"link.silent",
                                                                "link.late",
                                                                "link.ahead",
                                                                "link.gap",
                                                                "link.rejected",
                                                                "link.repeated",
                                                                "link.restarted",
                                                                "link.contradiction",
                                                                "service.twice",
                                                                "alerts.undelivered",
                                                                "channel.silent",
                                                                "spin.interference",
                                                                "spin.period",
                                                                "spin.rejection",
                                                                "spin.ambiguous",
                                                                "spin.doubtful",
                                                                "spin.sigma",
                                                                "spin.disagree",
                                                                "spin.off_target",
                                                                "spin.nutation",
                                                                "spin.rate",
                                                                "spin.no_answer",
                                                                "attitude.lost",
                                                                "attitude.doubtful",
                                                                "attitude.no_answer",
                                                                "attitude.diverged",
                                                                "sensor.contradicts",
                                                                "sensor.stuck",
                                                                "reconstruction.launcher",
                                                                "model.departure",
                                                                "archive.backlog",
                                                                "archive.write",
                                                                "archive.disk",
                                                                "archive.log",
                                                                "clock.disagree",
                                                                "clock.jump",
                                                                "data.outdated"};
  return kNames.at(static_cast<std::size_t>(code));
}

/// Returns a key such as "channel.silent:north_in". @param about Empty for the whole spacecraft.
inline std::string alert_key(AlertCode code, std::string_view about) {
  std::string key{name_of(code)};
  if (!about.empty()) {
    key.append(":").append(about);
  }
  return key;
}

/// Returns the code of a key; empty when there is none.
constexpr std::optional<AlertCode> code_of(std::string_view key) {
  for (int i = 0; i < kAlertCodes; ++i) {
    if (name_of(static_cast<AlertCode>(i)) == key.substr(0, key.find(':'))) {
      return static_cast<AlertCode>(i);
    }
  }
  return std::nullopt;
}

/// Returns what stands behind the colon of a key, or empty.
constexpr std::string_view about_of(std::string_view key) {
  const std::size_t colon = key.find(':');
  return colon == std::string_view::npos ? std::string_view{} : key.substr(colon + 1);
}

/// Returns whether the condition says something about the answer itself, so that no operator can
/// accept it. What is left out of an answer does not: the quality of the answer says what the rest
/// is worth.
constexpr bool bears_on_answer(AlertCode code) {
  switch (code) {
    case AlertCode::ServiceTwice:
    case AlertCode::AlertsUndelivered:
    case AlertCode::ChannelSilent:
    case AlertCode::SensorStuck:
    case AlertCode::SpinInterference:
    case AlertCode::SpinPeriod:
    case AlertCode::SpinRejection:
    case AlertCode::SpinOffTarget:
    case AlertCode::SpinNutation:
    case AlertCode::SpinRate:
    case AlertCode::ArchiveBacklog:
    case AlertCode::ArchiveDisk:
    case AlertCode::ArchiveLog:
    case AlertCode::ClockJump:
    case AlertCode::DataOutdated:
      return false;
    default:
      return true;
  }
}

enum class AlertSeverity { Info, Warning, Critical };
constexpr std::string_view name_of(AlertSeverity severity) {
  constexpr std::array<std::string_view, 3> kNames = {"info", "warning", "critical"};
  return kNames.at(static_cast<std::size_t>(severity));
}

constexpr AlertSeverity severity_of(AlertCode code) {
  switch (code) {
    case AlertCode::AttitudeLost:
    case AlertCode::ArchiveWrite:
      return AlertSeverity::Critical;
    case AlertCode::LinkRepeated:
    case AlertCode::LinkRestarted:
    case AlertCode::SpinInterference:
      return AlertSeverity::Info;
    default:
      return AlertSeverity::Warning;
  }
}

}  // namespace spindrift
