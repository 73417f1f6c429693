/// @file
/// Decides whether a condition holds, from readings in time order.

#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "pipelines/core/assessment.h"
#include "pipelines/supervision/alert_code.h"
#include "pipelines/time/tai_time.h"

namespace spindrift {

/// Holds the facts on which an alert rests.
struct Evidence {
  double value;
  double limit;  ///< Limit that `value` has reached.
  std::string_view unit;
  TaiTime since;  ///< Time from which the condition holds.
  TaiTime last;   ///< Time of the deciding reading.
  std::optional<double> sigma = {};
  std::vector<std::string> sources = {};  ///< Telemetry sources involved, if several.
  std::vector<NamedValue> more = {};      ///< What else is known, by the name it has in the alert.
};

enum class Change { Raised, Cleared };

struct ConditionChange {
  AlertCode code;
  std::string about;  ///< Channel, source or item concerned; empty for the whole spacecraft.
  Change change;
  TaiTime t;
  Evidence evidence;
  AlertSeverity severity = AlertSeverity::Warning;
  std::string who = {};  ///< Party that causes the condition, if known.
};
using ConditionChanges = std::vector<ConditionChange>;

inline void add(std::optional<ConditionChange> change, ConditionChanges& changes) {
  if (change) {
    changes.push_back(std::move(*change));
  }
}

/// How long a condition must hold before it is raised, and be absent before it is cleared.
struct Holding {
  double raise_s = 0.0;
  double clear_s = 0.0;
};

/// Watches one condition with hysteresis: it holds from its limit on and is absent below
/// kClearShare of the limit. An initially absent condition is reported as cleared once, as an
/// earlier run may have raised it.
class ConditionWatch {
 public:
  static constexpr double kClearShare = 0.8;

  explicit ConditionWatch(AlertCode code, std::string_view unit, Holding holding = {},
                          std::string about = {});

  struct Reading {
    double value;
    double limit;
    std::optional<double> sigma = {};
  };
  /// @param t Readings earlier than the previous one are ignored. At the same time, only a reading
  ///         that raises the condition can replace an earlier one.
  std::optional<ConditionChange> update(TaiTime t, const Reading& reading);

  /// Watches a value that must not fall below its limit.
  std::optional<ConditionChange> see_least(TaiTime t, const Reading& reading);

  /// Watches a yes/no condition; its evidence is the time it has held.
  std::optional<ConditionChange> update(TaiTime t, bool is_there);

 private:
  std::optional<ConditionChange> judge(TaiTime t, const Reading& reading, bool is_there,
                                       bool is_gone);
  std::optional<ConditionChange> settle(TaiTime t, Change now, Evidence evidence);

  AlertCode code_;
  std::string about_;
  std::string_view unit_;
  Holding holding_;
  std::optional<TaiTime> last_;
  std::optional<Change> said_;
  std::optional<Change> coming_;
  TaiTime since_ = {};  ///< Start time of `coming_`.
};

}  // namespace spindrift
