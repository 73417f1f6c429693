/// @file
/// What the console shows, in memory: the service puts it in and never waits.

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

/// From any thread. What is of other spacecraft than those of the missions is not shown, but for
/// their alerts.
class ConsoleFeed {
 public:
  /// @param missions Outlive it. @param service Name, version and mode.
  ConsoleFeed(const std::vector<Mission>& missions, nlohmann::json service);

  /// @name Of the service, once it is stored
  /// @{
  void put(const std::string& spacecraft, const std::string& run_id, const Product& product);
  /// The last run of a spacecraft, until the next begins.
  void put(const std::string& spacecraft, const std::string& run_id,
           const std::vector<Product>& results);
  /// What is not announced, of a run whose results are.
  void put_details(const ArchiveBatch& stored);
  void put(const Health& health);
  /// Of before the service began.
  void put(const StoredAlert& stored);
  /// Of the run in force.
  void put(const std::string& spacecraft, const std::string& run_id, const PassVerdict& verdict);
  /// Where the axis of a spinner should be.
  void put(const std::string& spacecraft, const SpinTarget& target);
  /// From the arrival of the last sample that a result rests on to its announcement.
  void note_latency(std::chrono::duration<double> latency);
  /// @}

  /// @name Of the console
  /// @{
  /// Tells viewers the state of now.
  void tell_state();
  void tell_pulses();

  nlohmann::json state();
  DurationHistogram latencies() const;
  /// Why the service takes or stores nothing; empty: it does.
  std::string trouble() const;
  /// Of a spacecraft. Empty: none yet. @return nothing where there is no such spacecraft.
  std::optional<std::string> run_of(const std::string& spacecraft) const;
  std::optional<SpacecraftKind> kind_of(const std::string& spacecraft) const;

  /// As those of EventRing.
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
  std::int64_t samples_rejected_ = 0;
  std::map<std::string, SpacecraftKind> kinds_;
  std::map<std::string, ShownSpacecraft> shown_;
  struct OpenAlert {
    Alert alert;
    nlohmann::json row;  ///< As viewers are told.
  };
  /// By spacecraft and key: of a key one is open at most.
  std::map<std::pair<std::string, std::string>, OpenAlert> alerts_;
  std::string trouble_;
  DurationHistogram latencies_;
  std::optional<std::chrono::steady_clock::time_point> last_health_;
  EventRing ring_;
};

}  // namespace spindrift
