/// @file
/// `spindrift act`: an operator's word on the telemetry of a spacecraft, to the running service.

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

/// Prints the id under which it is stored. @return InvalidConfiguration with what is wrong;
/// Unavailable where no service holds the archive.
Expected<void> act(const ActOptions& options);

/// What a service answers to the request that `act` made.
nlohmann::json answer_action(nlohmann::json request, ActionInbox& inbox);

}  // namespace spindrift
