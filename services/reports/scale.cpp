#include "services/reports/scale.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace spindrift::plot {

Scale::Scale(bool is_logarithmic, double low, double high, double low_px, double high_px)
    : is_logarithmic_{is_logarithmic},
      low_{place_of(low)},
      high_{place_of(high)},
      low_px_{low_px},
      high_px_{high_px} {}

Scale Scale::linear(double low, double high, double low_px, double high_px) {
  return {false, low, high, low_px, high_px};
}

Scale Scale::logarithmic(double low, double high, double low_px, double high_px) {
  return {true, low, high, low_px, high_px};
}

double Scale::place_of(double value) const { return is_logarithmic_ ? std::log10(value) : value; }

double Scale::pixel_of(double value) const {
  const double share = std::clamp((place_of(value) - low_) / (high_ - low_), 0.0, 1.0);
  return low_px_ + share * (high_px_ - low_px_);
}

std::vector<double> linear_ticks(double low, double high, int most) {
  const double least = (high - low) / most;
  const double decade = std::pow(10.0, std::floor(std::log10(least)));
  double step = 10.0 * decade;
  for (const double factor : {5.0, 2.0, 1.0}) {
    step = factor * decade >= least ? factor * decade : step;
  }
  std::vector<double> ticks;
  // The tolerance keeps the last tick in spite of rounding.
  for (double i = std::ceil(low / step - 1e-9); i * step <= high + 1e-9 * step; ++i) {
    ticks.push_back(i * step + 0.0);  // Adding 0 avoids a minus zero.
  }
  return ticks;
}

std::vector<double> decades(double low, double high) {
  std::vector<double> ticks;
  for (double power = std::ceil(std::log10(low) - 1e-9); power <= std::log10(high) + 1e-9;
       ++power) {
    ticks.push_back(std::pow(10.0, power));
  }
  return ticks;
}

double time_step_s(double least_s) {
  constexpr double kMinute = 60.0;
  constexpr double kHour = 3600.0;
  constexpr double kDay = 24.0 * kHour;
  constexpr std::array kSteps = {
      1.0,     2.0,           5.0,           10.0,           15.0,           30.0,
      kMinute, 2.0 * kMinute, 5.0 * kMinute, 10.0 * kMinute, 15.0 * kMinute, 30.0 * kMinute,
      kHour,   2.0 * kHour,   3.0 * kHour,   6.0 * kHour,    12.0 * kHour};
  const auto* const step = std::find_if(kSteps.begin(), kSteps.end(),
                                        [least_s](double each) { return each >= least_s; });
  return step != kSteps.end() ? *step : kDay * std::ceil(least_s / kDay);
}

ValueAxis linear_axis(std::string title, double low, double high, int most_ticks) {
  return {.title = std::move(title),
          .is_logarithmic = false,
          .low = low,
          .high = high,
          .ticks = linear_ticks(low, high, most_ticks)};
}

ValueAxis logarithmic_axis(std::string title, double low, double high) {
  return {.title = std::move(title),
          .is_logarithmic = true,
          .low = low,
          .high = high,
          .ticks = decades(low, high)};
}

}  // namespace spindrift::plot
