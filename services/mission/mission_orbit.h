/// @file
/// Reads the [orbit] of a mission file, and finds what a person should look at in it.

#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "pipelines/core/expected.h"
#include "pipelines/ephemeris/oem.h"
#include "pipelines/ephemeris/orbit.h"
#include "services/mission/scalar.h"

namespace spindrift {

/// Limit for an orbit file, enough for ten million states.
inline constexpr std::uint64_t kMostOrbitBytes = std::uint64_t{1} << 30U;

struct MissionOrbit {
  std::optional<Orbit> orbit;
  std::optional<std::string> file_sha256;  ///< Set when the orbit is from a file.
};

/// Returns the key that determines the source of the orbit.
std::string_view orbit_key(const TomlValues& values);

/// Reads the orbit file, if one is named (relative to `folder`), or takes the elements if all are
/// given. The orbit is empty when there is neither.
/// @return InvalidConfiguration with the key, its value and the reason.
Expected<MissionOrbit> load_orbit(const TomlValues& values, const std::filesystem::path& folder);

/// Returns one sentence per doubt: the OBJECT_NAME and OBJECT_ID may belong to another spacecraft
/// (or be another name of this one), the orbit jumps, segments do not meet, there are gaps. A doubt
/// is no problem: the file is used, and every command that uses it warns. A jump turns the nadir by
/// its size over the distance, and the axis by that or several times that; no sigma includes it.
/// @param file Path as the mission file names it.
std::vector<std::string> orbit_doubts(const OrbitEphemeris& ephemeris, std::string_view file,
                                      std::string_view spacecraft_id);

}  // namespace spindrift
