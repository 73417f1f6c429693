/// @file
/// Output of a reconstructed separation as text.

#pragma once

#include <string>

#include "services/reports/separation_report.h"

namespace spindrift {

/// Returns lines of events, attitudes in ICRF and in the orbit frame, bias, launcher and quality.
std::string to_text(const SeparationReport& report);

}  // namespace spindrift
