/// @file
/// The edges of a pass as measurements of a small tilt that turns.
///
/// The body, tipped in the frame `spin` by a small rotation (e_x, e_y), gives an edge at the
/// azimuth
///
///     off = s_x e_x + s_y e_y,    s = PredictedEdge::phase_per_rotation
///
/// Free nutation of an axisymmetric body is a rotation of constant size whose direction goes round
/// evenly, e_x + i e_y = g exp(2 pi i n x), with x the turns of the body and n times in each of
/// them. To first order it has no part about the spin axis, so that the phase is not modulated
/// besides: that the period seems to vary is the work of the slopes s. So
///
///     off = Re(conj(S) g exp(2 pi i n x)) = Re(g) Re(q) + Im(g) Im(q),
///     q = S exp(-2 pi i n x),    S = s_x + i s_y
///
/// Whatever changes slowly in a channel (axis, phase, rate and its drift, misplaced sensors, the
/// shape of the Earth) is a parabola of its own in each stretch of ten minutes, and a share of what
/// an error of the model does (which grows without bound where a chord vanishes). It is taken out:
/// of the residuals and of what is fitted to them.

#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "pipelines/spin/nutation/uniform_spin_residual.h"

namespace spindrift {

/// In units of standard deviations, by channel and time. Short stretches are left out.
class TiltSignal {
 public:
  /// @param residuals In any order; finite, sigma above 0.
  explicit TiltSignal(std::span<const UniformSpinResidual> residuals);

  Eigen::Index edges() const { return turns_.size(); }
  /// x, behind the middle of the pass.
  const Eigen::VectorXd& turns() const { return turns_; }
  double middle_s() const { return middle_s_; }
  double spin_period_s() const { return spin_period_s_; }         ///< On average.
  const Eigen::VectorXd& off() const { return off_; }             ///< Less its slow changes.
  const Eigen::VectorXcd& per_tilt() const { return per_tilt_; }  ///< S.
  /// Edges less the unknowns of their slow changes.
  double freedom() const;
  /// Of the longest stretch.
  double turns_in_stretch() const { return turns_in_stretch_; }

  /// Columns Re(q) and Im(q), with their slow changes.
  /// @param per_turn n.
  Eigen::MatrixX2d pattern(double per_turn) const;

  /// Takes the slow changes out of each column.
  void take_out_slow_changes(Eigen::Ref<Eigen::MatrixXd> columns) const;

  /// Weighs each channel by how far its edges really scatter.
  /// @param rest What a fit leaves of `off()`.
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
  Eigen::MatrixX4d slow_;  ///< Of each stretch, orthonormal.
  std::vector<Stretch> stretches_;
};

}  // namespace spindrift
