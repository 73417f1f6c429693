/// @file
/// How far the sessions of sources had come before a restart.

#pragma once

#include <vector>

#include "services/ingest/sample.h"

namespace spindrift {

/// The highest seq that the archive holds of each session, by topic.
struct LastOrigins {
  std::vector<Origin> pulses = {};
  std::vector<Origin> frames = {};
};

}  // namespace spindrift
