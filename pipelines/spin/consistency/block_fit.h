/// @file
/// Fits one spin axis to the mean edges of blocks of revolutions, with some of them left out, and
/// says how well they agree: the chi-square by noise and by what the mission file may be off.
///
/// The phase of each block is free, so neither the spin rate nor its changes matter. Errors of the
/// mission file are unknowns with their prior, the same in all blocks.

#pragma once

#include <Eigen/Core>
#include <array>
#include <bitset>
#include <optional>
#include <span>
#include <vector>

#include "pipelines/spin/consistency/channel_block.h"
#include "pipelines/spin/types/config.h"
#include "pipelines/spin/types/pulse.h"
#include "pipelines/spin/types/sky.h"

namespace spindrift {

struct BlockUnderSky {
  ChannelBlock block;
  Sky sky;  ///< About the time of the block.
};

/// Says what does not count in a fit.
struct OmittedSensors {
  std::bitset<kPulseChannels> channels;
  bool orbit = false;  ///< If so, the spacecraft may be ahead or behind on its orbit.
  friend bool operator==(const OmittedSensors&, const OmittedSensors&) = default;
};

struct BlockFit {
  Eigen::Vector3d axis_icrf;
  double squares;  ///< Chi-square.
  int freedom;     ///< Its degrees of freedom.
  double late_s;   ///< Lateness of all times against the orbit; zero unless that is omitted.
  using Azimuths = std::array<double, kPulseChannels>;
  /// Azimuths of each channel behind its expected one, rad, by block; NaN without a point.
  std::vector<Azimuths> off_rad;
};

/// Returns the mean azimuth of each channel behind its expected one; NaN without points.
BlockFit::Azimuths mean_of(std::span<const BlockFit::Azimuths> off_rad);

/// @param start_icrf Axis to start from, unit vector.
/// @return Empty if no axis near it fits at all, or the points are too few to test one.
std::optional<BlockFit> fit_axis(const SpinConfig& config, std::span<const BlockUnderSky> blocks,
                                 const OmittedSensors& omitted, const Eigen::Vector3d& start_icrf);

/// Predicted edges of one block at axes over the whole sky.
class SkyOfAxes {
 public:
  SkyOfAxes(const SpinConfig& config, const BlockUnderSky& block);

  /// Returns the axes at which the edges that are not omitted fit best, likeliest first, a basin
  /// apart from each other.
  std::vector<Eigen::Vector3d> best(const OmittedSensors& omitted) const;

 private:
  struct Place {
    Eigen::Vector3d axis_icrf;
    std::vector<std::optional<double>> off_rad;  ///< Per point: measured less predicted azimuth.
  };
  double cost(const Place& place, const OmittedSensors& omitted) const;

  std::vector<PulseChannel> channels_;  ///< Channels of the points of the block.
  std::vector<Place> places_;
};

}  // namespace spindrift
