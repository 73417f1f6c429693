/// @file
/// What the archive says of the runs in force: whether to act on their answers.

#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <mutex>
#include <stop_token>
#include <string>
#include <thread>
#include <vector>

#include "services/alerts/alert_desk.h"
#include "services/products/pass_verdict.h"
#include "services/serving/kept_connection.h"
#include "services/serving/thread_failures.h"

namespace spindrift {

/// Reads once a second, on a thread of its own that gives way to others: nobody else waits for the
/// disk.
class VerdictWatch {
 public:
  using OnVerdict = std::function<void(const std::string& spacecraft, const std::string& run_id,
                                       const PassVerdict& verdict)>;

  /// All of them outlive it. @param desk Knows the runs. @param on_verdict Of each second.
  VerdictWatch(const std::filesystem::path& db, std::vector<std::string> spacecraft,
               const AlertDesk& desk, OnVerdict on_verdict, ThreadFailures& failures);

  /// The last that was read. Of a spacecraft without one that of no answer; where it cannot be
  /// read, that says why.
  PassVerdict of(const std::string& spacecraft) const;

 private:
  void run(const std::stop_token& stop);
  void look();

  const std::vector<std::string> spacecraft_;
  const AlertDesk& desk_;
  const OnVerdict on_verdict_;
  KeptConnection archive_;  ///< Of the thread.
  mutable std::mutex mutex_;
  std::map<std::string, PassVerdict> verdicts_;  ///< By spacecraft.
  std::jthread thread_;                          // Last: it uses the others.
};

}  // namespace spindrift
