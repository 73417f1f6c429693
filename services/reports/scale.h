/// @file
/// Map from values to pixels, positions of ticks, and the axes of plots made of them.

#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace spindrift::plot {

/// Maps values so that `low` is at one pixel and `high` at another; values beyond are clamped.
class Scale {
 public:
  static Scale linear(double low, double high, double low_px, double high_px);
  /// @param low Above 0.
  static Scale logarithmic(double low, double high, double low_px, double high_px);

  double pixel_of(double value) const;

 private:
  Scale(bool is_logarithmic, double low, double high, double low_px, double high_px);
  double place_of(double value) const;

  bool is_logarithmic_;
  double low_;
  double high_;
  double low_px_;
  double high_px_;
};

/// Returns multiples of 1, 2 or 5 times a power of ten from `low` to `high`, at most about `most`.
std::vector<double> linear_ticks(double low, double high, int most);

std::vector<double> decades(double low, double high);

/// Returns the least usual step of time (1, 2, 5, 10, 15, 30 s or min; 1, 2, 3, 6, 12 h; days) that
/// is at least `least_s`.
double time_step_s(double least_s);

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

/// Returns a linear axis with ticks at round values, at most about `most_ticks`.
ValueAxis linear_axis(std::string title, double low, double high, int most_ticks);
/// Returns a logarithmic axis with a tick at each power of ten.
ValueAxis logarithmic_axis(std::string title, double low, double high);

}  // namespace spindrift::plot
