/// @file
/// A telemetry sample with where it came from, the same from the bus and from a file.

#pragma once

#include <cstdint>
#include <string>

#include "pipelines/spin/types/coded_frame.h"
#include "pipelines/spin/types/pulse.h"

namespace spindrift {

/// Which sample of which sender. On the bus: source, session and seq of the IDL. From a file: the
/// file's name, 0 and the line.
struct Origin {
  std::string source;
  std::uint64_t session = 0;
  std::uint64_t seq = 0;
};

struct PulseSample {
  std::string spacecraft;
  Origin origin;
  Pulse pulse;
};

struct CodedSample {
  std::string spacecraft;
  Origin origin;
  CodedFrame frame;
};

}  // namespace spindrift
