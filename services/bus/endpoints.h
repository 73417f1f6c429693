/// @file
/// Who on the bus does not match us, and why. DDS itself says only that somebody does not.

#pragma once

#include <string>
#include <vector>

#include "services/bus/entity.h"

namespace spindrift::bus {

/// Writers of the topic and partition of `reader` that offer less than it needs: a sentence each,
/// naming process, host, and every policy that falls short. @return Unavailable when Cyclone
/// refuses.
Expected<std::vector<std::string>> incompatible_writers(const Entity& reader);

/// Likewise readers that ask for more than `writer` offers.
Expected<std::vector<std::string>> incompatible_readers(const Entity& writer);

}  // namespace spindrift::bus
