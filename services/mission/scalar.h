/// @file
/// Valid values of a configuration file.

#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <variant>
#include <vector>

namespace spindrift {

/// Arrays of numbers are stored row by row.
using Scalar = std::variant<bool, std::int64_t, double, std::string, std::vector<double>,
                            std::vector<std::string>>;

/// By dotted path, as spin.noise.sun_pulse_s or faults.silence[0].from_s; defaults filled in.
using TomlValues = std::map<std::string, Scalar, std::less<>>;

}  // namespace spindrift
