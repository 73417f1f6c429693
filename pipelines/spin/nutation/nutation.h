/// @file
/// Detects free nutation in the residuals of a uniform spin.
///
/// The model is that of tilt_signal.h. The strongest frequency of the spectrum is refined by least
/// squares together with amplitude and growth. Its aliases for a sensor that looks once a turn (n +
/// 1, 1 - n and so on) are tried too, and the likeliest frequency is taken.
///
/// The detection threshold lets noise pass, anywhere in the spectrum, in one of ten thousand
/// passes. With z half the chi-square of the pair of amplitudes at the best frequency, and s the
/// standard deviation of the turns at which edges are, the chance of a false alarm is at most
///
///     W sqrt(z) exp(-z),    W = 2 sqrt(4 pi) s
///
/// by Rice's formula (as in Baluev, MNRAS 385, 2008). The noise is the observed scatter, not the
/// stated noise.
///
/// *Unseen*: frequencies within three cycles per ten minutes (or per pass, if shorter) of 0, 1 or 2
/// cycles a turn, which look like misplaced sensors or another axis. A body that is not
/// axisymmetric has an elliptic cone, of which the circular part is found.
///
/// A periodogram of the sun angle was rejected: a sensor that looks once a turn confuses
/// frequencies.

#pragma once

#include <optional>
#include <span>
#include <vector>

#include "pipelines/core/expected.h"
#include "pipelines/spin/nutation/tilt_signal.h"

namespace spindrift {

struct Estimated {
  double value;
  double sigma;
};

struct FoundNutation {
  double t_s;                ///< Time in the middle of the pass.
  Estimated half_angle_rad;  ///< Half-angle of the cone at t_s.
  Estimated growth_per_s;    ///< Relative growth rate of the half-angle.
  Estimated period_s;        ///< Period of the axis about the angular momentum, in inertial space.
  Estimated lean_azimuth_rad;  ///< Azimuth in `spin` to which the axis leans at t_s, (-pi, pi].
  double per_turn;             ///< Nutation cycles in a turn of the body.
  /// Other periods that explain the edges nearly as well (by less than a thousand to one).
  std::vector<double> other_periods_s;
};

struct NutationSearch {
  std::optional<FoundNutation> found;
  double false_alarm;     ///< Chance that noise alone shows as much, at most 1.
  double detectable_rad;  ///< Half-angle found in 95 of 100 such passes.
};

/// Searches nutation; the time is proportional to the edges, some seconds for a day at 100 rpm.
/// @return InvalidInput for numbers that are not finite, or a sigma not above 0; Unobservable where
/// the edges are too few or too many or hardly move with a tilt.
Expected<NutationSearch> find_nutation(std::span<const UniformSpinResidual> residuals);

}  // namespace spindrift
