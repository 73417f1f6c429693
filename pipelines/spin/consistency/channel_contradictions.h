/// @file
/// Says which channel, beam or orbit of a spinner is wrong where its edges contradict each other.
///
/// One axis is fitted to the mean edges of the last minute. If noise and the errors that the
/// mission file states do not explain how badly it fits, the same is tried without each channel,
/// without each beam and with the spacecraft elsewhere on its orbit. The culprit is the one without
/// which the others agree, if it is the only one. As the Earth moves, the blocks since the
/// contradiction began tell more of them apart.

#pragma once

#include <Eigen/Core>
#include <deque>
#include <optional>
#include <span>
#include <vector>

#include "pipelines/observation/sensor_contradiction.h"
#include "pipelines/spin/consistency/block_fit.h"
#include "pipelines/spin/types/config.h"

namespace spindrift {

class ChannelContradictions {
 public:
  /// Adds a block later than those before.
  void add(BlockUnderSky block);

  /// Returns whether a comparison may find anything new: edges have left their places lately, or
  /// have contradicted each other so far.
  bool is_due() const;

  /// Compares the edges up to now, at most some times a minute.
  /// @param known_icrf Axes that may be true; others are tried, too.
  void compare(const SpinConfig& config, std::span<const Eigen::Vector3d> known_icrf);

  /// Returns the contradiction that the edges up to now show; empty if there is none.
  const std::optional<SensorContradiction>& found() const { return found_; }

 private:
  void forget_old();
  bool agree_again(const SpinConfig& config, const std::vector<Eigen::Vector3d>& starts_icrf);
  bool accuse_noisy();
  bool search_sky(TaiTime now);
  void end();

  std::deque<BlockUnderSky> blocks_;        ///< Blocks in order of time.
  std::optional<TaiTime> since_;            ///< Time since when they contradict each other.
  std::optional<TaiTime> compared_;         ///< Time of the last comparison.
  std::optional<TaiTime> searched_;         ///< Time of the last search of the whole sky.
  std::vector<Eigen::Vector3d> last_icrf_;  ///< Likeliest axes of the last comparison.
  /// Any of them may be the culprit by the last comparison; empty if none of them explains it.
  std::vector<OmittedSensors> accused_;
  std::optional<SensorContradiction> found_;
};

}  // namespace spindrift
