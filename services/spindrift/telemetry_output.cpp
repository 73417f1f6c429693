#include "services/spindrift/telemetry_output.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <chrono>
#include <nlohmann/json.hpp>
#include <utility>

#include "pipelines/time/utc.h"
#include "services/spindrift/stop_signal.h"

namespace spindrift {
namespace {

using std::chrono::steady_clock;

constexpr std::chrono::seconds kWaitInSilence{1};  // One that is there is found within it.
constexpr std::chrono::seconds kWaitForSubscriber{30};
constexpr std::chrono::seconds kWaitForArrival{60};
// Who is told to stop does not wait long for a subscriber that hangs.
constexpr std::chrono::seconds kWaitForArrivalWhenStopped{2};
constexpr std::chrono::milliseconds kSlice{100};

/// `attempt(kSlice)` until it succeeds, for `patience` at most.
/// @return the last error of `attempt`.
template <class Attempt>
Expected<void> try_for(std::chrono::seconds patience, const std::stop_token& stop,
                       const Attempt& attempt) {
  const auto deadline = steady_clock::now() + patience;
  while (true) {
    auto done = attempt(kSlice);
    if (done || stop.stop_requested() || steady_clock::now() >= deadline) {
      return done;
    }
  }
}

Expected<void> wait_for_subscriber(const TelemetryOutput& output, const Sending& sending,
                                   const std::stop_token& stop) {
  const auto subscribed = [&](std::chrono::milliseconds slice) {
    return (sending.pulses ? output.pulses().wait_for_subscriber(slice) : Expected<void>{})
        .and_then([&] {
          return sending.coded ? output.coded().wait_for_subscriber(slice) : Expected<void>{};
        });
  };
  auto found = try_for(kWaitInSilence, stop, subscribed);
  if (!found && !stop.stop_requested()) {
    spdlog::info("waiting for a subscriber in domain {}, partition '{}'", sending.bus.domain,
                 sending.bus.partition);
    found = try_for(kWaitForSubscriber - kWaitInSilence, stop, subscribed);
  }
  if (!found) {
    return Unexpected{
        {ErrorCode::Unavailable,
         fmt::format("nobody subscribes in domain {}, partition '{}' (waited {} s); start `serve` "
                     "with this domain and partition first: {}",
                     sending.bus.domain, sending.bus.partition, kWaitForSubscriber.count(),
                     found.error().message)}};
  }
  return {};
}

Expected<void> wait_for_arrival(const TelemetryOutput& output, const std::stop_token& stop) {
  return try_for(kWaitForArrival, stop, [&](std::chrono::milliseconds slice) {
    return output.pulses().wait_for_acknowledgments(slice).and_then(
        [&] { return output.coded().wait_for_acknowledgments(slice); });
  });
}

Error stopped(const TelemetryOutput& output) {
  return {ErrorCode::Unavailable,
          fmt::format("stopped by a signal: {} published{}", output.counts().text(),
                      output.reached() ? ", up to telemetry of " + format_utc(*output.reached())
                                       : std::string{})};
}

Expected<void> send(const Sending& sending, TelemetryOutput& output,
                    const std::function<Expected<void>(TelemetryOutput&)>& feed,
                    const std::stop_token& stop) {
  auto sent = wait_for_subscriber(output, sending, stop)
                  .and_then([&] {
                    spdlog::info("publishing");
                    return feed(output);
                  })
                  .and_then([&] { return wait_for_arrival(output, stop); });
  if (!sent && stop.stop_requested()) {
    static_cast<void>(output.pulses().wait_for_acknowledgments(kWaitForArrivalWhenStopped));
    static_cast<void>(output.coded().wait_for_acknowledgments(kWaitForArrivalWhenStopped));
    return Unexpected{stopped(output)};
  }
  return sent;
}

}  // namespace

std::string PublishedCounts::text() const {
  return fmt::format("{} edges and {} coded frames", edges, coded_frames);
}

nlohmann::json PublishedCounts::json() const {
  return {{"published", edges + coded_frames}, {"edges", edges}, {"coded_frames", coded_frames}};
}

Expected<PublishedCounts> send_telemetry(
    const Sending& sending, const std::function<Expected<void>(TelemetryOutput&)>& feed) {
  std::stop_source stop;
  StopSignal signal;
  signal.on_stop([&stop] { stop.request_stop(); });
  const auto participant = bus::Participant::create(sending.bus);
  if (!participant) {
    return Unexpected{participant.error()};
  }
  spdlog::info("{}", participant->description());
  const std::uint64_t session = random_session();
  auto pulses = PulsePublisher::create(*participant, sending.source, session, bus::Sending::Packed);
  if (!pulses) {
    return Unexpected{std::move(pulses.error())};
  }
  auto coded = CodedPublisher::create(*participant, sending.source, session, bus::Sending::Packed);
  if (!coded) {
    return Unexpected{std::move(coded.error())};
  }
  TelemetryOutput output{std::move(*pulses), std::move(*coded), sending.speed, stop.get_token()};
  return send(sending, output, feed, stop.get_token()).map([&] { return output.counts(); });
}

}  // namespace spindrift
