/// @file
/// `spindrift alerts`: lists, acknowledges and shelves the alerts of an archive.

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
  std::string alert_id = {};  ///< Used by `ack` and `shelve` only, as are the members below.
  std::string by = {};
  std::string note = {};
  int minutes = 0;  ///< Duration of shelving; 0 means acknowledge.
};

inline constexpr std::string_view kAlertRequest = "alert";

/// Prints the open alerts as text, or with `json` all alerts as one object.
Expected<void> list_alerts(const AlertsOptions& options);

/// Prints the open alerts, then one line for each change as it is stored, until SIGINT or SIGTERM
/// arrives or the reader of standard output is gone.
Expected<void> follow_alerts(const AlertsOptions& options);

/// Changes one alert, through the service that holds the archive or else directly.
Expected<void> change_alert(const AlertsOptions& options);

/// Returns the service's answer to the request that `change_alert` sends.
nlohmann::json answer_alert(const nlohmann::json& request, AlertDesk& desk, Archive& archive);

}  // namespace spindrift
