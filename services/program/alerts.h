/// @file
/// `spindrift alerts`: the alerts of an archive, and an operator's word on them.

#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "pipelines/core/expected.h"
#include "services/alerts/alert_desk.h"
#include "services/archive/archive.h"

namespace spindrift {

struct AlertsOptions {
  std::filesystem::path db;
  bool json = false;
  bool follow = false;
  std::string alert_id = {};  ///< Of ack and shelve, as what follows.
  std::string by = {};
  std::string note = {};
  int minutes = 0;  ///< Shelved for so long; 0: acknowledged.
};

inline constexpr std::string_view kAlertRequest = "alert";

/// Prints those that are open, and with `json` all, in one object.
Expected<void> list_alerts(const AlertsOptions& options);

/// Prints those that are open, then each change as it is stored, a line each, until SIGINT or
/// SIGTERM, or nobody reads.
Expected<void> follow_alerts(const AlertsOptions& options);

/// Acknowledges or shelves one: by the service that holds the archive, else here.
Expected<void> change_alert(const AlertsOptions& options);

/// What a service answers to the request that the other one made.
nlohmann::json answer_alert(const nlohmann::json& request, AlertDesk& desk, Archive& archive);

}  // namespace spindrift
