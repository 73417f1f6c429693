/// @file
/// Messages of the running service on standard error for the person at the terminal.

#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "services/mission/mission.h"
#include "services/products/alert.h"
#include "services/program/arrival_tally.h"
#include "services/publisher/health.h"

namespace spindrift {

enum class TellAs {
  StatusLine,  ///< For a terminal: state in the last line, changes above it.
  Lines,       ///< Changes as log lines.
  JsonLines    ///< Changes as log lines, one JSON object each.
};
/// Chooses by the type of standard error. @param json Selects JSON lines if it is no terminal.
TellAs how_to_tell(bool json);

/// Makes each later log message a JSON object on one line with `utc`, `level` and `text`.
void log_as_json();

/// Safe to use from any thread; no call blocks for long.
class ServiceTerminal {
 public:
  /// @param missions Must outlive the terminal.
  ServiceTerminal(const std::vector<Mission>& missions, TellAs as);

  bool has_status_line() const { return as_ == TellAs::StatusLine; }

  /// Counts the arrivals in a stored batch of a run of the service.
  void count(const ArchiveBatch& stored) { arrivals_.count(stored); }
  /// Logs a change of an alert. Call it in the order of changes.
  void tell(const std::string& spacecraft, const std::string& run_id, const Alert& alert);
  /// Call it every second. It reminds of continuing silences and draws the status line of each
  /// spacecraft that was heard, in turn.
  void show(const Health& health);
  /// Erases the status line, so that the next writer gets an empty last line.
  void erase() const;

 private:
  using Instant = std::chrono::steady_clock::time_point;
  /// Cumulative sample counts of a spacecraft in the last seconds.
  using Counts = std::deque<std::pair<Instant, std::int64_t>>;
  struct Silence {
    AlertSeverity severity;
    std::size_t told = 0;  ///< Number of entries of kToldAfter already logged.
  };

  void remind(const SpacecraftHealth& health);
  void draw(const Health& health);
  static std::optional<double> rate_hz(Counts& counts, Instant now, std::int64_t samples);

  const std::vector<Mission>& missions_;
  const TellAs as_;
  ArrivalTally arrivals_;
  std::mutex mutex_;                         // Guards the members below.
  std::map<std::string, Silence> silences_;  ///< By spacecraft, while alert `link.silent` is open.
  std::map<std::string, Counts> counts_;     ///< Counts by spacecraft.
  std::size_t turn_ = 0;
};

}  // namespace spindrift
