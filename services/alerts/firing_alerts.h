/// @file
/// What an Alertmanager has to be told.

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

/// What is told and when: at least once, and again while it is open.
class FiringAlerts {
 public:
  static constexpr std::chrono::seconds kAgain{60};
  /// An alert that is not told again for so long has ended.
  static constexpr std::chrono::minutes kEndsAfter{4};

  /// @param service Its name, the same after a restart: a label.
  explicit FiringAlerts(std::string service) : service_{std::move(service)} {}

  /// @param open All open alerts. @return an array for POST /api/v2/alerts; empty: nothing is due.
  nlohmann::json due(std::span<const OpenAlert> open, TaiTime now);

  /// What `due` gave last is told.
  void told(TaiTime now);

 private:
  struct Told {
    std::int64_t revision;
    TaiTime when;
    nlohmann::json alert;
  };

  nlohmann::json json_of(const OpenAlert& open, TaiTime now) const;

  std::string service_;
  std::map<std::string, Told> told_;  ///< By alert_id, of those that are open there.
  std::map<std::string, Told> due_;   ///< Likewise, of the last call of `due`.
  std::vector<std::string> ended_;    ///< Likewise.
};

}  // namespace spindrift
