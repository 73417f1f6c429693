/// @file
/// A reconstructed separation for people.

#pragma once

#include <string>

#include "services/reports/separation_report.h"

namespace spindrift {

/// Events, attitudes in ICRF and in the orbit frame, bias, launcher, quality; several lines, each
/// ending in a line end.
std::string to_text(const SeparationReport& report);

}  // namespace spindrift
