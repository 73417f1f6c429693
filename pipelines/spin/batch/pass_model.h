/// @file
/// What a body that spins about an axis at rest, at a rate that drifts evenly, and may nutate about
/// it, gives of edges, and how far those that came are from it. In the unknowns
///
///     tilt x, tilt y, phase      rotation of the frame `spin` about its own axes, rad
///     rate, drift                each as the angle that it makes at the ends of the pass, rad
///     biases                     sensor_biases.h
///     nutation                   of a stretch of the pass that has it, nutation_stretch.h
///
/// an edge is one equation, (rate dt + drift dt^2/2 - phase predicted) / (rate sigma_t) = noise of
/// one standard deviation, with dt from the middle of the pass: the time of a pulse, whitened.

#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "pipelines/core/expected.h"
#include "pipelines/ephemeris/orbit.h"
#include "pipelines/spin/batch/nutation_stretch.h"
#include "pipelines/spin/sensor_model/edge_prediction.h"
#include "pipelines/spin/types/config.h"
#include "pipelines/spin/types/pulse.h"
#include "pipelines/spin/types/sensor_biases.h"
#include "pipelines/spin/types/sky.h"

namespace spindrift {

/// An edge that a revolution had a place for.
struct PassEdge {
  Pulse pulse;
  std::int64_t revolution;
};

/// The frame `spin` has its third axis on the spin axis and turns with the rest of the sky: at the
/// middle of the pass slit 1 is on its first axis.
struct SpinState {
  Eigen::Quaterniond q_icrf_spin;
  double rate_rad_s;  ///< At the middle of the pass.
  double drift_rad_s2;
  SensorBiases biases = SensorBiases::Zero();
  std::vector<NutationStretch> nutation = {};  ///< In order of time, apart from each other.

  Eigen::Vector3d axis_icrf() const { return q_icrf_spin * Eigen::Vector3d::UnitZ(); }
};

inline constexpr int kMotionUnknowns = 5;
inline constexpr int kBatchUnknowns = kMotionUnknowns + kSensorBiases;
using EdgeSlopes = Eigen::Matrix<double, 1, kBatchUnknowns>;

/// Where a state expects an edge, and where it came.
struct ComparedEdge {
  PredictedEdge expected;  ///< Its change by rotation that of the frame `spin`, not of the tipped.
  double phase_rad;        ///< Azimuth of slit 1 when it came, counted on from turn to turn.
  double off_rad;          ///< More than expected by so much.
  double sigma_rad;        ///< Of its noise.
  double rate_rad_s;
  /// Change of `off_rad` with the phase, and with the unknowns of the stretch that it is in.
  double off_per_phase = 1.0;
  NutationSlopes off_per_nutation = NutationSlopes::Zero();
};

/// An edge against a state.
struct EdgeResidual {
  double off;         ///< In standard deviations of its noise; positive: late.
  EdgeSlopes slopes;  ///< Of `off`.
  NutationSlopes nutation_slopes = NutationSlopes::Zero();
};

class PassModel;

/// The model at one state: what all its edges share is found once.
class PassAtState {
 public:
  /// @param model Outlives it.
  PassAtState(const PassModel& model, SpinState state);

  const SpinState& state() const { return state_; }
  /// @return Empty where the state has no such edge; likewise the following.
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
  /// @param edges In order of time, at least one.
  /// @return NoCoverage where the orbit does not reach all of them.
  static Expected<PassModel> make(const SpinConfig& config, const Orbit& orbit,
                                  std::span<const PassEdge> edges);

  PassAtState at(SpinState state) const { return {*this, std::move(state)}; }

  const SpinConfig& config() const { return config_; }
  const Sky& sky_at(TaiTime t) const;
  TaiTime middle() const { return middle_; }
  double half_s() const { return half_s_; }  ///< From the middle of the pass to its ends.

 private:
  PassModel(SpinConfig config, TaiTime first, TaiTime last);
  std::size_t span_of(TaiTime t) const;

  SpinConfig config_;
  TaiTime first_;
  TaiTime middle_;
  double half_s_;
  std::vector<Sky> skies_;  ///< One for every kSkySpan_s.
};

}  // namespace spindrift
