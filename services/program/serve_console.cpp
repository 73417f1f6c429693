#include "services/program/serve_console.h"

#include <spdlog/spdlog.h>

#include "services/processor/version.h"

namespace spindrift {

Expected<void> check_console(const ServeOptions& options) {
  return options.console.empty() ? Expected<void>{} : ConsoleServer::check(options.console);
}

std::unique_ptr<ConsoleFeed> make_console_feed(const ServeOptions& options,
                                               const std::vector<Mission>& missions,
                                               const std::string& name) {
  if (options.console.empty()) {
    return nullptr;
  }
  return std::make_unique<ConsoleFeed>(
      missions, nlohmann::json{{"name", name},
                               {"version", kSoftwareVersion},
                               {"mode", options.partition == "replay" ? "replay" : "live"},
                               {"status", "starting"}});
}

void show_verdict(ConsoleFeed& feed, const std::string& spacecraft, const std::string& run_id,
                  const PassVerdict& verdict, const AlertDesk& desk) {
  feed.put(spacecraft, run_id, verdict);
  if (const auto target = desk.target_of(spacecraft)) {
    feed.put(spacecraft, *target);
  }
}

Expected<std::unique_ptr<ConsoleServer>> start_console(const ServeOptions& options,
                                                       ConsoleFeed* feed, const ServiceParts& parts,
                                                       ActionInbox& inbox) {
  if (feed == nullptr) {
    return nullptr;
  }
  auto console = ConsoleServer::start(
      {.address = options.console, .names = options.console_hosts, .db = options.db},
      {.feed = *feed,
       .desk = parts.desk,
       .archive = parts.archive,
       .webhook = parts.webhook,
       .act = [&inbox](const nlohmann::json& action) { return inbox.submit(action); }});
  if (console) {
    spdlog::info("console {}", (*console)->url());
  }
  return console;
}

}  // namespace spindrift
