/// @file
/// A panel of values over other values, anywhere on a page.

#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "services/reports/axis.h"
#include "services/reports/svg.h"

namespace spindrift::plot {

/// In values, not in pixels; beyond the axes it runs along their ends.
struct Series {
  std::vector<Point> points;
  std::string_view colour;
  std::string_view dashes = {};  ///< As of Stroke.
  double dot_px = 0.0;           ///< Radius of a dot at each point; 0: they are joined by a line.
};

struct XyPanel {
  std::string title;
  std::string note = {};  ///< Below the title.
  ValueAxis x;
  ValueAxis y;
  std::vector<Series> series = {};
  std::vector<Box> bars = {};      ///< In values, filled.
  std::vector<Limit> across = {};  ///< At values of y, each with its name.
};

/// @param box Of the panel within its axes; titles stand above and below it, ticks to its left.
void draw(const XyPanel& panel, const Box& box, Svg& svg);

}  // namespace spindrift::plot
