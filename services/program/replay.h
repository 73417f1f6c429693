/// @file
/// `spindrift replay`: publishes recorded telemetry on the bus as the front-end sent it.

#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "pipelines/core/expected.h"

namespace spindrift {

struct ReplayOptions {
  std::filesystem::path mission;
  std::vector<std::filesystem::path> telemetry;
  double speed = 1.0;  ///< Multiple of real time; 0 means as fast as subscribers take it.
  bool now = false;    ///< Tell subscribers how far sample times lie in the past.
  std::uint32_t domain = 0;
  std::string partition = "replay";
  bool json = false;
};

/// Waits for a subscriber, publishes, waits until everything has arrived.
/// @return InvalidConfiguration for bad input; Unavailable when nobody subscribes, the bus fails or
///         a subscriber does not take what it was sent.
Expected<void> replay(const ReplayOptions& options);

}  // namespace spindrift
