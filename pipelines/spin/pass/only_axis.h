/// @file
/// Searches the whole sky for the only axis that explains the edges of a pass, where the fixes of
/// single revolutions may all lack it.
///
/// The axis is fitted to blocks of mean edges with the phase of each block free. As the Earth
/// moves, the edges of some minutes leave one axis, although every revolution leaves several.

#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <vector>

#include "pipelines/spin/consistency/block_fit.h"
#include "pipelines/spin/types/config.h"

namespace spindrift {

class OnlyAxis {
 public:
  /// Adds a block later than those before.
  void add(BlockUnderSky block);

  /// Searches when there are a quarter more blocks than at the last search.
  /// @return The axis that explains the edges if any other is e^20 times less likely.
  std::optional<Eigen::Vector3d> search(const SpinConfig& config);

 private:
  std::vector<BlockUnderSky> blocks_;  ///< Blocks over the whole pass, the recent ones denser.
  std::size_t added_ = 0;
  std::size_t due_at_ = 8;  ///< Number of blocks from which on to search again.
};

}  // namespace spindrift
