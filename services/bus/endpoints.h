/// @file
/// Tells who on the bus does not match us and why; DDS only says that somebody does not.

#pragma once

#include <string>
#include <vector>

#include "services/bus/entity.h"

namespace spindrift::bus {

/// Describes writers on the topic and partition of `reader` that offer less than it needs: one
/// sentence each, with process, host, and every policy that falls short. @return Unavailable when
/// Cyclone refuses.
Expected<std::vector<std::string>> incompatible_writers(const Entity& reader);

/// Describes readers that request more than `writer` offers, in the same way.
Expected<std::vector<std::string>> incompatible_readers(const Entity& writer);

}  // namespace spindrift::bus
