/// @file
/// `spindrift geomag field`: the Earth's main magnetic field at points.

#pragma once

#include <filesystem>

#include "pipelines/core/expected.h"

namespace spindrift {

struct GeomagFieldOptions {
  double year = 0.0;             ///< With decimals.
  std::filesystem::path points;  ///< CSV: lat_deg,lon_deg,height_km, geodetic WGS-84.
  bool json = false;
};

/// Prints the points with the field to north, east and down on standard output.
/// @return InvalidConfiguration for a year outside the model and for what is no file of points,
///         naming line, column and what is allowed; Unavailable when reading fails.
Expected<void> geomag_field(const GeomagFieldOptions& options);

}  // namespace spindrift
