#include "pipelines/spin/types/products.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace spindrift {

std::string_view name_of(SpinQuantity quantity) {
  static constexpr std::array<std::string_view, kSpinQuantities> kNames = {
      "period",         "sun_angle",      "north_chord",  "south_chord",
      "north_dihedral", "south_dihedral", "mixed_azimuth"};
  return kNames.at(static_cast<std::size_t>(quantity));
}

Rejection rejection_of(SpinQuantity quantity) {
  static_assert(static_cast<int>(Rejection::MixedAzimuth) - static_cast<int>(Rejection::Period) ==
                    static_cast<int>(SpinQuantity::MixedAzimuth),
                "the tests stand in the order of the quantities");
  return static_cast<Rejection>(static_cast<int>(Rejection::Period) + static_cast<int>(quantity));
}

std::string_view name_of(Resolution resolution) {
  static constexpr std::array<std::string_view, 5> kNames = {"GEOMETRY", "CONSTRAINT", "PRIOR",
                                                             "DISPERSION", "AMBIGUOUS"};
  return kNames.at(static_cast<std::size_t>(resolution));
}

Resolution said_resolution(const SpinFix& fix) {
  return fix.settled_before.value_or(fix.resolution);
}

std::string_view name_of(SettledBy settled_by) {
  static constexpr std::array<std::string_view, 6> kNames = {"edges", "geometry",   "constraint",
                                                             "prior", "dispersion", "nothing"};
  return kNames.at(static_cast<std::size_t>(settled_by));
}

SettledBy settled_by(Resolution resolution) {
  static_assert(static_cast<int>(SettledBy::Nothing) ==
                static_cast<int>(SettledBy::Geometry) + static_cast<int>(Resolution::Ambiguous));
  return static_cast<SettledBy>(static_cast<int>(SettledBy::Geometry) +
                                static_cast<int>(resolution));
}

std::string_view name_of(SpinEstimator estimator) {
  static constexpr std::array<std::string_view, 3> kNames = {"mean", "sequential", "batch"};
  return kNames.at(static_cast<std::size_t>(estimator));
}

double difference_sigma_rad(const SpinEstimate& one, const SpinEstimate& other) {
  const double noise_rad = std::max(noise_sigma_rad(one), noise_sigma_rad(other));
  const double most_rad =
      std::sqrt(one.alignment_rad2.trace()) + std::sqrt(other.alignment_rad2.trace());
  const double alignment_rad =
      one.shift_icrf && other.shift_icrf ? (*one.shift_icrf - *other.shift_icrf).norm() : most_rad;
  return std::hypot(noise_rad, alignment_rad);
}

}  // namespace spindrift
