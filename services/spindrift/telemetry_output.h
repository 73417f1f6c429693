/// @file
/// Telemetry out on the bus at the pace of its own time, as `replay` and `simulate` send it.

#pragma once

#include <cstdint>
#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <stop_token>
#include <string>
#include <string_view>

#include "pipelines/core/expected.h"
#include "services/bus/participant.h"
#include "services/publisher/telemetry_publisher.h"
#include "services/spindrift/pacing.h"

namespace spindrift {

/// How many samples went out.
struct PublishedCounts {
  std::uint64_t edges;
  std::uint64_t coded_frames;

  std::string text() const;     ///< "3600 edges and 0 coded frames"
  nlohmann::json json() const;  ///< "published" (all), "edges", "coded_frames"
};

/// One source on the topics of the telemetry.
class TelemetryOutput {
 public:
  TelemetryOutput(PulsePublisher pulses, CodedPublisher coded, double speed, std::stop_token stop)
      : pulses_{std::move(pulses)},
        coded_{std::move(coded)},
        pacing_{speed},
        stop_{std::move(stop)} {}

  /// When it is due, and for as long as a subscriber pushes back.
  /// @return as TelemetryPublisher::publish.
  Expected<void> publish(std::string_view spacecraft, const Pulse& pulse) {
    return send(pulses_, spacecraft, pulse);
  }
  Expected<void> publish(std::string_view spacecraft, const CodedFrame& frame) {
    return send(coded_, spacecraft, frame);
  }

  const PulsePublisher& pulses() const { return pulses_; }
  const CodedPublisher& coded() const { return coded_; }
  PublishedCounts counts() const {
    return {.edges = pulses_.next().seq, .coded_frames = coded_.next().seq};
  }
  /// Time of the sample published last.
  const std::optional<TaiTime>& reached() const { return reached_; }

 private:
  template <class Publisher, class Value>
  Expected<void> send(Publisher& publisher, std::string_view spacecraft, const Value& value) {
    wait_until_due(value.t);
    return publisher.publish(spacecraft, value, stop_).map([&] { reached_ = value.t; });
  }

  /// What is due together goes out packed; nothing that is out waits for what is not due.
  void wait_until_due(TaiTime t) {
    if (const auto due = pacing_.due(t)) {
      pulses_.flush();
      coded_.flush();
      pacing_.wait_until(*due, stop_);
    }
  }

  PulsePublisher pulses_;
  CodedPublisher coded_;
  Pacing pacing_;
  std::stop_token stop_;
  std::optional<TaiTime> reached_;
};

struct Sending {
  bus::BusConfig bus;
  std::string source;  ///< Its name on the bus.
  double speed;        ///< Times real time; 0: as fast as it is taken.
  bool pulses;         ///< Kinds that will come, for which there must be a subscriber.
  bool coded;
};

/// Waits for a subscriber, lets `feed` publish, waits until everything has arrived. SIGINT and
/// SIGTERM end it early. Call it before any thread is started.
/// @return the error of `feed`; Unavailable when nobody subscribes, the bus fails, a subscriber
///         does not take what it was sent, or a signal came: how far it got.
Expected<PublishedCounts> send_telemetry(
    const Sending& sending, const std::function<Expected<void>(TelemetryOutput&)>& feed);

}  // namespace spindrift
