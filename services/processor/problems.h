/// @file
/// What is wrong, for whoever reports on the service.

#pragma once

#include <algorithm>
#include <chrono>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

namespace spindrift {

/// A source whose time is wrong.
struct SourceProblem {
  std::string text;
  std::chrono::steady_clock::time_point heard;  ///< When it last was.
};

/// Used by any thread.
class Problems {
 public:
  void set_sources(std::vector<SourceProblem> sources) {
    const std::lock_guard lock{mutex_};
    sources_ = std::move(sources);
  }

  /// That computing failed, which nothing heals.
  void add_fault(std::string text) {
    const std::lock_guard lock{mutex_};
    if (std::find(faults_.begin(), faults_.end(), text) == faults_.end()) {
      faults_.push_back(std::move(text));
    }
  }

  /// The worst first. Of the sources, of those that were heard since.
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
