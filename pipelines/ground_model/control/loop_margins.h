/// @file
/// How near the loop about one axis is to swinging. Small angles are twice the vector part of the
/// quaternion, so that the open loop of the PD laws is
///
///     L(s) = (kd s + kp / 2) / (J s^2)
///
/// or, where angle and rate are sampled and the torque is held and comes d periods T late,
///
///     L(z) = (kd T / (J (z - 1)) + kp T^2 (z + 1) / (4 J (z - 1)^2)) / z^d

#pragma once

#include <complex>
#include <optional>
#include <span>
#include <vector>

#include "pipelines/core/expected.h"

namespace spindrift {

struct LoopSampling {
  double period_s;
  int periods_late;
};

/// All above 0, or at least 0.
struct ChannelLoop {
  double moment_kg_m2;
  double kp_nm;
  double kd_nms;
  std::optional<LoopSampling> sampling = std::nullopt;
};

struct BodePoint {
  double frequency_rad_s;
  double gain;
  double phase_rad;  ///< Not wrapped; from -pi at low frequencies.
};

/// @param frequency_rad_s Above 0; below half that of the sampling.
BodePoint open_loop_at(const ChannelLoop& loop, double frequency_rad_s);

/// At frequencies of even ratio.
/// @param points At least 2.
std::vector<BodePoint> bode(const ChannelLoop& loop, double from_rad_s, double to_rad_s,
                            int points);

struct LoopMargins {
  double phase_rad;            ///< Above -pi where the gain is 1; below 0 the loop swings.
  double crossover_rad_s;      ///< There.
  std::optional<double> gain;  ///< Factor up to the loop's swinging; empty: infinite.
};

/// @return InvalidConfiguration where moment, gains or period are not positive; where the gain of
///         the sampled loop is above 1 up to half the frequency of the sampling, or its torque
///         comes later than kd leads, so that it swings with any gain.
Expected<LoopMargins> loop_margins(const ChannelLoop& loop);

/// Of the closed loop with its gain multiplied by `factor`: in the plane of s, stable on its left;
/// of a sampled one in that of z, stable within the unit circle.
std::vector<std::complex<double>> closed_loop_poles(const ChannelLoop& loop, double factor);

struct LocusPoint {
  double factor;
  std::vector<std::complex<double>> poles;
};

std::vector<LocusPoint> root_locus(const ChannelLoop& loop, std::span<const double> factors);

}  // namespace spindrift
