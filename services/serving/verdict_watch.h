/// @file
/// Reads from the archive whether the answers of the current runs can be acted upon.

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
#include "services/base/bell.h"
#include "services/products/pass_verdict.h"
#include "services/serving/kept_connection.h"
#include "services/serving/thread_failures.h"

namespace spindrift {

/// Reads the verdicts on its own low-priority thread, so that nobody waits for the disk: once a
/// second, and as soon as there are new answers, but at most ten times a second.
class VerdictWatch {
 public:
  using OnVerdict = std::function<void(const std::string& spacecraft, const std::string& run_id,
                                       const PassVerdict& verdict)>;

  /// All arguments must outlive the watch. @param desk Knows the current run of each spacecraft.
  /// @param new_answers Rung when there may be new answers in the archive.
  /// @param on_verdict Called for every spacecraft after each reading.
  VerdictWatch(const std::filesystem::path& db, std::vector<std::string> spacecraft,
               const AlertDesk& desk, Bell& new_answers, OnVerdict on_verdict,
               ThreadFailures& failures);

  /// Returns the verdict that was read last. It is the verdict of a run without an answer when
  /// there is none, and says why when the archive cannot be read.
  PassVerdict of(const std::string& spacecraft) const;

 private:
  void run(const std::stop_token& stop);
  void look();

  const std::vector<std::string> spacecraft_;
  const AlertDesk& desk_;
  Bell& new_answers_;
  const OnVerdict on_verdict_;
  KeptConnection archive_;  ///< Used by the thread only.
  mutable std::mutex mutex_;
  std::map<std::string, PassVerdict> verdicts_;  ///< Verdict in force by spacecraft.
  std::jthread thread_;                          // Declared last because it uses the other members.
};

}  // namespace spindrift
