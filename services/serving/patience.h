/// @file
/// How long the threads of `serve` go on.

#pragma once

#include <atomic>

namespace spindrift {

/// Of a service that is told to stop.
struct Patience {
  std::atomic<bool> stopping = false;
  std::atomic<bool> ended = false;  ///< What is stored is no longer computed.
};

}  // namespace spindrift
