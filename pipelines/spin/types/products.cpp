#include "pipelines/spin/types/products.h"

#include <array>

namespace spindrift {

std::string_view name_of(SpinQuantity quantity) {
  static constexpr std::array<std::string_view, kSpinQuantities> kNames = {
      "period",         "sun_angle",      "north_chord",  "south_chord",
      "north_dihedral", "south_dihedral", "mixed_azimuth"};
  return kNames.at(static_cast<std::size_t>(quantity));
}

Rejection rejection_of(SpinQuantity quantity) {
  return static_cast<Rejection>(static_cast<int>(Rejection::Period) + static_cast<int>(quantity));
}

std::string_view name_of(Resolution resolution) {
  static constexpr std::array<std::string_view, 5> kNames = {"GEOMETRY", "CONSTRAINT", "PRIOR",
                                                             "DISPERSION", "AMBIGUOUS"};
  return kNames.at(static_cast<std::size_t>(resolution));
}

Resolution said_resolution(const SpinFix& fix) {
  return fix.chosen_by_pass ? Resolution::Dispersion : fix.resolution;
}

std::string_view name_of(SpinEstimator estimator) {
  static constexpr std::array<std::string_view, 3> kNames = {"mean", "sequential", "batch"};
  return kNames.at(static_cast<std::size_t>(estimator));
}

}  // namespace spindrift
