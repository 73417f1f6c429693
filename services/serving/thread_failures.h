/// @file
/// What the threads of `serve` could not do.

#pragma once

#include <mutex>

#include "pipelines/core/expected.h"

namespace spindrift {

class ThreadFailures {
 public:
  /// Of `contained` work: a failure is said, and the service stops in an orderly way. From any
  /// thread.
  void note(const Expected<void>& ended);

  /// The first failure that was noted.
  Expected<void> first() const;

 private:
  mutable std::mutex mutex_;
  Expected<void> first_;
};

}  // namespace spindrift
