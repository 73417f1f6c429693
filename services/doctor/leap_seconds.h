/// @file
/// Whether the leap seconds that the program knows are all there are.

#pragma once

#include "services/base/leap_tables.h"
#include "services/doctor/check.h"

namespace spindrift::doctor {

Check check_leap_seconds(const LeapFacts& facts);

}  // namespace spindrift::doctor
