/// @file
/// The thresholds of alert conditions; defaults as in schemas/mission.schema.toml.

#pragma once

#include <Eigen/Core>
#include <array>
#include <map>
#include <optional>
#include <string>

#include "pipelines/supervision/alert_code.h"
#include "pipelines/time/tai_time.h"

namespace spindrift {

/// A limit on a share of the most recent revolutions.
struct ShareLimit {
  double percent;
  int revolutions;
  friend bool operator==(const ShareLimit&, const ShareLimit&) = default;
};

constexpr std::array<double, kAlertCodes> every_code(double value) {
  std::array<double, kAlertCodes> values{};
  values.fill(value);
  return values;
}

struct AlertLimits {
  double link_silent_s = 5.0;
  double link_late_s = 10.0;
  double gap_samples = 1.0;
  double rejected_percent = 1.0;
  double repeated_samples = 100.0;
  double contradicted_samples = 1.0;
  double undelivered_s = 60.0;
  double silent_s = 5.0;
  int silent_revolutions = 10;
  ShareLimit period = {.percent = 10.0, .revolutions = 100};
  ShareLimit rejection = {.percent = 20.0, .revolutions = 100};
  double ambiguous_s = 60.0;
  double doubtful_s = 30.0;
  double sigma_deg = 1.0;
  double sigma_after_s = 120.0;
  double disagree_sigmas = 5.0;
  double off_target_deg = 2.0;
  double off_target_sigmas = 3.0;
  double nutation_deg = 0.5;
  double spin_no_answer_s = 60.0;
  double attitude_doubtful_s = 30.0;
  double attitude_no_answer_s = 60.0;
  double diverged_percent = 99.9;
  double diverged_s = 60.0;
  double contradicts_sigmas = 5.0;
  double stuck_s = 5.0;
  double launcher_percent = 99.0;
  double departure_sigmas = 5.0;
  double backlog_s = 10.0;
  double disk_gib = 1.0;
  double log_mib = 256.0;
  double host_within_s = 60.0;  ///< Value of [time] host_within_s.
  double clock_jump_s = 1.0;
  /// By AlertCode: a condition that returns within it is the same occurrence.
  std::array<double, kAlertCodes> hold_off_s = every_code(60.0);
  friend bool operator==(const AlertLimits&, const AlertLimits&) = default;
};

/// An operator's limits for one kind of alert, as the mission file has them under [alerts].
struct SetLimit {
  std::string key;                       ///< Name of an AlertCode.
  std::map<std::string, double> limits;  ///< Limits by name, in the unit of the mission file.
};

/// The planned contact of a pass.
struct Contact {
  TaiTime from;
  TaiTime to;
};

/// The axis and rate that a spinner should have.
struct SpinTarget {
  Eigen::Vector3d axis_icrf;  ///< Unit vector.
  struct Rate {
    double rad_s;
    double tolerance_rad_s;
  };
  std::optional<Rate> rate = {};
};

}  // namespace spindrift
