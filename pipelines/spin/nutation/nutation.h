/// @file
/// Detection of free nutation in the residuals of a uniform spin.
///
/// The model is that of tilt_signal.h. The strongest frequency of the spectrum is refined by least
/// squares together with amplitude and growth; the frequencies that a sensor looking once a turn
/// would take for it (n + 1, 1 - n and so on) are tried too, and the likeliest is it.
///
/// Detected is what noise would show, anywhere in the spectrum, in one of ten thousand passes. With
/// z half the chi-square of the pair of amplitudes at the best frequency, and s the standard
/// deviation of the turns at which edges are, the chance of it is at most
///
///     W sqrt(z) exp(-z),    W = 2 sqrt(4 pi) s
///
/// by Rice's formula (as in Baluev, MNRAS 385, 2008). Noise is what scatters, not what is stated.
///
/// *Unseen*: a tilt that goes round once or twice a turn, or hardly ever, within three in a pass or
/// in ten minutes of it: it looks like misplaced sensors, or another axis. A body that is not
/// axisymmetric has an elliptic cone; its round part is found.

#pragma once

#include <optional>
#include <span>
#include <vector>

#include "pipelines/core/expected.h"
#include "pipelines/spin/nutation/uniform_spin_residual.h"

namespace spindrift {

struct Estimated {
  double value;
  double sigma;
};

struct FoundNutation {
  double t_s;                  ///< In the middle of the pass.
  Estimated half_angle_rad;    ///< Then.
  Estimated growth_per_s;      ///< Of the half-angle, as a share of it.
  Estimated period_s;          ///< Of the axis round the angular momentum, as seen from outside.
  Estimated lean_azimuth_rad;  ///< In `spin`, to which the axis leans at t_s, (-pi, pi].
  double per_turn;             ///< Times round in a turn of the body.
  /// Others that explain the edges all but as well (by less than a thousand to one).
  std::vector<double> other_periods_s;
};

struct NutationSearch {
  std::optional<FoundNutation> found;
  double false_alarm;     ///< Chance that noise alone shows as much; at most 1.
  double detectable_rad;  ///< Half-angle that would be found in 95 of 100 such passes.
};

/// Time: proportional to the edges, some seconds for a day at 100 rpm.
/// @return InvalidInput for numbers that are not finite, or a sigma not above 0; Unobservable where
///         the edges are too few, or too many, or hardly move with a tilt.
Expected<NutationSearch> find_nutation(std::span<const UniformSpinResidual> residuals);

}  // namespace spindrift
