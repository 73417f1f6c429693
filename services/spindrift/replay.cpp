#include "services/spindrift/replay.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <chrono>
#include <nlohmann/json.hpp>
#include <stop_token>
#include <thread>

#include "services/bus/participant.h"
#include "services/mission/mission.h"
#include "services/publisher/pulse_publisher.h"
#include "services/spindrift/pulse_input.h"

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

Expected<void> publish(PulsePublisher& publisher, const std::vector<PulseSample>& samples,
                       double speed) {
  const auto start = steady_clock::now();
  for (const PulseSample& sample : samples) {
    if (speed > 0.0) {
      std::this_thread::sleep_until(due(start, samples.front().pulse.t, sample.pulse.t, speed));
    }
    if (auto sent = publisher.publish(sample.spacecraft, sample.pulse, std::stop_token{}); !sent) {
      return sent;
    }
  }
  return publisher.wait_for_acknowledgments(kWaitForArrival);
}

}  // namespace

Expected<void> replay(const ReplayOptions& options) {
  const auto mission = load_mission(options.mission);
  if (!mission) {
    return Unexpected{mission.error()};
  }
  const auto telemetry = load_pulses(options.telemetry, mission->spacecraft_id);
  if (!telemetry) {
    return Unexpected{telemetry.error()};
  }
  if (!telemetry->rejected.empty()) {
    spdlog::warn("{}", bad_rows(telemetry->rejected));
  }
  const auto participant =
      bus::Participant::create({.domain = options.domain, .partition = options.partition});
  if (!participant) {
    return Unexpected{participant.error()};
  }
  spdlog::info("{}", participant->description());
  auto publisher = PulsePublisher::create(*participant, "replay");
  if (!publisher) {
    return Unexpected{publisher.error()};
  }
  if (auto found = publisher->wait_for_subscriber(kWaitForSubscriber); !found) {
    return Unexpected{{ErrorCode::Unavailable,
                       fmt::format("nobody subscribes in domain {}, partition '{}': {}",
                                   options.domain, options.partition, found.error().message)}};
  }
  spdlog::info("publishing {} pulses of {}", telemetry->samples.size(), mission->spacecraft_id);
  if (auto sent = publish(*publisher, telemetry->samples, options.speed); !sent) {
    return sent;
  }
  if (options.json) {
    fmt::print("{}\n", nlohmann::json{{"published", telemetry->samples.size()},
                                      {"input_rejected", telemetry->rejected.size()}}
                           .dump());
  } else {
    fmt::print("{} edges published, {} bad rows left out\n", telemetry->samples.size(),
               telemetry->rejected.size());
  }
  return {};
}

}  // namespace spindrift
