/// @file
/// The notices of a pass as sentences for people.

#pragma once

#include <string>

#include "pipelines/core/notice.h"

namespace spindrift {

std::string sentence_of(const Notice& notice);

}  // namespace spindrift
