/// @file
/// Of what stands around curves.

#pragma once

#include <string_view>

namespace spindrift::plot {

inline constexpr std::string_view kInk = "#222222";
inline constexpr std::string_view kFaint = "#666666";
inline constexpr std::string_view kGrid = "#e6e6e6";
inline constexpr std::string_view kFrame = "#999999";

}  // namespace spindrift::plot
