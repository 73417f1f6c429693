/// @file
/// The values of a configuration file once they are known to be good.

#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <variant>

namespace spindrift {

using Scalar = std::variant<bool, std::int64_t, double, std::string>;

/// By dotted path, such as spin.noise.sun_pulse_s or faults.silence[0].from_s; defaults filled in.
/// Arrays of values are not kept.
using TomlValues = std::map<std::string, Scalar, std::less<>>;

}  // namespace spindrift
