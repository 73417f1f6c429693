/// @file
/// The Earth's figure, WGS-84 (NIMA TR8350.2).

#pragma once

namespace spindrift::wgs84 {

inline constexpr double kEquatorialRadius_km = 6378.137;
inline constexpr double kPolarRadius_km = 6356.752314245;

}  // namespace spindrift::wgs84
