/// @file
/// Whether a run's result can be acted on, as in the archive's view pass_verdict.

#pragma once

#include <optional>
#include <string>

#include "pipelines/core/assessment.h"

namespace spindrift {

/// The default values describe a run without an answer and a run that does not exist.
struct PassVerdict {
  bool finished = false;  ///< False: it goes on, or was interrupted or killed.
  /// @name Empty when the run has no answer
  /// @{
  std::string estimator = {};           ///< Estimator whose answer to report.
  std::optional<Quality> quality = {};  ///< May be set for a failed run.
  std::optional<double> sigma_deg = {};
  /// What sigma_deg would be if the mission file were exact; also empty where it is not known.
  std::optional<double> noise_sigma_deg = {};
  /// @}
  /// @name Spin axis (ICRF) and spin rate of that estimator, empty when it gives none
  /// @{
  std::optional<double> ra_deg = {};
  std::optional<double> dec_deg = {};
  std::optional<double> spin_rate_rpm = {};
  std::optional<double> sigma_rpm = {};
  /// @}
  std::string why = "no estimate";      ///< Sentence, objections first.
  std::string against = "no estimate";  ///< Objections; empty when there are none.
};

}  // namespace spindrift
