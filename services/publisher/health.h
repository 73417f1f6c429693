/// @file
/// How the service is doing, as told to others once a second.

#pragma once

#include <cstdint>
#include <string>

#include "pipelines/time/tai_time.h"

namespace spindrift {

struct Health {
  std::string service;  ///< Names the instance; at most 64 bytes.
  TaiTime t;            ///< Of this report: wall clock.
  std::uint64_t samples_received;
  std::uint64_t samples_committed;
  std::uint64_t gaps;  ///< Missing now.
  std::uint64_t duplicates;
  std::uint64_t queue_depth;
  double commit_p99_ms;
  std::string status;  ///< For people; its first 64 bytes are published.
};

}  // namespace spindrift
