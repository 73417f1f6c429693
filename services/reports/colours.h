/// @file
/// Colours of all plots.

#pragma once

#include <array>
#include <string_view>

namespace spindrift::plot {

// Text, grid and frames.
inline constexpr std::string_view kInk = "#222222";
inline constexpr std::string_view kFaint = "#666666";
inline constexpr std::string_view kGrid = "#e6e6e6";
inline constexpr std::string_view kFrame = "#999999";

// Curves, in colours that the colour-blind can tell apart (Okabe and Ito).
inline constexpr std::string_view kVermilion = "#d55e00";
inline constexpr std::string_view kGreen = "#009e73";
inline constexpr std::string_view kBlue = "#0072b2";
inline constexpr std::string_view kOrange = "#e69f00";
inline constexpr std::string_view kGrey = "#777777";
inline constexpr std::array<std::string_view, 8> kCurves = {
    kVermilion, kGreen, kBlue, kOrange, "#cc79a7", "#56b4e9", kGrey, "#b2a800"};

}  // namespace spindrift::plot
