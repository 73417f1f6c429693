/// @file
/// What a service had stored of a pass before it was restarted.

#pragma once

#include <algorithm>
#include <vector>

#include "services/archive/stored_pass.h"

namespace spindrift {

/// A front-end sends its last minutes again: that tells nothing of the pass, and is no news to it.
class StoredSamples {
 public:
  explicit StoredSamples(const StoredPass& stored);

  template <class Value>
  bool hold(const Value& value) const {
    return std::binary_search(keys_.begin(), keys_.end(), order_of(value));
  }

 private:
  std::vector<TelemetryOrder> keys_;  ///< In order.
};

}  // namespace spindrift
