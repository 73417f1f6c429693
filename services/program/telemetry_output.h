/// @file
/// Telemetry out on the bus at the pace of its own time, as `replay` and `simulate` send it.

#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <set>
#include <stop_token>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "pipelines/core/expected.h"
#include "services/bus/participant.h"
#include "services/program/pacing.h"
#include "services/publisher/telemetry_publisher.h"
#include "services/telemetry/by_kind.h"

namespace spindrift {

/// How many samples of each kind went out, of those that were to come.
class PublishedCounts {
 public:
  struct Count {
    std::string_view plural;  ///< "edges"
    std::uint64_t samples;
  };

  void add(std::string_view plural, std::uint64_t samples) { counts_.push_back({plural, samples}); }
  std::uint64_t all() const;
  std::string text() const;  ///< "3600 edges and 0 coded frames"
  /// "published" (all), and each kind, "coded_frames". @param prefix Of the names of kinds.
  nlohmann::json json(std::string_view prefix = {}) const;

 private:
  std::vector<Count> counts_;
};

template <class Value>
using PublisherOfKind = std::optional<TelemetryPublisher<Value>>;
/// Of those kinds of telemetry that are to be sent.
using TelemetryPublishers = ByKind<PublisherOfKind>;

/// What a rehearsal's telemetry is of.
enum class Rehearsal {
  OfThePast,     ///< Recorded: its first sample is due now, whatever its time.
  OfThePresent,  ///< Each sample is due when the host's clock says its time.
};

/// One source on the topics of the telemetry.
class TelemetryOutput {
 public:
  /// @param clock Of a rehearsal, by which subscribers learn how the telemetry goes.
  TelemetryOutput(TelemetryPublishers publishers, double speed, std::stop_token stop,
                  std::optional<Rehearsal> rehearsal = {},
                  std::optional<bus::Writer<spindrift_RehearsalClock>> clock = {})
      : publishers_{std::move(publishers)},
        pacing_{speed},
        stop_{std::move(stop)},
        rehearsal_{rehearsal},
        clock_{std::move(clock)} {}

  /// When its time is due, and for as long as a subscriber pushes back. Its kind is to be sent.
  /// @return as TelemetryPublisher::publish.
  template <class Value>
  Expected<void> publish(std::string_view spacecraft, const Value& value) {
    return publish(spacecraft, value, value.t);
  }
  /// When `due` is.
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
  /// Time of the sample published last.
  const std::optional<TaiTime>& reached() const { return reached_; }

 private:
  Expected<void> tell_clock(std::string_view spacecraft, const Origin& origin, TaiTime t);
  void wait_until_due(TaiTime t);

  TelemetryPublishers publishers_;
  Pacing pacing_;
  std::stop_token stop_;
  std::optional<Rehearsal> rehearsal_;
  std::optional<bus::Writer<spindrift_RehearsalClock>> clock_;
  std::optional<std::chrono::nanoseconds> offset_;  ///< Of the host's clock, in a rehearsal.
  std::set<std::string, std::less<>> told_clock_;   ///< Spacecraft.
  std::optional<TaiTime> reached_;
  std::optional<TaiTime> flushed_;
};

struct Sending {
  bus::BusConfig bus;
  std::string source;                  ///< Its name on the bus.
  double speed;                        ///< Times real time; 0: as fast as it is taken.
  std::optional<Rehearsal> rehearsal;  ///< At speed 1.
  std::vector<TelemetryKind> kinds;    ///< That will come, for which there must be a subscriber.
};

/// Waits for a subscriber, lets `feed` publish, waits until everything has arrived. SIGINT and
/// SIGTERM end it early. Call it before any thread is started.
/// @return the error of `feed`; Unavailable when nobody subscribes, the bus fails, a subscriber
///         does not take what it was sent, or a signal came: how far it got.
Expected<PublishedCounts> send_telemetry(
    const Sending& sending, const std::function<Expected<void>(TelemetryOutput&)>& feed);

}  // namespace spindrift
