/// @file
/// Selects the alerts to send to an Alertmanager.

#pragma once

#include <chrono>
#include <cstdint>
#include <map>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <vector>

#include "pipelines/time/tai_time.h"
#include "services/alerts/alert_desk.h"

namespace spindrift {

/// Sends each open alert at least once, and repeats it while it is open.
class FiringAlerts {
 public:
  static constexpr std::chrono::seconds kAgain{60};
  /// An Alertmanager resolves alerts that are not repeated for so long.
  static constexpr std::chrono::minutes kEndsAfter{4};

  /// @param service Name used as a label; it must not change with a restart.
  explicit FiringAlerts(std::string service) : service_{std::move(service)} {}

  /// @param open All open alerts. @return An array for POST /api/v2/alerts; empty when none is due.
  nlohmann::json due(std::span<const OpenAlert> open, TaiTime now);

  /// Confirms that the last result of `due` was sent.
  void told(TaiTime now);

 private:
  struct Told {
    std::int64_t revision;
    TaiTime when;
    nlohmann::json alert;
  };

  nlohmann::json json_of(const OpenAlert& open, TaiTime now) const;

  std::string service_;
  std::map<std::string, Told> told_;  ///< Sent and not ended, by alert_id.
  std::map<std::string, Told> due_;   ///< From the last call of `due`, by alert_id.
  std::vector<std::string> ended_;    ///< From the last call of `due`: their alert_id.
};

}  // namespace spindrift
