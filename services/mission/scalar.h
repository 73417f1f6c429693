/// @file
/// The values of a mission file once they are known to be good.

#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <variant>

namespace spindrift {

using Scalar = std::variant<bool, std::int64_t, double, std::string>;

/// By dotted path, such as spin.noise.sun_pulse_s; defaults filled in. Arrays are not kept.
using MissionValues = std::map<std::string, Scalar, std::less<>>;

}  // namespace spindrift
