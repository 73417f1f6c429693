/// @file
/// The mission file that belongs to a simulated pass.

#pragma once

#include <toml++/toml.h>

#include <string>

namespace spindrift {

/// Returns the tables that a valid scenario shares with a mission file, unchanged; the orbit is the
/// simulated one, in orbit.oem beside it.
std::string mission_text(const toml::table& scenario);

}  // namespace spindrift
