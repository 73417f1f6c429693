/// @file
/// Condenses the edges of some successive revolutions into one time per channel.

#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "pipelines/spin/types/config.h"
#include "pipelines/spin/types/pulse.h"
#include "pipelines/spin/types/revolution.h"
#include "pipelines/spin/types/sky.h"
#include "pipelines/time/tai_time.h"

namespace spindrift {

/// Holds the mean edge of a channel, within a turn of the middle of its block.
struct ChannelPoint {
  Pulse edge;
  double sigma_s;  ///< Standard deviation by noise.
};

/// Holds a channel whose edges scatter as no motion of the body makes them: far more than stated,
/// and than those of every other sensor.
struct NoisyChannel {
  PulseChannel channel;  ///< The first of its sensor.
  double scatter_s;
  double stated_s;
};

/// Holds the mean edges of some successive revolutions.
struct ChannelBlock {
  TaiTime t;  ///< Start of the middle revolution.
  double rate_rad_s;
  std::vector<ChannelPoint> points;  ///< At most one per channel.
  bool has_shifted = false;          ///< True if edges of a channel are off its usual phase.
  std::optional<NoisyChannel> noisy = {};
};

/// Collects revolutions until they make a block: of five seconds, and of three revolutions.
class BlockCollector {
 public:
  /// @param revolution Revolution that follows those before.
  /// @return The block that ends with it; empty if the block goes on.
  std::optional<ChannelBlock> add(const PulseNoise& noise, const Revolution& revolution);

 private:
  std::vector<Revolution> revolutions_;
};

}  // namespace spindrift
