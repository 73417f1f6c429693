/// @file
/// Predicts the edges of a body that spins about a fixed axis at a uniformly drifting rate and may
/// nutate about it, and compares them with the edges that came. In the unknowns
///
///     tilt x, tilt y, phase      rotation of the frame `spin` about its own axes, rad
///     rate, drift                each as the angle that it makes at the ends of the pass, rad
///     biases                     sensor_biases.h
///     nutation                   of a stretch of the pass, nutation_stretch.h
///
/// an edge is one equation, (rate dt + drift dt^2/2 - phase predicted) / (rate sigma_t) = noise of
/// one standard deviation. This is the whitened time of a pulse, with dt from the middle of the
/// pass.

#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cmath>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "pipelines/core/expected.h"
#include "pipelines/ephemeris/orbit.h"
#include "pipelines/frames/celestial.h"
#include "pipelines/spin/batch/nutation_stretch.h"
#include "pipelines/spin/sensor_model/edge_prediction.h"
#include "pipelines/spin/types/config.h"
#include "pipelines/spin/types/pulse.h"
#include "pipelines/spin/types/sensor_biases.h"
#include "pipelines/spin/types/sky.h"

namespace spindrift {

/// Holds an edge that was assigned to a revolution.
struct PassEdge {
  Pulse pulse;
  std::int64_t revolution;
};

/// Holds the state of the body. The frame `spin` has its third axis on the spin axis and is fixed
/// to the sky; at the middle of the pass slit 1 is on its first axis.
struct SpinState {
  Eigen::Quaterniond q_icrf_spin;
  double rate_rad_s;  ///< Spin rate at the middle of the pass.
  double drift_rad_s2;
  SensorBiases biases = SensorBiases::Zero();
  std::vector<NutationStretch> nutation = {};  ///< Stretches in order of time, without overlap.

  Eigen::Vector3d axis_icrf() const { return q_icrf_spin * Eigen::Vector3d::UnitZ(); }
};

inline constexpr int kMotionUnknowns = 5;
inline constexpr int kBatchUnknowns = kMotionUnknowns + kSensorBiases;
using EdgeSlopes = Eigen::Matrix<double, 1, kBatchUnknowns>;

/// Compares where a state expects an edge with where it came.
struct ComparedEdge {
  PredictedEdge expected;  ///< Prediction, with slopes for the untipped `spin`.
  double phase_rad;        ///< Azimuth of slit 1 at the edge, counted on over revolutions.
  double off_rad;          ///< Azimuth beyond the expected one.
  double sigma_rad;        ///< Noise of the edge as an angle.
  double rate_rad_s;
  /// Change of `off_rad` with the phase, and with the unknowns of the stretch that holds the edge.
  double off_per_phase = 1.0;
  NutationSlopes off_per_nutation = NutationSlopes::Zero();
};

/// Holds the whitened residual of an edge against a state.
struct EdgeResidual {
  double off;         ///< Residual in standard deviations of the noise; positive when late.
  EdgeSlopes slopes;  ///< Derivatives of `off` by the unknowns.
  NutationSlopes nutation_slopes = NutationSlopes::Zero();
  /// Change of `off` where the mission file is off, per unit of alignment.h.
  Eigen::Matrix<double, 1, kSpinAlignmentErrors> per_alignment =
      Eigen::Matrix<double, 1, kSpinAlignmentErrors>::Zero();

  /// Returns the standard deviation of `off` by noise and by what the mission file may be off.
  double sigma(const SpinAlignment& alignment) const {
    return std::sqrt(1.0 + per_alignment * alignment * per_alignment.transpose());
  }
};

class PassModel;

/// Evaluates the model at one state, sharing the work that all edges have in common.
class PassAtState {
 public:
  /// @param model Must outlive this object.
  PassAtState(const PassModel& model, SpinState state);

  const SpinState& state() const { return state_; }
  /// @return Empty when the state predicts no such edge.
  std::optional<ComparedEdge> meet(const Pulse& edge) const;
  std::optional<EdgeResidual> residual(const Pulse& edge) const;

 private:
  const PassModel* model_;
  SpinState state_;
  Eigen::Matrix3d R_spin_icrf_;
  PlacedSensors sensors_;
};

class PassModel {
 public:
  /// @param edges Edges in order of time, at least one.
  /// @return NoCoverage when the orbit does not cover all edges.
  static Expected<PassModel> make(const SpinConfig& config, const Orbit& orbit,
                                  std::span<const PassEdge> edges);

  PassAtState at(SpinState state) const { return {*this, std::move(state)}; }

  const SpinConfig& config() const { return config_; }
  const Sky& sky_at(TaiTime t) const;
  /// Returns the sun angle that a state has at the middle of the pass.
  double sun_angle_rad(const SpinState& state) const {
    return angle_between_rad(state.axis_icrf(), sky_at(middle_).sun_icrf);
  }
  TaiTime middle() const { return middle_; }
  double half_s() const { return half_s_; }  ///< Half length of the pass, at least 1 s.

 private:
  PassModel(SpinConfig config, TaiTime first, TaiTime last);
  std::size_t span_of(TaiTime t) const;

  SpinConfig config_;
  TaiTime first_;
  TaiTime middle_;
  double half_s_;
  std::vector<Sky> skies_;  ///< Sun and Earth, one entry per kSkySpan_s.
};

}  // namespace spindrift
