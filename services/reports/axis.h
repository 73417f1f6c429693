/// @file
/// Axis of a plot, and limits drawn across it.

#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "services/reports/scale.h"

namespace spindrift::plot {

struct ValueAxis {
  std::string title;
  bool is_logarithmic;
  double low;
  double high;
  std::vector<double> ticks;

  Scale scale(double low_px, double high_px) const {
    return is_logarithmic ? Scale::logarithmic(low, high, low_px, high_px)
                          : Scale::linear(low, high, low_px, high_px);
  }
};

struct Limit {
  std::string name;
  std::string_view colour;
  double value;
};

}  // namespace spindrift::plot
