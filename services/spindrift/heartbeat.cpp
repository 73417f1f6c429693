#include "services/spindrift/heartbeat.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <utility>

#include "services/clock/wall_clock.h"

namespace spindrift {
namespace {

constexpr std::chrono::seconds kPeriod{1};
// Who looks at the log later must not have to look far back.
constexpr int kBeatsUntilSaidAgain = 10;

std::string service_name() {
  std::array<char, 48> host{};
  if (::gethostname(host.data(), host.size() - 1) != 0) {
    host = {"unknown"};
  }
  return fmt::format("spindrift {}:{}", host.data(), ::getpid());
}

SequenceCounts total(const TelemetrySubscriberStatus& status) {
  SequenceCounts sum;
  for (const auto& [source, counts] : status.by_source) {
    sum += counts;
  }
  return sum;
}

}  // namespace

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
  note_losses(*status);
  note_storing(watched_.archive.statistics().failure);
  publish_health(*status);
  if (!status->taking && !status->failure.empty() && !std::exchange(failed_, true)) {
    spdlog::critical("not taking samples: {}", status->failure);
    on_failure_();
  }
}

void Heartbeat::note_losses(const TelemetrySubscriberStatus& status) {
  auto gaps = gap_watch_.beat(status.by_source);
  const bool more = std::any_of(gaps.begin(), gaps.end(), [this](const auto& gap) {
    const auto told = gaps_.find(gap.first);
    return told == gaps_.end() || gap.second > told->second;
  });
  if (more) {
    spdlog::error("samples are missing, by gaps in seq: {}", to_text(gaps));
  }
  gaps_ = std::move(gaps);
  if (status.reader.lost > lost_) {
    spdlog::error("Cyclone reports {} lost samples", status.reader.lost);
  }
  lost_ = status.reader.lost;
}

void Heartbeat::note_storing(const std::optional<Error>& failure) {
  beats_not_storing_ = failure ? beats_not_storing_ + 1 : 0;
  if (failure && beats_not_storing_ % kBeatsUntilSaidAgain == 0) {
    spdlog::critical("the archive still does not store, nothing more is accepted: {}",
                     failure->message);
  }
}

void Heartbeat::publish_health(const TelemetrySubscriberStatus& status) {
  const SequenceCounts counts = total(status);
  const ArchiveStatistics archive = watched_.archive.statistics();
  std::string health = "ok";
  if (!status.taking && !status.failure.empty()) {
    health = "not taking samples: " + status.failure;
  } else if (archive.failure) {
    health = "not storing: " + archive.failure->message;
  } else if (!status.reader.incompatible_writers.empty()) {
    health = status.reader.incompatible_writers.front();
  } else if (!gaps_.empty()) {
    health = "samples missing: " + to_text(gaps_);
  }
  const auto published = watched_.publisher.publish(
      Health{.service = service_,
             .t = tai_now(),
             .samples_received = counts.received,
             .samples_committed = archive.samples_committed,
             .gaps = counts.missing,
             .duplicates = counts.duplicates,
             .queue_depth = watched_.taken.size() + watched_.work.size() + archive.queued_batches,
             .commit_p99_ms = archive.commit_p99_ms.value_or(0.0),
             .status = health});
  if (!published) {
    say_once(published.error().message);
  }
}

void Heartbeat::say_once(const std::string& problem) {
  if (said_.insert(problem).second) {
    spdlog::error("{}", problem);
  }
}

}  // namespace spindrift
