/// @file
/// The alerts of one spacecraft: at most one that is open a key.

#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "pipelines/core/expected.h"
#include "pipelines/supervision/alert.h"

namespace spindrift {

/// What a condition that changes says of its alert.
struct Occurrence {
  std::string run_id;
  std::string key;
  AlertSeverity severity;
  TaiTime t;
  std::string message;
  std::string evidence;
};

/// Active -> acknowledged -> cleared; active or acknowledged -> shelved -> active. Cleared is
/// final: the next occurrence has another id. What is not later than the last change that the
/// condition of a key made in the same run is known already: a restarted service computes its last
/// minutes again. Another run may be of earlier telemetry.
class AlertBook {
 public:
  /// An alert of before, as it was last. In their order: of a key the last counts.
  void take_up(const std::string& run_id, Alert alert);

  /// `t`, or a moment after the last change that the condition of a key made: of a condition that
  /// nobody computes again, and whose clock may be set back.
  TaiTime after(const std::string& key, TaiTime t) const;

  /// @return the alert as it is now; empty: nothing has changed.
  std::optional<Alert> raise(const Occurrence& occurrence);
  std::optional<Alert> clear(const Occurrence& occurrence);

  /// @return InvalidInput where no such alert is open, or it has been done already.
  Expected<Alert> acknowledge(const std::string& alert_id, TaiTime t, const std::string& by,
                              const std::string& note);
  Expected<Alert> shelve(const std::string& alert_id, TaiTime t, TaiTime until,
                         const std::string& by, const std::string& note);
  /// Those shelved until `t` or before are active again.
  std::vector<Alert> expire(TaiTime t);

  /// In the order of their keys.
  std::vector<Alert> open() const;

 private:
  Expected<Alert*> find_open(const std::string& alert_id);

  struct Entry {
    Alert last;
    std::string run_id;  ///< That raised it.
    TaiTime settled;     ///< When the condition changed last.
  };
  static bool is_known(const Entry& entry, const Occurrence& occurrence) {
    return entry.run_id == occurrence.run_id && occurrence.t <= entry.settled;
  }

  std::map<std::string, Entry> by_key_;
};

}  // namespace spindrift
