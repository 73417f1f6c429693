#include "services/serving/heartbeat.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <chrono>
#include <string>
#include <utility>

#include "services/base/contained.h"
#include "services/base/every.h"
#include "services/base/wall_clock.h"
#include "services/serving/service_manager.h"

namespace spindrift {
namespace {

constexpr std::chrono::seconds kPeriod{1};
// A lasting failure is repeated in the log, so that its reader need not look far back.
constexpr int kBeatsUntilSaidAgain = 10;
constexpr std::size_t kMostSaid = 1000;

SequenceCounts total(const TelemetrySubscriberStatus& status) {
  SequenceCounts sum;
  for (const auto& [source, counts] : status.by_source) {
    sum += counts;
  }
  return sum;
}

}  // namespace

Heartbeat::Heartbeat(Watched watched, ThreadFailures& failures)
    : watched_{std::move(watched)},
      failures_{failures},
      thread_{[this](const std::stop_token& stop) {
        failures_.note(contained("heartbeat", [&] { run(stop); }));
      }} {}

Heartbeat::~Heartbeat() = default;

void Heartbeat::run(const std::stop_token& stop) {
  every(kPeriod, stop, [this] { beat(); });
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
  if (status->taking) {
    tell_manager_alive();
    supervise(*status);
  }
  if (!status->taking && !status->failure.empty() && !std::exchange(failed_, true)) {
    failures_.note(Unexpected{{ErrorCode::Unavailable, "not taking samples: " + status->failure}});
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
  if (!failure && beats_not_storing_ > 0) {
    spdlog::info("the archive stores again");
  }
  beats_not_storing_ = failure ? beats_not_storing_ + 1 : 0;
  if (failure && beats_not_storing_ % kBeatsUntilSaidAgain == 0) {
    spdlog::critical("the archive still does not store, nothing more is accepted: {}",
                     failure->message);
  }
}

// Returns the problems, the worst first.
std::vector<std::string> Heartbeat::problems(const TelemetrySubscriberStatus& status,
                                             const std::optional<Error>& archive_failure) const {
  std::vector<std::string> found;
  if (!status.taking && !status.failure.empty()) {
    found.push_back("not taking samples: " + status.failure);
  }
  if (archive_failure) {
    found.push_back("not storing: " + archive_failure->message);
  }
  const auto& writers = status.reader.incompatible_writers;
  found.insert(found.end(), writers.begin(), writers.end());
  const auto others =
      watched_.problems.since(std::chrono::steady_clock::now() - LinkWatch::kStaleAfter);
  found.insert(found.end(), others.begin(), others.end());
  if (!gaps_.empty()) {
    found.push_back("samples missing: " + to_text(gaps_));
  }
  return found;
}

std::vector<SpacecraftHealth> Heartbeat::spacecraft() const {
  auto all = watched_.links.report(std::chrono::steady_clock::now());
  for (SpacecraftHealth& one : all) {
    one.verdict = watched_.verdicts.of(one.spacecraft);
  }
  return all;
}

void Heartbeat::publish_health(const TelemetrySubscriberStatus& status) {
  const SequenceCounts counts = total(status);
  const ArchiveStatistics archive = watched_.archive.statistics();
  const std::vector<std::string> found = problems(status, archive.failure);
  const Health health{
      .t = tai_now(),
      .samples_received = counts.received,
      .samples_committed = archive.samples_committed,
      .gaps = counts.missing,
      .duplicates = counts.duplicates,
      .queue_depth = watched_.taken.size() + watched_.work.size() + archive.queued_batches,
      .commit_p99_ms = archive.commit_p99_ms.value_or(0.0),
      .status = found.empty() ? "ok" : found.front(),
      .message = fmt::format("{}", fmt::join(found, "\n")),
      .spacecraft = spacecraft(),
      .works = (status.taking || status.failure.empty()) && !archive.failure};
  watched_.on_health(health);
  const auto published = watched_.publisher.publish(health);
  if (!published) {
    say_once(published.error().message);
  }
}

void Heartbeat::supervise(const TelemetrySubscriberStatus& status) {
  const auto states = watched_.service.look(status, gaps_);
  if (!states) {
    say_once(states.error().message);
    return;
  }
  for (ArchiveBatch& batch : watched_.desk.see(*states, watched_.service.t())) {
    watched_.outbox.push(std::move(batch));
  }
}

void Heartbeat::say_once(const std::string& problem) {
  // The number is bounded because problems contain names that other writers choose.
  if (said_.size() < kMostSaid && said_.insert(problem).second) {
    spdlog::error("{}{}", problem,
                  said_.size() == kMostSaid ? "; no more of such problems are said" : "");
  }
}

}  // namespace spindrift
