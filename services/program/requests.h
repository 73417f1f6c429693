/// @file
/// What the service that holds an archive answers to subcommands of other programs.

#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string_view>

#include "services/alerts/alert_desk.h"
#include "services/archive/archive.h"
#include "services/serving/action_inbox.h"

namespace spindrift {

/// @name The `do` of the requests
/// @{
inline constexpr std::string_view kActionRequest = "action";
inline constexpr std::string_view kAlertRequest = "alert";
inline constexpr std::string_view kReconstructRequest = "reconstruct";
/// @}

/// Answers the request of `act`.
nlohmann::json answer_action(nlohmann::json request, ActionInbox& inbox);

/// Answers the request of `change_alert`.
nlohmann::json answer_alert(const nlohmann::json& request, AlertDesk& desk, Archive& archive);

/// Answers the request of `reconstruct` and stores a run. Safe to call from any thread.
nlohmann::json answer_reconstruct(const nlohmann::json& request, const std::filesystem::path& db,
                                  Archive& archive);

}  // namespace spindrift
