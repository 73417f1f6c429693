/// @file
/// The limits of a spacecraft's alerts: those of the mission file, as operators change them.

#pragma once

#include <map>
#include <optional>

#include "pipelines/supervision/limits.h"
#include "pipelines/time/tai_time.h"
#include "services/mission/scalar.h"

namespace spindrift {

class LimitsInForce {
 public:
  /// @param values The values of [alerts] of the mission file, defaults filled in.
  explicit LimitsInForce(TomlValues values) : values_{std::move(values)} {}

  /// Sets limits, which must be allowed, for what happens from `t` on.
  void set(TaiTime t, const SetLimit& limit) { pending_.emplace(t, limit); }

  /// Advances to `t`. @return The limits if any has changed.
  std::optional<AlertLimits> advance(TaiTime t);

 private:
  TomlValues values_;
  std::multimap<TaiTime, SetLimit> pending_;
};

}  // namespace spindrift
