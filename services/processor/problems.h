/// @file
/// Present problems, for the parts that report on the health of the service.

#pragma once

#include <algorithm>
#include <chrono>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

namespace spindrift {

struct SourceProblem {
  std::string text;
  std::chrono::steady_clock::time_point heard;  ///< Time at which the source was last heard.
};

/// Collects problems. May be used by any thread.
class Problems {
 public:
  void set_sources(std::vector<SourceProblem> sources) {
    const std::lock_guard lock{mutex_};
    sources_ = std::move(sources);
  }

  /// Adds a failure of the computation. It stays for the life of the process.
  void add_fault(std::string text) {
    const std::lock_guard lock{mutex_};
    if (std::find(faults_.begin(), faults_.end(), text) == faults_.end()) {
      faults_.push_back(std::move(text));
    }
  }

  /// Returns the faults, then the problems of sources that were heard at or after `heard`.
  std::vector<std::string> since(std::chrono::steady_clock::time_point heard) const {
    const std::lock_guard lock{mutex_};
    std::vector<std::string> texts = faults_;
    for (const SourceProblem& problem : sources_) {
      if (problem.heard >= heard) {
        texts.push_back(problem.text);
      }
    }
    return texts;
  }

 private:
  mutable std::mutex mutex_;
  std::vector<SourceProblem> sources_;
  std::vector<std::string> faults_;
};

}  // namespace spindrift
