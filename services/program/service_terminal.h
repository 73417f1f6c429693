/// @file
/// What the running service tells whoever sits before it, on standard error.

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
  StatusLine,  ///< A terminal: the state in its last line, above it what changes.
  Lines,       ///< Of the log, what changes.
  JsonLines    ///< Likewise, an object a line.
};
/// By what standard error is. @param json Where it is no terminal.
TellAs how_to_tell(bool json);

/// Used by any thread; nobody waits.
class ServiceTerminal {
 public:
  /// @param missions Outlive it.
  ServiceTerminal(const std::vector<Mission>& missions, TellAs as);

  bool has_status_line() const { return as_ == TellAs::StatusLine; }

  /// Of runs of the service.
  void note(const ArchiveBatch& stored) { arrivals_.note(stored); }
  /// A change of an alert, in the order of changes.
  void tell(const std::string& spacecraft, const std::string& run_id, const Alert& alert);
  /// Of each second: how long a silence lasts; and the status line of a spacecraft that was heard,
  /// one after the other.
  void show(const Health& health);
  /// Leaves the last line to whoever writes next.
  void erase() const;

 private:
  using Instant = std::chrono::steady_clock::time_point;
  /// Samples of a spacecraft in the last seconds.
  using Counts = std::deque<std::pair<Instant, std::int64_t>>;
  struct Silence {
    AlertSeverity severity;
    std::size_t told = 0;  ///< Of kToldAfter.
  };

  void remind(const SpacecraftHealth& health);
  void draw(const Health& health);
  static std::optional<double> rate_hz(Counts& counts, Instant now, std::int64_t samples);

  const std::vector<Mission>& missions_;
  const TellAs as_;
  ArrivalTally arrivals_;
  std::mutex mutex_;                         // Of what follows.
  std::map<std::string, Silence> silences_;  ///< By spacecraft, while `link.silent` is open.
  std::map<std::string, Counts> counts_;     ///< By spacecraft.
  std::size_t turn_ = 0;
};

}  // namespace spindrift
