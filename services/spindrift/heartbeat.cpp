#include "services/spindrift/heartbeat.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <utility>

#include "services/clock/wall_clock.h"

namespace spindrift {
namespace {

constexpr std::chrono::seconds kPeriod{1};

std::string service_name() {
  std::array<char, 48> host{};
  if (::gethostname(host.data(), host.size() - 1) != 0) {
    host = {"unknown"};
  }
  return fmt::format("spindrift {}:{}", host.data(), ::getpid());
}

SequenceCounts total(const PulseSubscriberStatus& status) {
  SequenceCounts sum;
  for (const auto& [source, counts] : status.by_source) {
    sum += counts;
  }
  return sum;
}

}  // namespace

std::vector<SourceCount> source_counts(const PulseSubscriberStatus& status) {
  std::vector<SourceCount> counts;
  for (const auto& [source, count] : status.by_source) {
    counts.push_back({.source = source,
                      .received = static_cast<std::int64_t>(count.received),
                      .gaps = static_cast<std::int64_t>(count.missing),
                      .duplicates = static_cast<std::int64_t>(count.duplicates),
                      .disordered = static_cast<std::int64_t>(count.disordered)});
  }
  return counts;
}

Heartbeat::Heartbeat(const Watched& watched, std::function<void()> on_failure)
    : watched_{watched},
      on_failure_{std::move(on_failure)},
      service_{service_name()},
      thread_{[this](const std::stop_token& stop) { run(stop); }} {}

Heartbeat::~Heartbeat() = default;

void Heartbeat::run(const std::stop_token& stop) {
  std::mutex mutex;
  std::condition_variable_any stopped;
  std::unique_lock lock{mutex};
  while (!stop.stop_requested()) {
    beat();
    stopped.wait_for(lock, stop, kPeriod, [] { return false; });
  }
}

void Heartbeat::beat() {
  const auto status = watched_.subscriber.status();
  if (!status) {
    say_once(status.error().message);
    return;
  }
  for (const std::string& writer : status->reader.incompatible_writers) {
    say_once(writer);
  }
  if (const auto readers = watched_.publisher.incompatible_readers()) {
    for (const std::string& reader : *readers) {
      say_once(reader);
    }
  }
  const SequenceCounts counts = total(*status);
  if (counts.missing > gaps_) {
    spdlog::error("{} samples are missing: gaps in seq", counts.missing);
  }
  gaps_ = counts.missing;
  if (status->reader.lost > lost_) {
    spdlog::error("Cyclone reports {} lost samples", status->reader.lost);
  }
  lost_ = status->reader.lost;

  const ArchiveStatistics archive = watched_.archive.statistics();
  std::string health = "ok";
  if (!status->taking && !status->failure.empty()) {
    health = "not taking samples: " + status->failure;
  } else if (archive.failure) {
    health = "not storing: " + archive.failure->message;
  } else if (!status->reader.incompatible_writers.empty()) {
    health = status->reader.incompatible_writers.front();
  } else if (counts.missing > 0) {
    health = fmt::format("{} samples missing", counts.missing);
  }
  const auto published = watched_.publisher.publish(
      Health{.service = service_,
             .t = tai_now(),
             .samples_received = counts.received,
             .samples_committed = archive.samples_committed,
             .gaps = counts.missing,
             .duplicates = counts.duplicates,
             .queue_depth = watched_.queue.size() + archive.queued_batches,
             .commit_p99_ms = archive.commit_p99_ms.value_or(0.0),
             .status = health});
  if (!published) {
    say_once(published.error().message);
  }
  if (!status->taking && !status->failure.empty() && !std::exchange(failed_, true)) {
    spdlog::critical("not taking samples: {}", status->failure);
    on_failure_();
  }
}

void Heartbeat::say_once(const std::string& problem) {
  if (said_.insert(problem).second) {
    spdlog::error("{}", problem);
  }
}

}  // namespace spindrift
