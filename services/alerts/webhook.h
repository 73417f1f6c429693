/// @file
/// Sends open alerts to an Alertmanager, on a thread of its own.

#pragma once

#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <thread>
#include <vector>

#include "pipelines/core/expected.h"
#include "services/alerts/alert_desk.h"

namespace spindrift {

class Webhook {
 public:
  /// @param url As "http://127.0.0.1:9093/api/v2/alerts". @param desk Must outlive it.
  /// @param service Name that stays the same after a restart, since an Alertmanager takes an alert
  ///        with other labels for another alert.
  /// @return InvalidConfiguration for what is no http or https URL.
  static Expected<std::unique_ptr<Webhook>> start(const std::string& url, const AlertDesk& desk,
                                                  const std::string& service);
  ~Webhook();
  Webhook(const Webhook&) = delete;
  Webhook& operator=(const Webhook&) = delete;
  Webhook(Webhook&&) = delete;
  Webhook& operator=(Webhook&&) = delete;

 private:
  Webhook(std::string url, const AlertDesk& desk, std::string service);
  void run(const std::stop_token& stop);

  std::string url_;
  const AlertDesk& desk_;
  std::string service_;
  std::jthread thread_;  // Last member, since the thread uses the others.
};

}  // namespace spindrift
