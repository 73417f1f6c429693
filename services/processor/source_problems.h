/// @file
/// Sources whose time is wrong, for whoever reports on the service.

#pragma once

#include <chrono>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

namespace spindrift {

struct SourceProblem {
  std::string text;
  std::chrono::steady_clock::time_point heard;  ///< When it last was.
};

/// Used by any thread.
class SourceProblems {
 public:
  void set(std::vector<SourceProblem> problems) {
    const std::lock_guard lock{mutex_};
    problems_ = std::move(problems);
  }

  /// Of the sources that were heard since.
  std::vector<std::string> since(std::chrono::steady_clock::time_point heard) const {
    const std::lock_guard lock{mutex_};
    std::vector<std::string> texts;
    for (const SourceProblem& problem : problems_) {
      if (problem.heard >= heard) {
        texts.push_back(problem.text);
      }
    }
    return texts;
  }

 private:
  mutable std::mutex mutex_;
  std::vector<SourceProblem> problems_;
};

}  // namespace spindrift
