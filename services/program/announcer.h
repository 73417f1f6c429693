/// @file
/// Announces results once they are stored, on a thread of its own: every result on the bus; in the
/// log every change of an alert, every reconstruction of a separation and, where no status line
/// shows it, the latest estimate from time to time.

#pragma once

#include <chrono>
#include <cstdint>
#include <map>
#include <set>
#include <span>
#include <string>
#include <thread>
#include <utility>

#include "services/archive/records.h"
#include "services/archive/stored_results.h"
#include "services/base/bell.h"
#include "services/console/console_feed.h"
#include "services/program/service_terminal.h"
#include "services/publisher/announcements.h"
#include "services/publisher/result_publisher.h"
#include "services/serving/thread_failures.h"

namespace spindrift {

class Announcer {
 public:
  /// The arguments outlive the announcer. @param feed Null when there is no console.
  /// @param new_answers Rung when results have been announced, answers among them.
  Announcer(const ResultPublisher& publisher, ConsoleFeed* feed, ServiceTerminal& terminal,
            Bell& new_answers, ThreadFailures& failures);
  ~Announcer();
  Announcer(const Announcer&) = delete;
  Announcer& operator=(const Announcer&) = delete;
  Announcer(Announcer&&) = delete;
  Announcer& operator=(Announcer&&) = delete;

  /// Registers a continued run, whose `stored` results were announced before; only those in force
  /// are announced again. Call it before anything of the run is committed.
  void go_on(const std::string& run_id, const std::string& spacecraft, StoredResults stored);

  /// Announces the service's own alerts before they are stored, since the archive may block.
  void announce(const ArchiveBatch& batch);

  /// Takes the batches that the archive has just committed for announcement; never blocks. Alerts
  /// that were announced before they were stored are not announced twice.
  void committed(std::span<const ArchiveBatch> batches);

 private:
  void run();
  bool is_news(const Announcement& result);
  void hand_out(const Announcement& result);
  void say(const std::string& spacecraft, const Product& estimate);

  const ResultPublisher& publisher_;
  ConsoleFeed* feed_;
  ServiceTerminal& terminal_;
  Bell& new_answers_;
  Announcements waiting_;
  std::map<std::string, StoredResults> announced_before_;              ///< Results by run.
  std::set<std::string> unannounced_;                                  ///< Runs of other commands.
  std::map<std::string, std::chrono::steady_clock::time_point> said_;  ///< Last, by spacecraft.
  std::map<std::pair<std::string, std::string>, std::int64_t>
      alerts_;          ///< Highest revision announced, by spacecraft and alert key.
  std::thread thread_;  // Last member, since the thread uses the others.
};

}  // namespace spindrift
