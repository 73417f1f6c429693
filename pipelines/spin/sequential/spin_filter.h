/// @file
/// Kalman filter on the sphere: spin axis, phase and rate from single edge times.
///
/// The state is a frame `spin` (edge_prediction.h) whose third axis is the spin axis, the phase of
/// the body in it at the reference time, the spin rate and its drift. Its error is small and has no
/// singularity anywhere: tilts of the axis about the frame's first and second axes, phase, rate,
/// drift. Each edge is one scalar measurement with its own noise,
///
///     phase + rate dt + drift dt^2/2 - predicted phase = 0 +/- rate sigma_t        (round the
///     circle)
///
/// with dt = t - t_ref, so any subset of the channels will do. Assumes a body that turns about a
/// fixed axis at a rate that drifts evenly, but for a slow random walk of all three.

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

/// How many times the variance of a channel's edges is what their stated noise makes it.
using ChannelNoise = std::array<double, kPulseChannels>;
inline constexpr ChannelNoise kStatedNoise = {1.0, 1.0, 1.0, 1.0, 1.0, 1.0};

/// What the edges of one revolution said to a filter.
class RevolutionObservations {
 public:
  /// @param edge At most one of each channel.
  void add(const Observation& edge) { edges_[count_++] = edge; }
  /// The residuals in seconds; an edge that is predicted not to be has none.
  std::span<const Observation> edges() const { return {edges_.data(), count_}; }

  /// Normalised, their sum; those that were left out as at the gate.
  double squared_innovations() const;

  /// Natural logarithm of the edges' probability density, 1/rad each, gated ones as spurious.
  double log_likelihood = 0.0;
  /// What the innovations of the edges that were used say of the model. The filter has eliminated
  /// axis, phase and rate from them, and made them independent (Friedland's separate-bias
  /// estimation).
  ErrorInformation errors = {};

 private:
  std::array<Observation, kPulseChannels> edges_ = {};
  std::size_t count_ = 0;
};

class SpinFilter {
 public:
  /// Four in a hundred thousand good edges lie farther out.
  static constexpr double kGateSigmas = 4.1;

  /// A filter about a known axis, its phase and rate from one revolution: so widely that the
  /// revolution's edges, which the axis may rest on, do not count twice.
  /// @param covariance_rad2 Of the axis, in the tangent plane: east, north.
  /// @return Empty when none of the revolution's edges can tell the phase.
  static std::optional<SpinFilter> about(const Eigen::Vector3d& axis_icrf,
                                         const Eigen::Matrix2d& covariance_rad2,
                                         const SpinConfig& config, const Revolution& revolution,
                                         const Sky& sky);

  /// Moves the reference time on; never back.
  void predict(TaiTime t);

  /// Works in the edges of about one revolution near the reference time.
  /// @param noise The gate opens by so much, the weights stay.
  RevolutionObservations update(const SpinConfig& config, const Sky& sky,
                                std::span<const Pulse> edges,
                                const ChannelNoise& noise = kStatedNoise);

  TaiTime t() const { return t_; }
  Eigen::Vector3d axis_icrf() const { return q_icrf_spin_ * Eigen::Vector3d::UnitZ(); }
  /// Tangent plane at the axis: east, north.
  Eigen::Matrix2d axis_covariance_rad2() const;
  /// What each error of the model has moved the axis by, rad/rad; likewise.
  Eigen::Matrix<double, 2, kModelErrors> axis_of_errors() const;
  /// What offsets of the channels' times add to the covariance of the axis; likewise.
  Eigen::Matrix2d offsets_rad2(const OffsetPrior& offsets_s2) const;
  double rate_rad_s() const { return rate_rad_s_; }
  double rate_sigma_rad_s() const;
  double phase_sigma_rad() const;

 private:
  SpinFilter(TaiTime t, Eigen::Quaterniond q_icrf_spin, double phase_rad, double rate_rad_s)
      : t_{t},
        q_icrf_spin_{std::move(q_icrf_spin)},
        phase_rad_{phase_rad},
        rate_rad_s_{rate_rad_s} {}

  /// Tilt about the frame's first and second axes, phase, rate, drift.
  using Error = Eigen::Matrix<double, 5, 1>;

  struct RevolutionEdges {
    const SpinConfig& config;
    const Sky& sky;
    std::span<const Pulse> edges;
    const ChannelNoise& noise;
    PlacedSensors sensors;
  };
  /// What is done with edges that the present state predicts not to exist.
  enum class Missing { Approached, LeftOut };
  struct Linearised {
    double moved_rad = 0.0;   ///< The axis, by the update.
    double steepest = 1.0;    ///< Change of an edge's phase with the axis, rad/rad.
    bool approached = false;  ///< The update used edges that the state does not have.
  };
  /// An edge as the present state predicts it.
  struct Measured {
    Pulse edge;
    double residual_rad;  ///< Of the phase; by any number of turns more.
    double sigma_rad;
    Error slope;
    Eigen::Matrix<double, 1, kModelErrors> per_error;
    double per_offset_rad_s;  ///< Change of the phase for a second that the channel is late.
  };
  Linearised update_linearised_here(const SpinFilter& prior, const RevolutionEdges& seen,
                                    Missing missing, RevolutionObservations& said);
  Observation work_in(const Measured& measured, double gate, Error& error,
                      RevolutionObservations& said);
  Error error_of(const SpinFilter& truth) const;
  void correct(const Error& error);

  TaiTime t_;
  Eigen::Quaterniond q_icrf_spin_;
  double phase_rad_;  ///< Of slit 1 at `t_`.
  double rate_rad_s_;
  double drift_rad_s2_ = 0.0;
  Eigen::Matrix<double, 5, 5> covariance_ = Eigen::Matrix<double, 5, 5>::Zero();  ///< Of the error.
  /// The error that each error of the model has made, per rad of it.
  Eigen::Matrix<double, 5, kModelErrors> of_errors_ =
      Eigen::Matrix<double, 5, kModelErrors>::Zero();
  /// Likewise the offset of each channel's times, per second.
  Eigen::Matrix<double, 5, kChannelOffsets> of_offsets_ =
      Eigen::Matrix<double, 5, kChannelOffsets>::Zero();
};

/// The good edges of a revolution; of channels without a sensor none are.
class GoodEdges {
 public:
  GoodEdges(const SpinConfig& config, const Revolution& revolution);
  std::span<const Pulse> span() const { return {edges_.data(), count_}; }

 private:
  std::array<Pulse, kPulseChannels> edges_;
  std::size_t count_ = 0;
};

}  // namespace spindrift
