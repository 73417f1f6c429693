/// @file
/// Holds in memory what the console shows; the service updates it and never waits.

#pragma once

#include <chrono>
#include <cstdint>
#include <map>
#include <mutex>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "services/alerts/stored_alerts.h"
#include "services/archive/records.h"
#include "services/base/duration_histogram.h"
#include "services/console/event_ring.h"
#include "services/console/shown_spacecraft.h"
#include "services/mission/mission.h"
#include "services/products/products.h"
#include "services/publisher/health.h"

namespace spindrift {

/// Safe to use from any thread. Only alerts are shown of spacecraft without a mission.
class ConsoleFeed {
 public:
  /// @param missions Must outlive the feed. @param service Name, version and mode.
  ConsoleFeed(const std::vector<Mission>& missions, nlohmann::json service);

  /// @name Updates by the service, once the data is stored
  /// @{
  void put(const std::string& spacecraft, const std::string& run_id, const Product& product);
  /// Shows the last run of a spacecraft until the next run begins.
  void put(const std::string& spacecraft, const std::string& run_id,
           const std::vector<Product>& results);
  /// Shows the unannounced products of a run whose results are announced.
  void put_details(const ArchiveBatch& stored);
  void put(const Health& health);
  /// Shows an alert raised before the service began.
  void put(const StoredAlert& stored);
  /// Shows the verdict on the run in force.
  void put(const std::string& spacecraft, const std::string& run_id, const PassVerdict& verdict);
  /// Shows the target direction of a spinner's axis.
  void put(const std::string& spacecraft, const SpinTarget& target);
  /// Counts the latency from the arrival of a result's last sample to its announcement.
  void note_latency(std::chrono::duration<double> latency);
  /// @}

  /// @name Access by the console
  /// @{
  /// Sends viewers the current state.
  void tell_state();
  void tell_pulses();

  /// Returns whether an answer, a fix or an alert has changed since viewers were sent a state.
  bool has_news() const;
  nlohmann::json state();
  DurationHistogram latencies() const;
  /// Returns why the service takes or stores nothing; empty when it does.
  std::string trouble() const;
  /// Returns the run in force, "" before the first run, nothing for an unknown spacecraft.
  std::optional<std::string> run_of(const std::string& spacecraft) const;
  std::optional<SpacecraftKind> kind_of(const std::string& spacecraft) const;

  /// These three work as in EventRing.
  EventRing::News after(std::uint64_t id) const;
  std::uint64_t nearest(std::uint64_t id) const;
  bool holds_all_after(std::uint64_t id) const;
  /// @}

 private:
  nlohmann::json put_alert(const std::string& spacecraft, const std::string& run_id,
                           const Alert& alert);
  nlohmann::json state_now();
  std::string trouble_now() const;

  mutable std::mutex mutex_;
  nlohmann::json service_;
  bool has_news_ = false;
  std::int64_t samples_rejected_ = 0;
  std::map<std::string, SpacecraftKind> kinds_;
  std::map<std::string, ShownSpacecraft> shown_;
  struct OpenAlert {
    Alert alert;
    nlohmann::json row;  ///< Row sent to viewers.
  };
  /// By spacecraft and key, which has at most one open alert.
  std::map<std::pair<std::string, std::string>, OpenAlert> alerts_;
  std::string trouble_;
  DurationHistogram latencies_;
  std::optional<std::chrono::steady_clock::time_point> last_health_;
  EventRing ring_;
};

}  // namespace spindrift
