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
  std::optional<double> worst = {};       ///< Since it was raised; empty: `value`.
  std::vector<NamedValue> more = {};      ///< What else is known, by the name it has in the alert.
  bool is_presence = false;               ///< The thing is there or not: `value` is 1 or 0.
};

/// A renewed condition holds as before, with a value that has moved.
enum class Change { Raised, Renewed, Cleared };

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
/// earlier run may have raised it. A condition that holds is renewed when its value, or its worst
/// value, has moved by kMovedShare of what was told last, at most every kBetweenTold_s.
class ConditionWatch {
 public:
  static constexpr double kClearShare = 0.8;
  static constexpr double kMovedShare = 0.1;
  static constexpr double kBetweenTold_s = 10.0;

  explicit ConditionWatch(AlertCode code, std::string_view unit, Holding holding = {},
                          std::string about = {});

  /// Changes for how long the condition must hold or be absent from now on.
  void hold(Holding holding) { holding_ = holding; }

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

  /// Watches a yes/no condition. Its evidence is the time it has held; of a thing that is raised at
  /// once, and whose unit is not s, it is that the thing is there.
  std::optional<ConditionChange> update(TaiTime t, bool is_there);

  /// Makes the next reading final: it decides at once, by the limit alone, whatever its time.
  void end();

 private:
  std::optional<ConditionChange> judge(TaiTime t, const Reading& reading, bool is_there,
                                       bool is_gone);
  bool settle(TaiTime t, Change now);
  ConditionChange tell(Change change, const Evidence& evidence) const;
  ConditionChange tell_settled(Evidence evidence);
  std::optional<ConditionChange> renew(Evidence evidence);

  AlertCode code_;
  std::string about_;
  std::string_view unit_;
  Holding holding_;
  double clear_share_ = kClearShare;
  std::optional<TaiTime> last_;
  std::optional<Change> said_;
  std::optional<Change> coming_;
  TaiTime since_ = {};  ///< Start time of `coming_`.
  struct Told {
    Evidence evidence;
    double worst;
  };
  std::optional<Told> told_;  ///< What was told last, while the condition holds.
  double worst_ = 0.0;        ///< Worst value since the condition was raised.
  bool is_least_ = false;     ///< Whether smaller values are worse.
};

}  // namespace spindrift
