/// @file
/// When in its turn the body gives an edge: the model that estimators fit to edge times.
///
/// The frame `spin` stands still: third axis on the spin axis, the others anywhere across it. The
/// body turns right-handed about the third; its phase is the azimuth of slit 1 in that frame.
/// With s the Sun in it, and theta_s its angle from the axis:
///
///     sun1         phase = azimuth of s
///     sun2         phase = azimuth of s + psi0 + asin(tan I cot theta_s)
///     north, south phase = azimuth where the beam crosses the limb (horizon.h) + a
///
/// with theta_s, psi0, the mounting angle, the limb's height, a and the ends of the chord as the
/// biases of the sensors have them (sensor_biases.h).

#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>

#include "pipelines/spin/sensor_model/coning.h"
#include "pipelines/spin/sensor_model/horizon.h"
#include "pipelines/spin/types/config.h"
#include "pipelines/spin/types/model_allowance.h"
#include "pipelines/spin/types/pulse.h"
#include "pipelines/spin/types/sensor_biases.h"
#include "pipelines/spin/types/sky.h"

namespace spindrift {

struct PredictedEdge {
  double phase_rad;  ///< (-pi, pi]
  /// Change of the phase, rad/rad, when the frame turns by a small vector about its own axes: the
  /// first two are tilts of the spin axis, the third is -1.
  Eigen::Vector3d phase_per_rotation;
  /// Likewise, for a radian of each error of the model: the limb farther out, the sun angle
  /// measured too large, the beam farther behind slit 1.
  Eigen::Matrix<double, 1, kModelErrors> phase_per_error;
  /// Likewise, for each bias; rad/rad, or rad/km.
  Eigen::Matrix<double, 1, kSensorBiases> phase_per_bias;
};

/// Where coning has the sensors look from the body, and the horizon with its bias: the same for all
/// edges of a state. The other biases are added at each edge.
struct PlacedSensors {
  PlacedSensors(const SpinConfig& config, SensorBiases sensor_biases);

  SensorBiases biases;
  ConedSlit sun1;
  ConedSlit sun2;
  std::array<std::optional<ConedBeam>, 2> beams;  ///< By Side.
  HorizonAxes horizon;
};

/// @param edge Its time says where the Earth then stands.
/// @return Empty when there is no such edge: the sensor does not exist, the slit cannot see so far
///         from its equator, or the beam misses the Earth; or one of these nearly.
std::optional<PredictedEdge> predict_edge(const PlacedSensors& sensors, const Sky& sky,
                                          const Eigen::Matrix3d& R_spin_icrf, const Pulse& edge);

/// Of one edge alone, by sensors without a bias.
std::optional<PredictedEdge> predict_edge(const SpinConfig& config, const Sky& sky,
                                          const Eigen::Matrix3d& R_spin_icrf, const Pulse& edge);

/// For an observed edge that the state (nearly) does not have: the beam's depth in the disc when it
/// came, linearised. Less curved than the edge time, which near the limb goes as a square root; but
/// as it has the noise of the edge's azimuth, only to find a state that has the edge.
/// @param phase_rad Of slit 1 when it came, as the state has it.
/// @param sigma_rad Of the edge's noise.
/// @return The third of its `phase_per_rotation` is not -1. Nothing by errors or biases. Empty for
///         a slit, and for a beam that points away from the Earth or does not exist.
std::optional<PredictedEdge> linearise_by_depth(const SpinConfig& config, const Sky& sky,
                                                const Eigen::Matrix3d& R_spin_icrf,
                                                const Pulse& edge, double phase_rad,
                                                double sigma_rad);

}  // namespace spindrift
