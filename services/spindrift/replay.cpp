#include "services/spindrift/replay.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <chrono>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <stop_token>
#include <thread>
#include <utility>

#include "services/bus/participant.h"
#include "services/mission/mission.h"
#include "services/publisher/telemetry_publisher.h"
#include "services/spindrift/telemetry_input.h"

namespace spindrift {
namespace {

using std::chrono::steady_clock;

constexpr std::chrono::seconds kWaitForSubscriber{30};
constexpr std::chrono::seconds kWaitForArrival{60};

/// When a pulse of time `t` is due, if the one of time `first` was due at `start`.
steady_clock::time_point due(steady_clock::time_point start, TaiTime first, TaiTime t,
                             double speed) {
  const std::chrono::duration<double> elapsed{seconds_between(first, t) / speed};
  return start + std::chrono::duration_cast<steady_clock::duration>(elapsed);
}

/// One source, on the topics of the telemetry.
struct Publishers {
  PulsePublisher pulses;
  CodedPublisher coded;
};

Expected<Publishers> publishers_on(const bus::Participant& participant) {
  const std::uint64_t session = random_session();
  auto pulses = PulsePublisher::create(participant, "replay", session);
  if (!pulses) {
    return Unexpected{std::move(pulses.error())};
  }
  auto coded = CodedPublisher::create(participant, "replay", session);
  if (!coded) {
    return Unexpected{std::move(coded.error())};
  }
  return Publishers{.pulses = std::move(*pulses), .coded = std::move(*coded)};
}

Expected<void> wait_for_subscriber(const Publishers& publishers, const TelemetryInput& telemetry) {
  if (telemetry.holds(TelemetryKind::Pulses)) {
    if (auto found = publishers.pulses.wait_for_subscriber(kWaitForSubscriber); !found) {
      return found;
    }
  }
  return telemetry.holds(TelemetryKind::Coded)
             ? publishers.coded.wait_for_subscriber(kWaitForSubscriber)
             : Expected<void>{};
}

/// Publishes when it is due; the first sample at once.
class Pacer {
 public:
  explicit Pacer(double speed) : speed_{speed} {}

  void wait_for(TaiTime t) {
    if (speed_ > 0.0) {
      const TaiTime first = first_.value_or(t);
      first_ = first;
      std::this_thread::sleep_until(due(start_, first, t, speed_));
    }
  }

 private:
  double speed_;
  std::optional<TaiTime> first_;
  steady_clock::time_point start_ = steady_clock::now();
};

Expected<void> publish(Publishers& publishers, const SampleBatch& batch, Pacer& pacer) {
  const std::stop_token never;
  for (const PulseSample& sample : batch.pulses) {
    pacer.wait_for(sample.pulse.t);
    if (auto sent = publishers.pulses.publish(sample.spacecraft, sample.pulse, never); !sent) {
      return sent;
    }
  }
  for (const CodedSample& sample : batch.coded) {
    pacer.wait_for(sample.frame.t);
    if (auto sent = publishers.coded.publish(sample.spacecraft, sample.frame, never); !sent) {
      return sent;
    }
  }
  return {};
}

Expected<void> publish(Publishers& publishers, TelemetryInput& telemetry, double speed) {
  Pacer pacer{speed};
  while (true) {
    const auto batch = telemetry.next();
    if (!batch) {
      return Unexpected{batch.error()};
    }
    if (is_empty(*batch)) {
      break;
    }
    if (auto sent = publish(publishers, *batch, pacer); !sent) {
      return sent;
    }
  }
  return publishers.pulses.wait_for_acknowledgments(kWaitForArrival).and_then([&] {
    return publishers.coded.wait_for_acknowledgments(kWaitForArrival);
  });
}

}  // namespace

Expected<void> replay(const ReplayOptions& options) {
  const auto mission = load_mission(options.mission);
  if (!mission) {
    return Unexpected{mission.error()};
  }
  auto telemetry = TelemetryInput::open(options.telemetry, mission->spacecraft_id, false);
  if (!telemetry) {
    return Unexpected{telemetry.error()};
  }
  const auto participant =
      bus::Participant::create({.domain = options.domain, .partition = options.partition});
  if (!participant) {
    return Unexpected{participant.error()};
  }
  spdlog::info("{}", participant->description());
  auto publishers = publishers_on(*participant);
  if (!publishers) {
    return Unexpected{publishers.error()};
  }
  if (auto found = wait_for_subscriber(*publishers, *telemetry); !found) {
    return Unexpected{{ErrorCode::Unavailable,
                       fmt::format("nobody subscribes in domain {}, partition '{}': {}",
                                   options.domain, options.partition, found.error().message)}};
  }
  spdlog::info("publishing the telemetry of {}", mission->spacecraft_id);
  if (auto sent = publish(*publishers, *telemetry, options.speed); !sent) {
    return sent;
  }
  const BadRows& bad = telemetry->bad_rows();
  if (bad.count > 0) {
    spdlog::warn("{}", bad.text());
  }
  const std::uint64_t edges = publishers->pulses.next().seq;
  const std::uint64_t frames = publishers->coded.next().seq;
  if (options.json) {
    fmt::print("{}\n", nlohmann::json{{"published", edges + frames},
                                      {"edges", edges},
                                      {"coded_frames", frames},
                                      {"input_rejected", bad.count}}
                           .dump());
  } else {
    fmt::print("{} edges and {} coded frames published, {} bad rows left out\n", edges, frames,
               bad.count);
  }
  return {};
}

}  // namespace spindrift
