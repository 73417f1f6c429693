/// @file
/// Tells the threads of `serve` how long they may go on.

#pragma once

#include <atomic>

namespace spindrift {

struct Patience {
  std::atomic<bool> stopping = false;
  std::atomic<bool> ended = false;  ///< Stored samples are no longer computed.
};

}  // namespace spindrift
