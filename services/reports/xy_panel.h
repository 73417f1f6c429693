/// @file
/// A panel of values over values, anywhere on a page.

#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "services/reports/scale.h"
#include "services/reports/svg.h"

namespace spindrift::plot {

/// A curve in values, not pixels; beyond the axes it runs along their ends.
struct Series {
  std::vector<Point> points;
  std::string_view colour;
  std::string_view dashes = {};  ///< Dashes as in Stroke.
  double dot_px = 0.0;  ///< Radius of a dot at each point; 0: the points are joined by a line.
};

struct XyPanel {
  std::string title;
  std::string note = {};  ///< Note below the title.
  ValueAxis x;
  ValueAxis y;
  std::vector<Series> series = {};
  std::vector<Box> bars = {};      ///< Filled bars, in values.
  std::vector<Limit> across = {};  ///< Limits at values of y, with their names.
};

/// @param box Area within the axes; titles are above and below it, ticks to its left.
void draw(const XyPanel& panel, const Box& box, Svg& svg);

}  // namespace spindrift::plot
