#include "pipelines/spin/batch/nutation_stretch.h"

#include <cmath>
#include <complex>

namespace spindrift {

double NutationStretch::half_s() const { return 0.5 * seconds_between(begin, end); }

NutationTilt tilt_at(const NutationStretch& stretch, TaiTime t, double phase_rad) {
  using namespace std::complex_literals;
  const double x = seconds_between(stretch.begin, t) / stretch.half_s() - 1.0;
  const std::complex<double> g{stretch.unknowns[0], stretch.unknowns[1]};
  const std::complex<double> per_g = std::polar(
      std::exp(stretch.unknowns[2] * x), stretch.per_turn * phase_rad + stretch.unknowns[3] * x);
  const std::complex<double> tilt = g * per_g;
  const auto vector = [](std::complex<double> z) { return Eigen::Vector2d{z.real(), z.imag()}; };
  NutationTilt there{.rotation_rad = vector(tilt),
                     .per_unknown = {},
                     .per_phase = vector(1i * stretch.per_turn * tilt)};
  there.per_unknown << vector(per_g), vector(1i * per_g), vector(x * tilt), vector(1i * x * tilt);
  return there;
}

}  // namespace spindrift
