/// @file
/// A console on an archive with a run and an open alert, and an HTTP client for it.

#pragma once

#include <gtest/gtest.h>

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "services/console/console_server.h"
#include "services/mission/mission.h"
#include "tests/integration/archive_fixture.h"
#include "tests/support/http_client.h"
#include "tests/support/recorded_files.h"
#include "tests/support/text_of.h"

namespace spindrift {

class ConsoleFixture : public testing::ArchiveFixture {
 protected:
  static constexpr const char* kAlertId = "00ff00ff00ff00ff";
  static constexpr const char* kRun = "run-1";

  ConsoleFixture()
      : archive_{open(
            {.on_committed = [this](std::span<const ArchiveBatch> stored) { announce(stored); }})} {
    ArchiveBatch run = testing::start_of(kRun);
    run.products.emplace_back(alert());
    for (std::int64_t i = 1; i <= 100; ++i) {
      run.products.emplace_back(RevolutionProduct{
          .revolution = i, .t_sun1 = tai_from_ns(i * 1'000'000'000), .period_s = 1.0});
      run.products.emplace_back(SpinMeasurement{
          .revolution = i,
          .quantity = SpinQuantity::SunAngle,
          .value = static_cast<double>(i),
          .sigma = 0.1,
          .rejected_by = i == 50 ? std::optional{Rejection::SunAngle} : std::nullopt});
    }
    commit(*archive_, run);
    desk_.take_up("SPINNER", kRun, alert());
    server_ = value_or_throw(ConsoleServer::start(
        {.address = "127.0.0.1:0", .names = {"Ship"}, .db = path()},
        {.feed = feed_, .desk = desk_, .archive = *archive_, .act = [this](const auto& action) {
           return act(action);
         }}));
    client_.emplace(server_->url());
  }

  static Alert alert() {
    return {.alert_id = kAlertId,
            .key = "spin.sigma",
            .severity = AlertSeverity::Warning,
            .raised = tai_from_ns(5),
            .updated = tai_from_ns(5),
            .message = "sigma is large",
            .evidence = R"({"value":2.0,"limit":1.0})",
            .by = "spindrift"};
  }
  /// Feeds committed batches to the console as the service does.
  void announce(std::span<const ArchiveBatch> stored) {
    for (const ArchiveBatch& batch : stored) {
      feed_.put_details(batch);
      for (const Product& product : batch.products) {
        if (std::holds_alternative<Alert>(product)) {
          feed_.put(batch.spacecraft_id, batch.run_id, product);
        }
      }
    }
  }

  /// Accepts every action that has a name.
  Expected<std::string> act(const nlohmann::json& action) {
    if (!action.contains("action")) {
      return Unexpected{{ErrorCode::InvalidInput, "action: is missing"}};
    }
    acts_.push_back(action);
    return "act-1";
  }

  std::string token() const {
    const std::string line = text_of(path().string() + ".token");
    return line.substr(0, line.size() - 1);
  }

  std::vector<Mission> missions_{load_mission(kPasses / "nominal" / "mission.toml").value()};
  ConsoleFeed feed_{missions_, {{"name", "test"}, {"version", "0.1.0"}, {"mode", "live"}}};
  std::unique_ptr<Archive> archive_;
  AlertDesk desk_;
  std::vector<nlohmann::json> acts_;
  std::unique_ptr<ConsoleServer> server_;
  std::optional<HttpClient> client_;
};

}  // namespace spindrift
