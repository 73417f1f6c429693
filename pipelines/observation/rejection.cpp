#include "pipelines/observation/rejection.h"

#include <array>
#include <cstddef>

namespace spindrift {

std::string_view name_of(Rejection rejection) {
  static constexpr std::array<std::string_view, kRejections> kNames = {
      "unassociated", "late",        "out_of_time",    "contradicted",   "copy",
      "interference", "operator",    "phase",          "geometry",       "no_sensor",
      "no_orbit",     "no_field",    "saturated",      "frozen",         "outlier",
      "shadow",       "unit",        "innovation",     "period",         "sun_angle",
      "north_chord",  "south_chord", "north_dihedral", "south_dihedral", "mixed_azimuth"};
  return kNames.at(static_cast<std::size_t>(rejection));
}

}  // namespace spindrift
