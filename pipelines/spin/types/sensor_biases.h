/// @file
/// What may be wrong with the sensors of a pass, and stays the same in every revolution: the
/// unknowns that the estimator `batch` can determine beside axis and rate.

#pragma once

#include <Eigen/Core>
#include <bitset>
#include <string_view>

namespace spindrift {

/// True value minus that of the mission file; of measured angles, measured minus true.
enum SensorBias {
  SunAngleBias,         ///< rad, of the measured sun angle.
  SlitSeparationBias,   ///< rad, psi0.
  NorthChordBias,       ///< rad, of the measured chord: half of it at either end.
  SouthChordBias,       ///< rad
  NorthMountAngleBias,  ///< rad, gamma_N.
  SouthMountAngleBias,  ///< rad, gamma_S.
  DihedralBias,         ///< rad, of the azimuth of both beams behind slit 1.
  Co2HeightBias,        ///< km, of the infrared horizon.
  ConingX,              ///< rad, of coning.h; with ConingY one thing, known or unknown together.
  ConingY,              ///< rad
};
inline constexpr int kSensorBiases = 10;
using SensorBiases = Eigen::Matrix<double, kSensorBiases, 1>;

using BiasSet = std::bitset<kSensorBiases>;

/// The bias, or of coning both.
BiasSet unknowns_of(SensorBias bias);

/// The prior of a bias: zero within sigma.
struct BiasPrior {
  std::string_view name;  ///< As in mission file and archive.
  bool is_angle;          ///< rad; else km.
  double sigma;           ///< One standard deviation about zero.
  double bound;           ///< What no real sensor exceeds.
};
const BiasPrior& prior_of(SensorBias bias);

}  // namespace spindrift
