#include "services/program/telemetry_output.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <chrono>
#include <nlohmann/json.hpp>
#include <numeric>
#include <utility>
#include <variant>

#include "pipelines/time/utc.h"
#include "services/base/counted.h"
#include "services/base/json_key.h"
#include "services/base/wall_clock.h"
#include "services/bus/qos.h"
#include "services/bus/topics.h"
#include "services/publisher/to_idl.h"
#include "services/serving/stop_signal.h"

namespace spindrift {
namespace {

using std::chrono::steady_clock;

constexpr std::chrono::seconds kWaitInSilence{1};  // Long enough to find an existing subscriber.
constexpr std::chrono::seconds kWaitForSubscriber{30};
constexpr std::chrono::seconds kWaitForArrival{60};
// After a stop request, a subscriber that hangs is not waited for long.
constexpr std::chrono::seconds kWaitForArrivalWhenStopped{2};
constexpr std::chrono::milliseconds kSlice{100};
// Telemetry time. A subscriber of several topics waits up to one second for earlier samples.
constexpr std::chrono::milliseconds kLongestPacked{500};

bool has_several(const TelemetryPublishers& publishers) {
  int kinds = 0;
  publishers.for_each([&](const auto& publisher) { kinds += publisher ? 1 : 0; });
  return kinds > 1;
}

/// Calls `attempt(kSlice)` until it succeeds, for at most `patience`.
/// @return The last error of `attempt`.
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

/// Calls `attempt(publisher)` for each existing publisher until one fails.
template <class Attempt>
Expected<void> with_each(const TelemetryPublishers& publishers, const Attempt& attempt) {
  Expected<void> done;
  publishers.for_each([&](const auto& publisher) {
    if (done && publisher) {
      done = attempt(*publisher);
    }
  });
  return done;
}

Expected<void> wait_for_arrival(const TelemetryPublishers& publishers,
                                std::chrono::nanoseconds patience) {
  return with_each(publishers, [patience](const auto& publisher) {
    return publisher.wait_for_acknowledgments(patience);
  });
}

Expected<void> wait_for_subscriber(const TelemetryOutput& output, const Sending& sending,
                                   const std::stop_token& stop) {
  const auto subscribed = [&](std::chrono::milliseconds slice) {
    return with_each(output.publishers(), [slice](const auto& publisher) {
      return publisher.wait_for_subscriber(slice);
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
                  .and_then([&] {
                    return try_for(kWaitForArrival, stop, [&](std::chrono::milliseconds slice) {
                      return wait_for_arrival(output.publishers(), slice);
                    });
                  });
  if (!sent && stop.stop_requested()) {
    static_cast<void>(wait_for_arrival(output.publishers(), kWaitForArrivalWhenStopped));
    return Unexpected{stopped(output)};
  }
  return sent;
}

Expected<TelemetryPublishers> create_publishers(const bus::Participant& participant,
                                                const Sending& sending) {
  TelemetryPublishers publishers;
  const std::uint64_t session = random_session();
  Expected<void> created;
  for (const TelemetryKind& kind : sending.kinds) {
    created = created.and_then([&] {
      return std::visit(
          [&]<class Value>(Kind<Value>) {
            return TelemetryPublisher<Value>::create(participant, sending.source, session,
                                                     bus::Sending::Packed)
                .map([&](TelemetryPublisher<Value>&& publisher) {
                  publishers.of<Value>().emplace(std::move(publisher));
                });
          },
          kind);
    });
  }
  return created.map([&] { return std::move(publishers); });
}

}  // namespace

std::optional<Pacing::Clock::time_point> Pacing::due(TaiTime t) {
  if (!(speed_ > 0.0)) {
    return std::nullopt;
  }
  const Clock::time_point now = Clock::now();
  if (!first_) {
    first_ = t;
    start_ = now;
  }
  const std::chrono::duration<double> elapsed{seconds_between(*first_, t) / speed_};
  const Clock::time_point due = start_ + std::chrono::duration_cast<Clock::duration>(elapsed);
  return due > now ? std::optional{due} : std::nullopt;
}

void Pacing::wait_until(Clock::time_point due, const std::stop_token& stop) {
  std::unique_lock lock{mutex_};
  stopped_.wait_until(lock, stop, due, [] { return false; });
}

std::uint64_t PublishedCounts::all() const {
  return std::accumulate(counts_.begin(), counts_.end(), std::uint64_t{0},
                         [](std::uint64_t sum, const Count& count) { return sum + count.samples; });
}

std::string PublishedCounts::text() const {
  std::string text;
  for (const auto& [plural, samples] : counts_) {
    const bool is_last = plural == counts_.back().plural;
    text += (text.empty() ? "" : is_last ? " and " : ", ") + counted(samples, plural);
  }
  return text;
}

nlohmann::json PublishedCounts::json(std::string_view prefix) const {
  nlohmann::json object = {{"published", all()}};
  for (const auto& [plural, samples] : counts_) {
    object[fmt::format("{}{}", prefix, json_key(plural))] = samples;
  }
  return object;
}

PublishedCounts TelemetryOutput::counts() const {
  PublishedCounts counts;
  TelemetryKinds::for_each([&]<class Value>(Kind<Value> /*kind*/) {
    if (const auto& publisher = publishers_.of<Value>()) {
      counts.add(Telemetry<Value>::kPlural, publisher->next().seq);
    }
  });
  return counts;
}

/// Publishes the rehearsal clock before the first sample of a spacecraft.
Expected<void> TelemetryOutput::tell_clock(std::string_view spacecraft, const Origin& origin,
                                           TaiTime t) {
  if (!rehearsal_ || told_clock_.contains(spacecraft)) {
    return {};
  }
  if (!offset_) {
    const TaiTime now = tai_now();
    offset_ = *rehearsal_ == Rehearsal::OfThePast ? now - t : std::chrono::nanoseconds{0};
    pacing_.begin_at(t, steady_clock::now() + (t + *offset_ - now));
  }
  told_clock_.emplace(spacecraft);
  return to_idl(spacecraft, origin, *offset_).and_then([&](const spindrift_RehearsalClock& clock) {
    return clock_->write(clock, stop_);
  });
}

/// Samples that are due together go out packed. Before it waits, and at least every kLongestPacked
/// of telemetry time when there are several topics, it flushes, so that no sample is held back.
void TelemetryOutput::wait_until_due(TaiTime t) {
  const auto due = pacing_.due(t);
  if (due || (has_several(publishers_) && t - flushed_.value_or(t) >= kLongestPacked)) {
    publishers_.for_each([](const auto& publisher) {
      if (publisher) {
        publisher->flush();
      }
    });
    flushed_ = t;
  }
  flushed_ = flushed_.value_or(t);
  if (due) {
    pacing_.wait_until(*due, stop_);
  }
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
  auto publishers = create_publishers(*participant, sending);
  if (!publishers) {
    return Unexpected{std::move(publishers.error())};
  }
  std::optional<bus::Writer<spindrift_RehearsalClock>> clock;
  if (sending.rehearsal) {
    auto writer = bus::Writer<spindrift_RehearsalClock>::create(
        *participant, bus::kRehearsalClockTopic, bus::results_qos());
    if (!writer) {
      return Unexpected{std::move(writer.error())};
    }
    clock = std::move(*writer);
  }
  TelemetryOutput output{std::move(*publishers), sending.speed, stop.get_token(), sending.rehearsal,
                         std::move(clock)};
  return send(sending, output, feed, stop.get_token()).map([&] { return output.counts(); });
}

}  // namespace spindrift
