/// @file
/// From values to pixels, and where the ticks go.

#pragma once

#include <vector>

namespace spindrift::plot {

/// Values of which `low` stands at one pixel, `high` at another; those beyond stand at the end.
class Scale {
 public:
  static Scale linear(double low, double high, double low_px, double high_px);
  /// @param low Above zero.
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

/// Multiples of 1, 2 or 5 times a power of ten from `low` to `high`, at most about `most`.
std::vector<double> linear_ticks(double low, double high, int most);

/// The powers of ten from `low` to `high`.
std::vector<double> decades(double low, double high);

/// The least step that people count time in (1, 2, 5, 10, 15, 30 s or min; 1, 2, 3, 6, 12 h; days)
/// of at least so many seconds.
double time_step_s(double least_s);

}  // namespace spindrift::plot
