/// @file
/// How far an axis that spindrift gave lies from the true one.

#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "pipelines/frames/angle.h"
#include "pipelines/frames/celestial.h"
#include "tests/support/archive_rows.h"

namespace spindrift {

/// Returns the angle between two axes that are given by "ra_deg" and "dec_deg", deg.
inline double error_deg(const nlohmann::json& axis, const nlohmann::json& truth) {
  const auto place_icrf = [](const nlohmann::json& of) {
    return direction_icrf({.ra_rad = of["ra_deg"].get<double>() * kRadPerDeg,
                           .dec_rad = of["dec_deg"].get<double>() * kRadPerDeg});
  };
  return degrees(angle_between_rad(place_icrf(axis), place_icrf(truth)));
}

/// Returns the axis of the first row.
/// @param from Part of a SELECT from its FROM on.
inline nlohmann::json axis_in(const std::filesystem::path& db, const std::string& from) {
  return {{"ra_deg", real_of(db, "SELECT ra_deg " + from)},
          {"dec_deg", real_of(db, "SELECT dec_deg " + from)}};
}

}  // namespace spindrift
