/// @file
/// Predicts the phase of the body at an edge, the model that estimators fit to edge times, and the
/// information of edges on the spin axis.
///
/// The frame `spin` is inertial, with the third axis on the spin axis and the others anywhere
/// across it. The body turns right-handed about the third axis; its phase is the azimuth of slit 1
/// in that frame. With s the Sun direction in it, and theta_s its angle from the axis:
///
///     sun1         phase = azimuth of s
///     sun2         phase = azimuth of s + psi0 + asin(tan I cot theta_s)
///     north, south phase = azimuth where the beam crosses the limb (horizon.h) + a
///
/// The biases of the sensors (sensor_biases.h) change theta_s, psi0, the mounting angle, the limb's
/// height, a and the ends of the chord.
///
/// Leaving out the edges of beams that just miss the limb by the state was rejected: a filter then
/// stayed beside the truth (linearise_by_depth). Leaving out sun edges within 6 deg of the axis was
/// rejected as well: the candidate near the Sun then lost against a false one.

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
  /// Change of the phase per small rotation of the frame about its own axes, rad/rad: the first two
  /// are tilts of the spin axis, the third is -1.
  Eigen::Vector3d phase_per_rotation;
  /// Change of the phase per model error, rad/rad: limb farther out, sun angle measured too large,
  /// beam farther behind slit 1.
  Eigen::Matrix<double, 1, kModelErrors> phase_per_error;
  /// Change of the phase per bias, rad/rad or rad/km.
  Eigen::Matrix<double, 1, kSensorBiases> phase_per_bias;
  /// Change of the phase per error of the mission file, in rad per unit of alignment.h. A late time
  /// tag turns the body as well, which the phase takes up: what is left is the motion of the Earth.
  Eigen::Matrix<double, 1, kSpinAlignmentErrors> phase_per_alignment;
};

/// Holds the sensors' directions in the body with coning, and the horizon with its bias, shared by
/// all edges of a state. The other biases are added at each edge.
struct PlacedSensors {
  PlacedSensors(const SpinConfig& config, SensorBiases sensor_biases);

  SensorBiases biases;
  ConedSlit sun1;
  ConedSlit sun2;
  std::array<std::optional<ConedBeam>, 2> beams;  ///< Beams by Side.
  HorizonAxes horizon;
};

/// @param edge Edge whose time gives the position of the Earth.
/// @return Empty when there is no such edge, or nearly none: the sensor does not exist, the slit
/// cannot see so far from its equator, or the beam misses the Earth.
std::optional<PredictedEdge> predict_edge(const PlacedSensors& sensors, const Sky& sky,
                                          const Eigen::Matrix3d& R_spin_icrf, const Pulse& edge);

/// Predicts one edge with unbiased sensors.
std::optional<PredictedEdge> predict_edge(const SpinConfig& config, const Sky& sky,
                                          const Eigen::Matrix3d& R_spin_icrf, const Pulse& edge);

/// Linearises the beam's depth in the Earth's disc at an observed edge that the state (nearly) does
/// not have. Depth is less curved than edge time, which varies as a square root near the limb. It
/// has the noise of the edge's azimuth, so it only serves to find a state that has the edge.
/// @param phase_rad Phase of slit 1 at the edge by the state.
/// @param sigma_rad Noise of the edge.
/// @return Prediction without slopes by errors, biases or alignment, whose third slope by rotation
/// is not -1. Empty for a slit, and for a beam that points away from the Earth or does not exist.
std::optional<PredictedEdge> linearise_by_depth(const SpinConfig& config, const Sky& sky,
                                                const Eigen::Matrix3d& R_spin_icrf,
                                                const Pulse& edge, double phase_rad,
                                                double sigma_rad);

/// Sums Fisher's information of predicted edges, which gives the Cramer-Rao bound, which no
/// unbiased estimator can beat. Each edge is one equation (as in spin_filter.h)
///
///     phase + rate dt + drift dt^2/2 - predicted phase = 0 +/- sigma
///
/// in the tilts of the axis about the first and second axis of the frame `spin`, and in phase, rate
/// and drift, which have no prior.
class EdgeInformation {
 public:
  /// @param edge Predicted edge; all edges need the same frame `spin`.
  /// @param dt_s Time from an epoch common to all edges.
  /// @param sigma_rad Standard deviation of the phase: spin rate times that of the edge time.
  /// @param weight Number of such edges.
  void add(const PredictedEdge& edge, double dt_s, double sigma_rad, double weight = 1.0);

  /// Returns the covariance of the axis along the first and second axis of the frame. Empty if its
  /// standard deviation exceeds half a radian in some direction, where slopes mean nothing.
  std::optional<Eigen::Matrix2d> axis_covariance_rad2() const;

 private:
  Eigen::Matrix<double, 5, 5> normal_ = Eigen::Matrix<double, 5, 5>::Zero();
};

}  // namespace spindrift
