/// @file
/// `spindrift act`: sends an operator's action for a spacecraft to the running service.

#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>

#include "pipelines/core/expected.h"
#include "services/serving/action_inbox.h"

namespace spindrift {

struct ActOptions {
  std::filesystem::path db;
  std::string spacecraft;
  std::string action;
  std::string by;
  std::string note = {};
  bool json = false;
  std::optional<std::string> at = {};  ///< UTC.
  /// @name Arguments of some actions
  /// @{
  std::optional<std::string> channel = {};
  std::optional<double> ra_deg = {};
  std::optional<double> dec_deg = {};
  std::optional<double> sigma_deg = {};
  std::optional<std::string> from = {};  ///< UTC.
  std::optional<std::string> to = {};    ///< UTC.
  /// @}
};

inline constexpr std::string_view kActionRequest = "action";

/// Prints the id under which the service stored the action. @return InvalidConfiguration with the
/// reason of a refusal; Unavailable when no service holds the archive.
Expected<void> act(const ActOptions& options);

/// Returns the service's answer to the request that `act` sends.
nlohmann::json answer_action(nlohmann::json request, ActionInbox& inbox);

}  // namespace spindrift
