/// @file
/// Checks whether the program's leap second table is complete.

#pragma once

#include "services/base/leap_tables.h"
#include "services/doctor/check.h"

namespace spindrift::doctor {

Check check_leap_seconds(const LeapFacts& facts);

}  // namespace spindrift::doctor
