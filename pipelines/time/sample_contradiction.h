/// @file
/// Reports that a sample came with more than one value.

#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "pipelines/core/sender.h"
#include "pipelines/time/tai_time.h"

namespace spindrift {

/// Holds the senders of contradicting samples of one kind and instant.
struct SampleContradiction {
  struct By {
    Sender sender;
    bool used;              ///< True if its value counts.
    std::string name = {};  ///< Filled in by the layer that knows it.
  };

  TaiTime t = {};
  std::string_view kind = {};
  std::vector<By> by = {};  ///< The senders, each named once.
  /// True if the first value was processed and stays; `by` then has its sender and the late one.
  bool late = false;
};

}  // namespace spindrift
