/// @file
/// Announces results once they are stored, on a thread of its own: on the bus, and in the log each
/// change of an alert, each reconstruction of a separation and, where no status line has it, the
/// latest estimate every now and then.

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
#include "services/console/console_feed.h"
#include "services/program/service_terminal.h"
#include "services/publisher/announcements.h"
#include "services/publisher/result_publisher.h"
#include "services/serving/thread_failures.h"

namespace spindrift {

class Announcer {
 public:
  /// All of them outlive it. @param feed Null: there is no console.
  Announcer(const ResultPublisher& publisher, ConsoleFeed* feed, ServiceTerminal& terminal,
            ThreadFailures& failures);
  ~Announcer();
  Announcer(const Announcer&) = delete;
  Announcer& operator=(const Announcer&) = delete;
  Announcer(Announcer&&) = delete;
  Announcer& operator=(Announcer&&) = delete;

  /// A run goes on that has announced `stored`: of that only what is in force is announced again.
  /// Before anything of the run is committed.
  void go_on(const std::string& run_id, const std::string& spacecraft, StoredResults stored);

  /// What the service says of itself: before it is stored, since the archive may make it wait.
  void announce(const ArchiveBatch& batch);

  /// Of what the archive has just committed; never waits. An alert that was announced before it
  /// was stored is known.
  void committed(std::span<const ArchiveBatch> batches);

 private:
  void run();
  bool is_news(const Announcement& result);
  void hand_out(const Announcement& result);
  void say(const std::string& spacecraft, const Product& estimate);

  const ResultPublisher& publisher_;
  ConsoleFeed* feed_;
  ServiceTerminal& terminal_;
  Announcements waiting_;
  std::map<std::string, StoredResults> announced_before_;              ///< By run.
  std::set<std::string> unannounced_;                                  ///< Runs of other commands.
  std::map<std::string, std::chrono::steady_clock::time_point> said_;  ///< When, by spacecraft.
  std::map<std::pair<std::string, std::string>, std::int64_t>
      alerts_;          ///< The last number by spacecraft and key.
  std::thread thread_;  // Last: it uses the others.
};

}  // namespace spindrift
