/// @file
/// The Earth's figure and rotation rate, WGS-84 (NIMA TR8350.2).

#pragma once

namespace spindrift::wgs84 {

inline constexpr double kEquatorialRadius_km = 6378.137;
inline constexpr double kPolarRadius_km = 6356.752314245;
inline constexpr double kTurning_rad_s = 7.292115e-5;

}  // namespace spindrift::wgs84
