/// @file
/// Whether a run's result can be acted on, as in the archive's view pass_verdict.

#pragma once

#include <optional>
#include <string>

#include "pipelines/core/assessment.h"
#include "pipelines/time/tai_time.h"

namespace spindrift {

/// The reconstructed attitude at separation, as in the archive's view separation_verdict.
struct SeparationVerdict {
  std::string method;
  Quality quality;
  TaiTime t1;  ///< Time of the separation.
  double sigma_deg;
  std::string why;   ///< Sentence.
  std::string says;  ///< All of it but `why`, as a sentence.

  friend bool operator==(const SeparationVerdict&, const SeparationVerdict&) = default;
};

/// The default values describe a run without an answer and a run that does not exist.
struct PassVerdict {
  bool finished = false;  ///< False: it goes on, or was interrupted or killed.
  /// @name Empty when the run has no answer
  /// @{
  std::string estimator = {};           ///< Estimator whose answer to report.
  std::optional<Quality> quality = {};  ///< May be set for a failed run.
  std::optional<TaiTime> t = {};        ///< Time that the answer is of.
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
  std::optional<SeparationVerdict> separation = {};  ///< Empty without a reconstruction.
  std::string why = "no estimate";                   ///< Sentence, objections first.
  std::string against = "no estimate";               ///< Objections; empty when there are none.

  friend bool operator==(const PassVerdict&, const PassVerdict&) = default;
};

}  // namespace spindrift
