/// @file
/// Collects the failures of the threads of `serve`.

#pragma once

#include <mutex>

#include "pipelines/core/expected.h"

namespace spindrift {

class ThreadFailures {
 public:
  /// Notes how `contained` work ended. A failure is logged and stops the service in an orderly way.
  /// May be called from any thread.
  void report(const Expected<void>& ended);

  Expected<void> first() const;

 private:
  mutable std::mutex mutex_;
  Expected<void> first_;
};

}  // namespace spindrift
