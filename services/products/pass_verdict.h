/// @file
/// Whether to act on what a run gave, as the archive's view pass_verdict has it.

#pragma once

#include <optional>
#include <string>

#include "pipelines/core/assessment.h"

namespace spindrift {

/// Of a run without an answer, or that does not exist, as it stands here.
struct PassVerdict {
  bool finished = false;  ///< Otherwise the run goes on, or was interrupted or killed.
  /// @name Empty: the run has no answer
  /// @{
  std::string estimator = {};           ///< To report.
  std::optional<Quality> quality = {};  ///< There is one of a run that failed, too.
  std::optional<double> sigma_deg = {};
  /// @}
  /// @name The spin axis, ICRF, and the rate of that estimator; empty: it gives none
  /// @{
  std::optional<double> ra_deg = {};
  std::optional<double> dec_deg = {};
  std::optional<double> spin_rate_rpm = {};
  std::optional<double> sigma_rpm = {};
  /// @}
  std::string why = "no estimate";      ///< First what speaks against it.
  std::string against = "no estimate";  ///< What does. Empty: nothing.
};

}  // namespace spindrift
