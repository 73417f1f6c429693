/// @file
/// Sends open alerts to an Alertmanager, on a thread of its own.

#pragma once

#include <functional>
#include <memory>
#include <mutex>
#include <nlohmann/json.hpp>
#include <string>
#include <thread>
#include <vector>

#include "pipelines/core/expected.h"
#include "services/alerts/alert_desk.h"
#include "services/alerts/back_off.h"

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

  /// Returns how often it did not take alerts, and for how long it has not.
  BackOff deliveries() const;

  Webhook(const Webhook&) = delete;
  Webhook& operator=(const Webhook&) = delete;
  Webhook(Webhook&&) = delete;
  Webhook& operator=(Webhook&&) = delete;

 private:
  Webhook(std::string url, const AlertDesk& desk, std::string service);
  void run(const std::stop_token& stop);
  void note(const Expected<void>& sent);

  std::string url_;
  const AlertDesk& desk_;
  std::string service_;
  mutable std::mutex mutex_;
  BackOff deliveries_;
  std::jthread thread_;  // Last member, since the thread uses the others.
};

}  // namespace spindrift
