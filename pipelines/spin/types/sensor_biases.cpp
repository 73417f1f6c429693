#include "pipelines/spin/types/sensor_biases.h"

#include <array>

#include "pipelines/frames/angle.h"

namespace spindrift {
namespace {

// Balancing leaves some tenths of a degree between the sensors' axis and the principal axis.
constexpr BiasPrior kConing{
    .name = "coning", .is_angle = true, .sigma = 0.5 * kRadPerDeg, .bound = 5.0 * kRadPerDeg};

/// Twice the accuracy of alignments (model_allowance.h), since only a suspected bias is asked for.
constexpr BiasPrior angle(std::string_view name) {
  return {.name = name, .is_angle = true, .sigma = 0.3 * kRadPerDeg, .bound = 3.0 * kRadPerDeg};
}

// Indexed by SensorBias.
constexpr std::array<BiasPrior, kSensorBiases> kPriors{
    angle("sun_angle"),
    angle("slit_separation"),
    angle("north_chord"),
    angle("south_chord"),
    angle("north_mount_angle"),
    angle("south_mount_angle"),
    angle("dihedral"),
    // Seasons and latitude move the 14 to 16 um horizon by a few km (WGS-84 surface + 40 km
    // nominal).
    BiasPrior{.name = "co2_height", .is_angle = false, .sigma = 4.0, .bound = 30.0},
    kConing,
    kConing,
};

}  // namespace

const BiasPrior& prior_of(SensorBias bias) { return kPriors.at(static_cast<std::size_t>(bias)); }

SensorBiases suspected_sigmas() {
  SensorBiases sigmas;
  for (int i = 0; i < kSensorBiases; ++i) {
    sigmas[i] = prior_of(static_cast<SensorBias>(i)).sigma;
  }
  return sigmas;
}

BiasSet unknowns_of(SensorBias bias) {
  const bool is_coning = bias == ConingX || bias == ConingY;
  return is_coning ? BiasSet{}.set(ConingX).set(ConingY)
                   : BiasSet{}.set(static_cast<std::size_t>(bias));
}

}  // namespace spindrift
