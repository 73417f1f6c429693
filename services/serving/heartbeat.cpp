#include "services/serving/heartbeat.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>
#include <systemd/sd-daemon.h>

#include <algorithm>
#include <chrono>
#include <string>
#include <utility>

#include "services/base/contained.h"
#include "services/base/every.h"
#include "services/base/wall_clock.h"

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

// A refusal of the archive is not reported here: whoever closes the archive gets the error.
AlertOutbox::AlertOutbox(const ServiceParts& parts)
    : parts_{parts}, thread_{[this] {
        parts_.failures.report(contained("storing alerts", [this] {
          while (auto batch = waiting_.take()) {
            if (!parts_.archive.submit(*std::move(batch))) {
              return;
            }
          }
        }));
      }} {}

AlertOutbox::~AlertOutbox() {
  waiting_.close();
  thread_.join();
}

void AlertOutbox::push(ArchiveBatch batch) {
  parts_.announce(batch);
  if (waiting_.size() < kMostWaiting) {
    waiting_.push(std::move(batch));
  } else {
    parts_.desk.take_back(batch);
  }
}

Heartbeat::Heartbeat(const ServiceParts& parts, const Heard& heard,
                     const TelemetrySubscriber& subscriber, const BoundedQueue<PassInput>& work)
    : parts_{parts},
      heard_{heard},
      subscriber_{subscriber},
      work_{work},
      outbox_{parts},
      service_{parts, heard},
      verdicts_{parts.db,         parts.processor.spacecraft(),
                parts.desk,       parts.new_answers,
                parts.on_verdict, parts.failures},
      thread_{[this](const std::stop_token& stop) {
        parts_.failures.report(contained("heartbeat", [&] { run(stop); }));
      }} {}

Heartbeat::~Heartbeat() = default;

void Heartbeat::run(const std::stop_token& stop) {
  every(kPeriod, stop, [this] { beat(); });
}

void Heartbeat::beat() {
  const auto status = subscriber_.status();
  if (!status) {
    say_once(status.error().message);
    return;
  }
  for (const std::string& writer : status->reader.incompatible_writers) {
    say_once(writer);
  }
  if (const auto readers = parts_.publisher.incompatible_readers()) {
    for (const std::string& reader : *readers) {
      say_once(reader);
    }
  }
  note_losses(*status);
  note_storing(parts_.archive.statistics().failure);
  publish_health(*status);
  if (status->taking) {
    static_cast<void>(sd_notify(0, "WATCHDOG=1"));  // Feeds the watchdog, if there is systemd.
    supervise(*status);
  }
  if (!status->taking && !status->failure.empty() && !std::exchange(failed_, true)) {
    parts_.failures.report(
        Unexpected{{ErrorCode::Unavailable, "not taking samples: " + status->failure}});
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
      parts_.problems.since(std::chrono::steady_clock::now() - LinkWatch::kStaleAfter);
  found.insert(found.end(), others.begin(), others.end());
  if (!gaps_.empty()) {
    found.push_back("samples missing: " + to_text(gaps_));
  }
  return found;
}

std::vector<SpacecraftHealth> Heartbeat::spacecraft() const {
  auto all = heard_.links.report(std::chrono::steady_clock::now());
  for (SpacecraftHealth& one : all) {
    one.verdict = verdicts_.of(one.spacecraft);
  }
  return all;
}

void Heartbeat::publish_health(const TelemetrySubscriberStatus& status) {
  const SequenceCounts counts = total(status);
  const ArchiveStatistics archive = parts_.archive.statistics();
  const std::vector<std::string> found = problems(status, archive.failure);
  const Health health{.t = tai_now(),
                      .samples_received = counts.received,
                      .samples_committed = archive.samples_committed,
                      .gaps = counts.missing,
                      .duplicates = counts.duplicates,
                      .queue_depth = parts_.taken.size() + work_.size() + archive.queued_batches,
                      .commit_p99_ms = archive.commit_p99_ms.value_or(0.0),
                      .status = found.empty() ? "ok" : found.front(),
                      .message = fmt::format("{}", fmt::join(found, "\n")),
                      .spacecraft = spacecraft(),
                      .works = (status.taking || status.failure.empty()) && !archive.failure};
  parts_.on_health(health);
  const auto published = parts_.publisher.publish(health);
  if (!published) {
    say_once(published.error().message);
  }
}

void Heartbeat::supervise(const TelemetrySubscriberStatus& status) {
  const auto states = service_.look(status, gaps_);
  if (!states) {
    say_once(states.error().message);
    return;
  }
  for (ArchiveBatch& batch : parts_.desk.evaluate(*states, service_.t())) {
    outbox_.push(std::move(batch));
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
