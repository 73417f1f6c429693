/// @file
/// Publishes telemetry on the bus at the pace of its own time stamps, for `replay` and `simulate`.

#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <mutex>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <set>
#include <stop_token>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "pipelines/core/expected.h"
#include "pipelines/time/tai_time.h"
#include "services/bus/participant.h"
#include "services/publisher/telemetry_publisher.h"
#include "services/telemetry/by_kind.h"

namespace spindrift {

/// Makes the first sample due at once, and later ones after the time difference over the speed.
class Pacing {
 public:
  using Clock = std::chrono::steady_clock;

  /// @param speed Multiple of real time; 0 makes everything due at once.
  explicit Pacing(double speed) : speed_{speed} {}

  /// Sets the reference so that a sample of time `t` is due at `instant`.
  void begin_at(TaiTime t, Clock::time_point instant) {
    first_ = t;
    start_ = instant;
  }

  /// Returns when a sample of time `t` is due; empty when that is now or has passed.
  std::optional<Clock::time_point> due(TaiTime t);

  /// Blocks until `due` or until a stop is requested.
  void wait_until(Clock::time_point due, const std::stop_token& stop);

 private:
  double speed_;
  std::optional<TaiTime> first_;
  Clock::time_point start_;
  std::mutex mutex_;
  std::condition_variable_any stopped_;
};

/// Counts the samples published, for each kind that the input contains.
class PublishedCounts {
 public:
  struct Count {
    std::string_view plural;  ///< "edges"
    std::uint64_t samples;
  };

  void add(std::string_view plural, std::uint64_t samples) { counts_.push_back({plural, samples}); }
  std::uint64_t all() const;
  std::string text() const;  ///< "3600 edges and 0 coded frames"
  /// @return "published" (the total) and each kind, as "coded_frames". @param prefix Of the kinds.
  nlohmann::json json(std::string_view prefix = {}) const;

 private:
  std::vector<Count> counts_;
};

template <class Value>
using PublisherOfKind = std::optional<TelemetryPublisher<Value>>;
/// One publisher for each kind of telemetry to be sent.
using TelemetryPublishers = ByKind<PublisherOfKind>;

/// The time that the telemetry of a rehearsal belongs to.
enum class Rehearsal {
  OfThePast,     ///< Recorded telemetry, whose first sample is due now.
  OfThePresent,  ///< Each sample is due when the host's clock says its time.
};

/// Publishes the telemetry of one source.
class TelemetryOutput {
 public:
  /// @param clock Tells subscribers of a rehearsal the offset of telemetry time.
  TelemetryOutput(TelemetryPublishers publishers, double speed, std::stop_token stop,
                  std::optional<Rehearsal> rehearsal = {},
                  std::optional<bus::Writer<spindrift_RehearsalClock>> clock = {})
      : publishers_{std::move(publishers)},
        pacing_{speed},
        stop_{std::move(stop)},
        rehearsal_{rehearsal},
        clock_{std::move(clock)} {}

  /// Publishes a sample when its time is due and subscribers have room. Its kind has a publisher.
  /// @return The errors of TelemetryPublisher::publish.
  template <class Value>
  Expected<void> publish(std::string_view spacecraft, const Value& value) {
    return publish(spacecraft, value, value.t);
  }
  /// Publishes a sample at time `due` instead of its own time.
  template <class Value>
  Expected<void> publish(std::string_view spacecraft, const Value& value, TaiTime due) {
    auto& publisher = *publishers_.of<Value>();
    return tell_clock(spacecraft, publisher.next(), due)
        .and_then([&] {
          wait_until_due(due);
          return publisher.publish(spacecraft, value, stop_);
        })
        .map([&] { reached_ = value.t; });
  }

  const TelemetryPublishers& publishers() const { return publishers_; }
  PublishedCounts counts() const;
  const std::optional<TaiTime>& reached() const { return reached_; }

 private:
  Expected<void> tell_clock(std::string_view spacecraft, const Origin& origin, TaiTime t);
  void wait_until_due(TaiTime t);

  TelemetryPublishers publishers_;
  Pacing pacing_;
  std::stop_token stop_;
  std::optional<Rehearsal> rehearsal_;
  std::optional<bus::Writer<spindrift_RehearsalClock>> clock_;
  std::optional<std::chrono::nanoseconds> offset_;  ///< Host clock minus telemetry time.
  std::set<std::string, std::less<>> told_clock_;   ///< Spacecraft with a clock sent.
  std::optional<TaiTime> reached_;
  std::optional<TaiTime> flushed_;
};

struct Sending {
  bus::BusConfig bus;
  std::string source;                  ///< Name of the source on the bus.
  double speed;                        ///< Multiple of real time; 0 sends as fast as possible.
  std::optional<Rehearsal> rehearsal;  ///< Set at speed 1 only.
  std::vector<TelemetryKind> kinds;    ///< Kinds that will be sent; each needs a subscriber.
};

/// Waits for a subscriber, lets `feed` publish, waits until everything has arrived. SIGINT and
/// SIGTERM end it early. Call it before any thread is started.
/// @return the error of `feed`; Unavailable when nobody subscribes, the bus fails, a subscriber
///         does not take what it was sent, or a signal came, with how far sending got.
Expected<PublishedCounts> send_telemetry(
    const Sending& sending, const std::function<Expected<void>(TelemetryOutput&)>& feed);

}  // namespace spindrift
