/// @file
/// The alerts of one spacecraft, with at most one open alert per key.

#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
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
  double took_s = 0.0;      ///< Time that the condition had to hold before it was raised.
  double hold_off_s = 0.0;  ///< A condition that returns within it is the same occurrence.
};

/// Manages the alert states: active -> acknowledged -> cleared; active or acknowledged -> shelved
/// -> active. A condition that returns within its hold-off, or ten times what raising took if that
/// is longer, opens the same alert again, as it was; after that, cleared is final, and the next
/// occurrence gets a new id. Shelving belongs to the key until its end. A change no later than the
/// last one of its key in the same run is ignored as known, because a restarted service recomputes
/// its last minutes. Another run may concern earlier telemetry.
///
/// Of the changes of conditions at most kMostAnHour are given in any hour, of alerts that returned
/// only half of that, so that a new alert has room. A change that is not given is given with the
/// next one of its alert, which says how many there were.
class AlertBook {
 public:
  static constexpr std::size_t kMostAnHour = 1000;

  /// Restores an earlier alert; calls follow the original order, and the last of a key counts.
  void take_up(const std::string& run_id, Alert alert);

  /// Counts a change that was given before; calls follow the original order.
  void count_given(TaiTime t);

  /// Returns `t`, or a moment after the last change of the key's condition if that is later. For
  /// conditions that are not recomputed and whose clock may be set back.
  TaiTime after(const std::string& key, TaiTime t) const;

  /// Returns the run that found the condition of the key last; empty when none did.
  std::string run_of(const std::string& key) const;

  /// Returns how often the condition of the key has begun so far.
  std::int64_t count_of(const std::string& key) const;

  /// @return The updated alert; empty if nothing has changed or it is not given now.
  std::optional<Alert> raise(const Occurrence& occurrence);
  std::optional<Alert> clear(const Occurrence& occurrence);
  /// Renews message and evidence of an open alert, which is no change of its state.
  std::optional<Alert> renew(const Occurrence& occurrence);
  /// Returns the alerts with changes that were not given, as far as there is room for them at `t`.
  std::vector<Alert> catch_up(TaiTime t);

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
  struct Entry {
    Alert last;
    std::string run_id;                    ///< Run that found the condition last.
    TaiTime settled;                       ///< Time of the condition's last change.
    std::optional<AlertState> given = {};  ///< State when the alert was last given.
    std::int64_t not_given = 0;            ///< Changes since then.
  };
  static bool is_known(const Entry& entry, const Occurrence& occurrence) {
    return entry.run_id == occurrence.run_id && occurrence.t <= entry.settled;
  }

  Expected<Entry*> find_open(const std::string& alert_id);
  Alert obey(Entry& entry, AlertState to, TaiTime t, const std::string& by,
             const std::string& note);
  static bool returns(const Entry& entry, const Occurrence& occurrence);
  std::optional<Alert> give(Entry& entry);
  bool has_room(const Alert& alert, TaiTime t) const;

  std::map<std::string, Entry> by_key_;
  std::deque<TaiTime> given_;  ///< Times of the last changes that were given.
};

}  // namespace spindrift
