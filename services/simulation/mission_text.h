/// @file
/// The mission file that belongs to a simulated pass.

#pragma once

#include <toml++/toml.h>

#include <string>

namespace spindrift {

/// The tables of a sound scenario that a mission file has too, as they are; the orbit is the
/// simulated one, orbit.oem beside it.
std::string mission_text(const toml::table& scenario);

}  // namespace spindrift
