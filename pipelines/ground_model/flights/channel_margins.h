/// @file
/// Stability margins of the attitude control loop about one axis, and of those of an orientation
/// manoeuvre. Small angles are twice the vector part of the quaternion, so that the open loop of
/// the PD laws is
///
///     L(s) = (kd s + kp / 2) / (J s^2)
///
/// or, where angle and rate are sampled and the torque is held and delayed by d periods T,
///
///     L(z) = (kd T / (J (z - 1)) + kp T^2 (z + 1) / (4 J (z - 1)^2)) / z^d

#pragma once

#include <array>
#include <complex>
#include <optional>
#include <span>
#include <vector>

#include "pipelines/core/expected.h"
#include "pipelines/ground_model/flights/orientation_motion.h"

namespace spindrift {

struct LoopSampling {
  double period_s;
  int periods_late;
};

/// Loop about one axis. All values must be positive; `periods_late` may be 0.
struct ChannelLoop {
  double moment_kg_m2;
  double kp_nm;
  double kd_nms;
  std::optional<LoopSampling> sampling = std::nullopt;
};

struct BodePoint {
  double frequency_rad_s;
  double gain;
  double phase_rad;  ///< Phase, not wrapped; -pi at low frequencies.
};

/// @param frequency_rad_s Above 0; below half the sampling frequency.
BodePoint open_loop_at(const ChannelLoop& loop, double frequency_rad_s);

/// Returns the open loop at `points` logarithmically spaced frequencies.
/// @param points At least 2.
std::vector<BodePoint> bode(const ChannelLoop& loop, double from_rad_s, double to_rad_s,
                            int points);

struct LoopMargins {
  double phase_rad;            ///< Phase above -pi at gain 1; below 0 the loop is unstable.
  double crossover_rad_s;      ///< Frequency of gain 1.
  std::optional<double> gain;  ///< Factor of the gain up to instability; empty: infinite.
};

/// @return InvalidConfiguration where moment, gains or period are not positive; where the gain of
///         the sampled loop stays above 1 up to half the sampling frequency; or where the torque is
///         delayed by more than the lead of kd, so that the loop is unstable with any gain.
Expected<LoopMargins> loop_margins(const ChannelLoop& loop);

/// Returns the poles of the closed loop with its gain multiplied by `factor`: in the s plane
/// (stable on the left), for a sampled loop in the z plane (stable within the unit circle).
std::vector<std::complex<double>> closed_loop_poles(const ChannelLoop& loop, double factor);

struct LocusPoint {
  double factor;
  std::vector<std::complex<double>> poles;
};

std::vector<LocusPoint> root_locus(const ChannelLoop& loop, std::span<const double> factors);

/// Margins of the loop about one axis.
struct ChannelMargins {
  ChannelLoop designed;  ///< Loop with the moments that the control assumes; not sampled.
  ChannelLoop flown;     ///< Loop of the true body; sampled and late.
  LoopMargins designed_margins;
  LoopMargins flown_margins;
};

/// Returns the margins about X, Y and Z; products of inertia are neglected.
/// @return Errors of loop_margins.
Expected<std::array<ChannelMargins, 3>> channel_margins(const OrientationTruth& truth);

/// @return InvalidConfiguration where a flown loop has no phase margin and would be unstable.
Expected<void> check_margins(const OrientationTruth& truth);

}  // namespace spindrift
