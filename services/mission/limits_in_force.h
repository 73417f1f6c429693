/// @file
/// The limits of a spacecraft's alerts: those of the mission file before, in and after the contact,
/// as operators change them.

#pragma once

#include <map>
#include <optional>
#include <utility>

#include "pipelines/supervision/limits.h"
#include "pipelines/time/tai_time.h"
#include "services/mission/scalar.h"

namespace spindrift {

/// Tells the limits by the time of what is judged, so that they hold from the same place on in
/// whichever order samples, results and details are judged.
class LimitsInForce {
 public:
  /// @param values The values of [alerts] of the mission file, defaults filled in.
  LimitsInForce(TomlValues values, const std::optional<Contact>& contact)
      : values_{std::move(values)}, contact_{contact} {}

  /// Sets limits, which must be allowed, for what happens from `t` on.
  void set(TaiTime t, const SetLimit& limit) {
    said_.emplace(t, limit);
    from_.clear();
  }

  /// @return Valid until the next `set`; the same object as long as no limit changes.
  const AlertLimits& at(TaiTime t);

 private:
  void work_out();
  AlertLimits from(TaiTime t) const;

  TomlValues values_;
  std::optional<Contact> contact_;
  std::multimap<TaiTime, SetLimit> said_;
  std::map<TaiTime, AlertLimits>
      from_;  ///< Limits by the time from which they hold; empty: none yet.
};

}  // namespace spindrift
