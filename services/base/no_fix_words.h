/// @file
/// The reason why a revolution gives no spin axis, as a sentence for people.

#pragma once

#include <string>

#include "pipelines/core/no_fix.h"

namespace spindrift {

std::string sentence_of(const WhyNoFix& why);

}  // namespace spindrift
