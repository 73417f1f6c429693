/// @file
/// The console of `spindrift serve`.

#pragma once

#include <memory>
#include <string>
#include <vector>

#include "pipelines/core/expected.h"
#include "services/alerts/alert_desk.h"
#include "services/archive/archive.h"
#include "services/console/console_feed.h"
#include "services/console/console_server.h"
#include "services/mission/mission.h"
#include "services/program/commands.h"
#include "services/serving/action_inbox.h"
#include "services/serving/service_run.h"

namespace spindrift {

/// @return The error of ConsoleServer::check, if a console is wanted.
Expected<void> check_console(const ServeOptions& options);

/// Returns null when no console is wanted. @param missions They outlive the feed.
std::unique_ptr<ConsoleFeed> make_console_feed(const ServeOptions& options,
                                               const std::vector<Mission>& missions,
                                               const std::string& name);

/// Puts the verdict and the expected spin axis of a spinner on the console.
void show_verdict(ConsoleFeed& feed, const std::string& spacecraft, const std::string& run_id,
                  const PassVerdict& verdict, const AlertDesk& desk);

/// Logs the console's address. @return Null if `feed` is; the errors of ConsoleServer::start.
Expected<std::unique_ptr<ConsoleServer>> start_console(const ServeOptions& options,
                                                       ConsoleFeed* feed, const ServiceParts& parts,
                                                       ActionInbox& inbox);

}  // namespace spindrift
