#include "pipelines/spin/types/sensor_biases.h"

#include <array>

#include "pipelines/frames/angle.h"

namespace spindrift {
namespace {

constexpr BiasRange kConing{.name = "coning", .is_angle = true, .bound = 5.0 * kRadPerDeg};

constexpr BiasRange angle(std::string_view name) {
  return {.name = name, .is_angle = true, .bound = 3.0 * kRadPerDeg};
}

// Indexed by SensorBias.
constexpr std::array<BiasRange, kSensorBiases> kRanges{
    angle("sun_angle"),
    angle("slit_separation"),
    angle("north_chord"),
    angle("south_chord"),
    angle("north_mount_angle"),
    angle("south_mount_angle"),
    angle("dihedral"),
    BiasRange{.name = "co2_height", .is_angle = false, .bound = 30.0},
    kConing,
    kConing,
};

}  // namespace

const BiasRange& range_of(SensorBias bias) { return kRanges.at(static_cast<std::size_t>(bias)); }

SensorBiases range_sigmas() {
  SensorBiases sigmas;
  for (int i = 0; i < kSensorBiases; ++i) {
    sigmas[i] = 0.1 * range_of(static_cast<SensorBias>(i)).bound;
  }
  return sigmas;
}

BiasSet unknowns_of(SensorBias bias) {
  const bool is_coning = bias == ConingX || bias == ConingY;
  return is_coning ? BiasSet{}.set(ConingX).set(ConingY)
                   : BiasSet{}.set(static_cast<std::size_t>(bias));
}

}  // namespace spindrift
