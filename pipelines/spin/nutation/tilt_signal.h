/// @file
/// Treats the edges of a pass as measurements of a small rotating tilt, and finds its frequency.
///
/// The body, tipped in the frame `spin` by a small rotation (e_x, e_y), gives an edge at the
/// azimuth
///
///     off = s_x e_x + s_y e_y,    s = PredictedEdge::phase_per_rotation
///
/// Free nutation of an axisymmetric body is a rotation of constant size whose direction turns
/// uniformly, e_x + i e_y = g exp(2 pi i n x), with x the turns of the body and n cycles per turn.
/// To first order it has no part about the spin axis and does not modulate the phase: the period
/// seems to vary only through the slopes s. So
///
///     off = Re(conj(S) g exp(2 pi i n x)) = Re(g) Re(q) + Im(g) Im(q),
///     q = S exp(-2 pi i n x),    S = s_x + i s_y
///
/// Slow changes in a channel (axis, phase, rate and its drift, misplaced sensors, the shape of the
/// Earth) are modelled, per stretch of ten minutes, by a parabola and a share of the effect of a
/// model error (which grows without bound where a chord vanishes). They are taken out of the
/// residuals and of the functions fitted to them.

#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "pipelines/spin/sensor_model/edge_prediction.h"
#include "pipelines/spin/types/pulse.h"

namespace spindrift {

/// Residual of a good edge, in the frame `spin` (edge_prediction.h) about the uniform-spin axis.
struct UniformSpinResidual {
  PulseChannel channel;
  double t_s;  ///< Time from any epoch.
  /// Expected azimuth of slit 1 at the edge, counted over turns: phase_rad / 2 pi. The phase at t_s
  /// is not used, because its noise is that of off_rad.
  double turns;
  double off_rad;    ///< Azimuth of slit 1 at the edge less the expected one.
  double sigma_rad;  ///< Noise of `off_rad`: edge-time noise times spin rate.
  PredictedEdge expected;
};

/// Holds the residuals in standard deviations, by channel and time, without short stretches.
class TiltSignal {
 public:
  /// @param residuals Residuals in any order; all finite, sigma above 0.
  explicit TiltSignal(std::span<const UniformSpinResidual> residuals);

  Eigen::Index edges() const { return turns_.size(); }
  /// Turns x counted from the middle of the pass.
  const Eigen::VectorXd& turns() const { return turns_; }
  double middle_s() const { return middle_s_; }
  double spin_period_s() const { return spin_period_s_; }  ///< Mean spin period.
  const Eigen::VectorXd& off() const { return off_; }      ///< Residuals without slow changes.
  const Eigen::VectorXcd& per_tilt() const { return per_tilt_; }  ///< Slopes S.
  /// Returns the number of edges less the unknowns of their slow changes.
  double freedom() const;
  /// Turns in the longest stretch.
  double turns_in_stretch() const { return turns_in_stretch_; }

  /// Returns the columns Re(q) and Im(q), including their slow changes.
  /// @param per_turn Cycles n of the tilt in a turn.
  Eigen::MatrixX2d pattern(double per_turn) const;

  /// Removes the slow changes from each column.
  void take_out_slow_changes(Eigen::Ref<Eigen::MatrixXd> columns) const;

  /// Reweights each channel by its observed scatter.
  /// @param rest Residuals of a fit to `off()`.
  void weigh_by(const Eigen::VectorXd& rest);

 private:
  using Edges = std::span<const UniformSpinResidual* const>;
  struct Stretch {
    PulseChannel channel;
    Eigen::Index first;
    Eigen::Index edges;
  };

  void reserve(Eigen::Index edges);
  void add_stretch(Edges stretch, Eigen::Index first);
  void count_from_the_middle(const std::vector<Edges>& stretches);

  double middle_s_ = 0.0;
  double spin_period_s_ = 0.0;
  double turns_in_stretch_ = 0.0;
  Eigen::VectorXd turns_;
  Eigen::VectorXd off_;
  Eigen::VectorXcd per_tilt_;
  Eigen::MatrixX4d slow_;  ///< Orthonormal basis of each stretch.
  std::vector<Stretch> stretches_;
};

/// Fastest nutation of an axisymmetric body, whose moment of inertia about the axis is at most the
/// sum of the other two.
inline constexpr double kFastestPerTurn = 2.0;

/// Returns the distance from whole cycles per turn within which a tilt looks like a slow change.
double unseen_per_turn(const TiltSignal& signal);

/// Returns the frequency of the greatest |D|, to a quarter of the pass's resolution.
///
/// With w the residuals times their slopes, D(n) = sum of w exp(-2 pi i n x) is the spectrum of a
/// tilt at n cycles per turn, over all edges at once. The six edges of a turn have different
/// phases, so that n and n + 1 differ, which a sensor that looks once a turn cannot tell apart. The
/// spectrum is computed by one FFT over edges spread onto a uniform grid of eight points per turn.
/// @param signal Signal with at least twenty turns in a stretch.
double strongest_per_turn(const TiltSignal& signal);

}  // namespace spindrift
