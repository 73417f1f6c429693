/// @file
/// Sensor errors that stay the same all over a pass: the unknowns that the estimator `batch` can
/// determine beside axis and rate.

#pragma once

#include <Eigen/Core>
#include <bitset>
#include <string_view>

namespace spindrift {

/// Biases: true value minus that of the mission file; for measured angles, measured minus true.
enum SensorBias {
  SunAngleBias,         ///< rad, of the measured sun angle.
  SlitSeparationBias,   ///< rad, psi0.
  NorthChordBias,       ///< rad, of the measured chord: half of it at either end.
  SouthChordBias,       ///< rad
  NorthMountAngleBias,  ///< rad, gamma_N.
  SouthMountAngleBias,  ///< rad, gamma_S.
  DihedralBias,         ///< rad, of the azimuth of both beams behind slit 1.
  Co2HeightBias,        ///< km, of the infrared horizon.
  ConingX,              ///< rad, see coning.h; known or unknown only together with ConingY.
  ConingY,              ///< rad
};
inline constexpr int kSensorBiases = 10;
using SensorBiases = Eigen::Matrix<double, kSensorBiases, 1>;

using BiasSet = std::bitset<kSensorBiases>;

/// Returns the bias itself, or both biases of coning for either of them.
BiasSet unknowns_of(SensorBias bias);

/// Holds name, unit and range of a bias.
struct BiasRange {
  std::string_view name;  ///< Name in mission file and archive.
  bool is_angle;          ///< Whether the unit is rad, else km.
  double bound;           ///< Bound that no real sensor exceeds.
};
const BiasRange& range_of(SensorBias bias);

/// Returns the sigmas of biases of which nothing is known but their bounds: a tenth of them.
SensorBiases range_sigmas();

}  // namespace spindrift
