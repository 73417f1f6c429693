/// @file
/// Kalman filter on the sphere: spin axis, phase and rate from single edge times.
///
/// The state is a frame `spin` (edge_prediction.h) whose third axis is the spin axis, the phase of
/// the body in it at the reference time, the spin rate and its drift. The error state has no
/// singularity: tilts of the axis about the frame's first and second axes, phase, rate, drift. Each
/// edge is one scalar measurement with its own noise,
///
///     phase + rate dt + drift dt^2/2 - predicted phase = 0 +/- rate sigma_t    (modulo one turn)
///
/// with dt = t - t_ref, so any subset of the channels will do. The body is assumed to turn about a
/// fixed axis at a uniformly drifting rate, with a slow random walk of all three.
///
/// Errors b of the mission file, with prior covariance B, do not enter the gains: the filter
/// carries the sensitivity S of its state to them. Then an innovation is
///
///     nu = h b + noise of variance v,    h = H S + H_b
///
/// and the gate is that of its total variance, v + h B h'. As b is one draw a pass, innovations are
/// not independent. Those less what the pass so far says of b are (separate-bias estimation):
/// nu - h m has the variance v + h C h', where m and C follow b as a state. Likelihoods and tests
/// of the noise use these.

#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <utility>

#include "pipelines/observation/observation.h"
#include "pipelines/spin/sensor_model/edge_prediction.h"
#include "pipelines/spin/types/config.h"
#include "pipelines/spin/types/model_allowance.h"
#include "pipelines/spin/types/pulse.h"
#include "pipelines/spin/types/revolution.h"
#include "pipelines/spin/types/sky.h"
#include "pipelines/time/tai_time.h"

namespace spindrift {

/// Ratio of the observed to the stated variance of the edges, per channel.
using ChannelNoise = std::array<double, kPulseChannels>;
inline constexpr ChannelNoise kStatedNoise = {1.0, 1.0, 1.0, 1.0, 1.0, 1.0};

/// Holds the observations of one filter from the edges of one revolution.
class RevolutionObservations {
 public:
  /// @param edge Observation of an edge, at most one per channel.
  void add(const Observation& edge) { add(edge, edge); }
  /// @param independent The same, less what earlier ones say of the mission file's errors.
  void add(const Observation& edge, const Observation& independent) {
    independent_[count_] = independent;
    edges_[count_++] = edge;
  }
  /// Observations with residuals in seconds; an edge that the state does not predict has no
  /// residual.
  std::span<const Observation> edges() const { return {edges_.data(), count_}; }

  /// Sum of the NIS values of the independent observations, each bounded by its gate.
  double squared_innovations() const;

  /// Log probability density of the edges, per rad each; gated edges count as spurious.
  double log_likelihood = 0.0;
  /// The observations less what earlier ones say of the mission file's errors: independent.
  std::span<const Observation> independent() const { return {independent_.data(), count_}; }
  /// Evidence of model errors from the innovations used, with axis, phase and rate eliminated and
  /// the innovations decorrelated by the filter (Friedland's separate-bias estimation).
  ErrorInformation errors = {};

 private:
  std::array<Observation, kPulseChannels> edges_ = {};
  std::array<Observation, kPulseChannels> independent_ = {};
  std::size_t count_ = 0;
};

class SpinFilter {
 public:
  /// Four in a hundred thousand good edges lie outside this gate.
  static constexpr double kGateSigmas = 4.1;

  /// Starts a filter at a known axis with phase and rate of one revolution. Their initial sigmas
  /// are wide, so that edges that the axis may rest on do not count twice.
  /// @param covariance_rad2 Covariance of the axis in the tangent plane: east, north.
  /// @return Empty when none of the revolution's edges determines the phase.
  static std::optional<SpinFilter> about(const Eigen::Vector3d& axis_icrf,
                                         const Eigen::Matrix2d& covariance_rad2,
                                         const SpinConfig& config, const Revolution& revolution,
                                         const Sky& sky);

  /// Propagates the state to `t`; times before the reference time are ignored.
  void predict(TaiTime t);

  /// Updates the state with the edges of about one revolution near the reference time.
  /// @param noise Factors that widen the gate but do not change the weights.
  RevolutionObservations update(const SpinConfig& config, const Sky& sky,
                                std::span<const Pulse> edges,
                                const ChannelNoise& noise = kStatedNoise);

  TaiTime t() const { return t_; }
  Eigen::Vector3d axis_icrf() const { return q_icrf_spin_ * Eigen::Vector3d::UnitZ(); }
  /// Covariance in the tangent plane at the axis: east, north.
  Eigen::Matrix2d axis_covariance_rad2() const;
  /// Axis motion per model error in the tangent plane: east, north; rad/rad.
  Eigen::Matrix<double, 2, kModelErrors> axis_of_errors() const;
  /// Axis covariance that considered parameters add, in the tangent plane.
  Eigen::Matrix2d considered_rad2(const ConsideredPrior& prior) const;
  /// Axis covariance by noise and by what the mission file may be off, in the tangent plane.
  Eigen::Matrix2d total_covariance_rad2() const {
    return axis_covariance_rad2() + considered_rad2(considered_prior(alignment_));
  }
  /// True axis minus this one per error of the mission file, ICRF.
  Eigen::Matrix<double, 3, kSpinAlignmentErrors> axis_of_alignment_icrf() const;
  double rate_rad_s() const { return rate_rad_s_; }
  double rate_sigma_rad_s() const;
  /// Part of the variance of the rate that errors of the mission file make.
  double rate_alignment_rad2_s2() const;
  double phase_sigma_rad() const;

 private:
  SpinFilter(TaiTime t, Eigen::Quaterniond q_icrf_spin, double phase_rad, double rate_rad_s)
      : t_{t},
        q_icrf_spin_{std::move(q_icrf_spin)},
        phase_rad_{phase_rad},
        rate_rad_s_{rate_rad_s} {}

  /// Tilts about the frame's first and second axes, phase, rate, drift.
  using Error = Eigen::Matrix<double, 5, 1>;

  struct RevolutionEdges {
    const SpinConfig& config;
    const Sky& sky;
    std::span<const Pulse> edges;
    const ChannelNoise& noise;
    PlacedSensors sensors;
  };
  /// Selects how to treat edges that the present state does not predict.
  enum class Missing { Approached, LeftOut };
  struct Linearised {
    double moved_rad = 0.0;   ///< Axis motion by the update.
    double steepest = 1.0;    ///< Steepest slope of an edge's phase with the axis, rad/rad.
    bool approached = false;  ///< True if unpredicted edges were used.
  };
  /// Holds an edge as the present state predicts it.
  struct Measured {
    Pulse edge;
    double residual_rad;  ///< Phase residual, modulo one turn.
    double sigma_rad;
    Error slope;
    Eigen::Matrix<double, 1, kModelErrors> per_error;
    PerConsidered per_considered;
  };
  Linearised update_linearised_here(const SpinFilter& prior, const RevolutionEdges& seen,
                                    Missing missing, RevolutionObservations& said);
  bool work_in(const Measured& measured, double gate, Error& error, RevolutionObservations& said);
  void learn_alignment(const Eigen::Matrix<double, 1, kSpinAlignmentErrors>& slope, double left,
                       double variance);
  Error error_of(const SpinFilter& truth) const;
  void correct(const Error& error);

  TaiTime t_;
  Eigen::Quaterniond q_icrf_spin_;
  double phase_rad_;  ///< Azimuth of slit 1 at `t_`.
  double rate_rad_s_;
  double drift_rad_s2_ = 0.0;
  Eigen::Matrix<double, 5, 5> covariance_ = Eigen::Matrix<double, 5, 5>::Zero();
  /// Sensitivity of the error state to each model error, per rad.
  Eigen::Matrix<double, 5, kModelErrors> of_errors_ =
      Eigen::Matrix<double, 5, kModelErrors>::Zero();
  /// Sensitivity of the error state to considered parameters.
  Eigen::Matrix<double, 5, kSpinConsidered> of_considered_ =
      Eigen::Matrix<double, 5, kSpinConsidered>::Zero();
  SpinAlignment alignment_ = SpinAlignment::Zero();  ///< Prior covariance of the errors.
  /// Mean and covariance of the errors by the innovations so far.
  SpinAlignmentVector learnt_ = SpinAlignmentVector::Zero();
  SpinAlignment unknown_ = SpinAlignment::Zero();
};

/// Selects the good edges of a revolution from channels that have a sensor.
class GoodEdges {
 public:
  GoodEdges(const SpinConfig& config, const Revolution& revolution);
  std::span<const Pulse> span() const { return {edges_.data(), count_}; }

 private:
  std::array<Pulse, kPulseChannels> edges_;
  std::size_t count_ = 0;
};

}  // namespace spindrift
