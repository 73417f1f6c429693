/// @file
/// Which spacecraft are heard, and since when not.

#pragma once

#include <chrono>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "services/publisher/health.h"

namespace spindrift {

/// Used by any thread. Times are given, so that it knows no clock.
class LinkWatch {
 public:
  using Instant = std::chrono::steady_clock::time_point;

  /// A link that gave nothing for so long is stale.
  static constexpr std::chrono::seconds kStaleAfter{5};

  /// @param spacecraft Those that are waited for.
  explicit LinkWatch(const std::vector<std::string>& spacecraft);

  /// A sample with telemetry time `t` came. One of another spacecraft is not looked at.
  void note(const std::string& spacecraft, TaiTime t, Instant now);

  /// After a restart: its telemetry had come to `t`, and nobody knows when.
  void go_on(const std::string& spacecraft, TaiTime t);

  std::vector<SpacecraftHealth> report(Instant now) const;

 private:
  struct Last {
    TaiTime t;
    std::optional<Instant> came;  ///< Empty: before a restart.
  };
  mutable std::mutex mutex_;
  std::map<std::string, std::optional<Last>> last_;
};

}  // namespace spindrift
