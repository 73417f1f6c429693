/// @file
/// The alerts of one spacecraft, with at most one open alert per key.

#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "pipelines/core/expected.h"
#include "pipelines/supervision/alert.h"

namespace spindrift {

/// Holds the alert content of a condition that changes.
struct Occurrence {
  std::string run_id;
  std::string key;
  AlertSeverity severity;
  TaiTime t;
  std::string message;
  std::string evidence;
};

/// Manages the alert states: active -> acknowledged -> cleared; active or acknowledged -> shelved
/// -> active. Cleared is final, and the next occurrence gets a new id. A change no later than the
/// last one of its key in the same run is ignored as known, because a restarted service recomputes
/// its last minutes. Another run may concern earlier telemetry.
class AlertBook {
 public:
  /// Restores an earlier alert; calls follow the original order, and the last of a key counts.
  void take_up(const std::string& run_id, Alert alert);

  /// Returns `t`, or a moment after the last change of the key's condition if that is later. For
  /// conditions that are not recomputed and whose clock may be set back.
  TaiTime after(const std::string& key, TaiTime t) const;

  /// @return The updated alert; empty if nothing has changed.
  std::optional<Alert> raise(const Occurrence& occurrence);
  std::optional<Alert> clear(const Occurrence& occurrence);

  /// @return InvalidInput if no such alert is open or the action is already done.
  Expected<Alert> acknowledge(const std::string& alert_id, TaiTime t, const std::string& by,
                              const std::string& note);
  Expected<Alert> shelve(const std::string& alert_id, TaiTime t, TaiTime until,
                         const std::string& by, const std::string& note);
  /// Reactivates the alerts shelved until `t` or earlier.
  std::vector<Alert> expire(TaiTime t);

  /// Returns the open alerts, ordered by key.
  std::vector<Alert> open() const;

 private:
  Expected<Alert*> find_open(const std::string& alert_id);

  struct Entry {
    Alert last;
    std::string run_id;  ///< Run that raised the alert.
    TaiTime settled;     ///< Time of the condition's last change.
  };
  static bool is_known(const Entry& entry, const Occurrence& occurrence) {
    return entry.run_id == occurrence.run_id && occurrence.t <= entry.settled;
  }

  std::map<std::string, Entry> by_key_;
};

}  // namespace spindrift
