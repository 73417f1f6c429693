/// @file
/// That a sample came with more than one value.

#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "pipelines/core/sender.h"
#include "pipelines/time/tai_time.h"

namespace spindrift {

/// Of one kind and instant.
struct SampleContradiction {
  struct By {
    Sender sender;
    bool used;              ///< It is its value that counts.
    std::string name = {};  ///< Whoever knows it fills it in.
  };

  TaiTime t = {};
  std::string_view kind = {};
  std::vector<By> by = {};  ///< Each sender once.
  /// What came first had been computed, and stays used; `by` has that sender and the late one.
  bool late = false;
};

}  // namespace spindrift
