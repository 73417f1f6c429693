/// @file
/// Whether a condition holds, of readings that come in order of their time.

#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "pipelines/supervision/alert_code.h"
#include "pipelines/time/tai_time.h"

namespace spindrift {

/// What an alert rests on.
struct Evidence {
  double value;
  double limit;  ///< That `value` has reached.
  std::string_view unit;
  TaiTime since;  ///< The condition holds.
  TaiTime last;   ///< Of the reading that told.
  std::optional<double> sigma = {};
  std::vector<std::string> sources = {};  ///< Of telemetry, where it is of several.
};

enum class Change { Raised, Cleared };

struct ConditionChange {
  AlertCode code;
  std::string about;  ///< The thing, where the key has one.
  Change change;
  TaiTime t;
  Evidence evidence;
  AlertSeverity severity = AlertSeverity::Warning;
  std::string who = {};  ///< Does it, where somebody does.
};
using ConditionChanges = std::vector<ConditionChange>;

inline void add(std::optional<ConditionChange> change, ConditionChanges& changes) {
  if (change) {
    changes.push_back(std::move(*change));
  }
}

/// For how long a condition holds before it is raised, and is gone before it is cleared.
struct Holding {
  double raise_s = 0.0;
  double clear_s = 0.0;
};

/// From its limit on it is there, up to kClearShare of it it is gone, between them neither. What
/// was not there to begin with is said to be cleared once: an alert of an earlier run may be open.
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
  /// @param t A reading that is earlier than the one before is not looked at. Of two at one time
  /// the later tells what is wrong: it may take the other's place.
  std::optional<ConditionChange> see(TaiTime t, const Reading& reading);

  /// Of what must not be less than its limit.
  std::optional<ConditionChange> see_least(TaiTime t, const Reading& reading);

  /// Of a condition that is there or not; evidence is for how long.
  std::optional<ConditionChange> see(TaiTime t, bool is_there);

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
  TaiTime since_ = {};  ///< Of `coming_`.
};

}  // namespace spindrift
