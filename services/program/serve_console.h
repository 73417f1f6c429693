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
#include "services/program/serve.h"
#include "services/serving/action_inbox.h"

namespace spindrift {

/// Before anything is opened. @return As ConsoleServer::check, of a console that is wanted.
Expected<void> check_console(const ServeOptions& options);

/// Null where no console is wanted. @param missions Outlive it. @param name Of the service.
std::unique_ptr<ConsoleFeed> make_console_feed(const ServeOptions& options,
                                               const std::vector<Mission>& missions,
                                               const std::string& name);

/// And where the axis of a spinner should be.
void show_verdict(ConsoleFeed& feed, const std::string& spacecraft, const std::string& run_id,
                  const PassVerdict& verdict, const AlertDesk& desk);

/// Says where it is. Null where `feed` is. All of them outlive it. @return As ConsoleServer::start.
Expected<std::unique_ptr<ConsoleServer>> start_console(const ServeOptions& options,
                                                       ConsoleFeed* feed, AlertDesk& desk,
                                                       Archive& archive, ActionInbox& inbox);

}  // namespace spindrift
