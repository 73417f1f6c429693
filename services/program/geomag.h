/// @file
/// `spindrift geomag field`: evaluates the Earth's main magnetic field at points.

#pragma once

#include <filesystem>

#include "pipelines/core/expected.h"

namespace spindrift {

struct GeomagFieldOptions {
  double year = 0.0;             ///< Decimal year.
  std::filesystem::path points;  ///< CSV: lat_deg,lon_deg,height_km, geodetic WGS-84.
  bool json = false;
};

/// Prints the points with the north, east and down components of the field on standard output.
/// @return InvalidConfiguration for a year outside the model and for a malformed points file,
///         naming line, column and what is allowed; Unavailable when reading fails.
Expected<void> geomag_field(const GeomagFieldOptions& options);

}  // namespace spindrift
