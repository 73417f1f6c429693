/// @file
/// Conversions between radians, degrees, turns and turns per minute.

#pragma once

#include <numbers>

namespace spindrift {

inline constexpr double kRadPerDeg = std::numbers::pi / 180.0;
inline constexpr double kDegPerRad = 180.0 / std::numbers::pi;
inline constexpr double kTurn_rad = 2.0 * std::numbers::pi;
inline constexpr double kQuarter_rad = 0.25 * kTurn_rad;
inline constexpr double kRpmPerRad_s = 30.0 / std::numbers::pi;

constexpr double degrees(double angle_rad) { return angle_rad * kDegPerRad; }

}  // namespace spindrift
