#include "pipelines/supervision/alert_book.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <string_view>
#include <utility>

namespace spindrift {
namespace {

constexpr std::string_view kService = "spindrift";
// An alert changes far less than once a millisecond.
constexpr std::chrono::milliseconds kMoment{1};

/// Computes the id by FNV-1a, so that a recomputed occurrence gets the same id everywhere.
std::string id_of(const Occurrence& occurrence) {
  constexpr std::uint64_t kBasis = 0xcbf29ce484222325;
  constexpr std::uint64_t kPrime = 0x100000001b3;
  std::uint64_t hash = kBasis;
  for (const char c :
       fmt::format("{}\n{}\n{}", occurrence.run_id, occurrence.key, tai_ns(occurrence.t))) {
    hash = (hash ^ static_cast<unsigned char>(c)) * kPrime;
  }
  return fmt::format("{:016x}", hash);
}

bool is_open(const Alert& alert) { return alert.state != AlertState::Cleared; }

const Alert& change(Alert& alert, AlertState to, TaiTime t, std::string_view by,
                    std::string_view note) {
  alert.from = std::exchange(alert.state, to);
  alert.shelved_until.reset();
  ++alert.revision;
  alert.updated = t;
  alert.by = by;
  alert.note = note;
  return alert;
}

}  // namespace

void AlertBook::take_up(const std::string& run_id, Alert alert) {
  const TaiTime settled = alert.cleared.value_or(alert.raised);
  const std::string key = alert.key;
  by_key_.insert_or_assign(key,
                           Entry{.last = std::move(alert), .run_id = run_id, .settled = settled});
}

TaiTime AlertBook::after(const std::string& key, TaiTime t) const {
  const auto entry = by_key_.find(key);
  return entry == by_key_.end() ? t : std::max(t, entry->second.settled + kMoment);
}

std::optional<Alert> AlertBook::raise(const Occurrence& occurrence) {
  const auto entry = by_key_.find(occurrence.key);
  const bool was_before = entry != by_key_.end();
  if (was_before && (is_open(entry->second.last) || is_known(entry->second, occurrence))) {
    return std::nullopt;
  }
  Alert alert{.alert_id = id_of(occurrence),
              .key = occurrence.key,
              .severity = occurrence.severity,
              .raised = occurrence.t,
              .updated = occurrence.t,
              .count = was_before ? entry->second.last.count + 1 : 1,
              .message = occurrence.message,
              .evidence = occurrence.evidence,
              .by = std::string{kService}};
  by_key_.insert_or_assign(
      alert.key, Entry{.last = alert, .run_id = occurrence.run_id, .settled = occurrence.t});
  return alert;
}

std::optional<Alert> AlertBook::clear(const Occurrence& occurrence) {
  const auto entry = by_key_.find(occurrence.key);
  if (entry == by_key_.end() || !is_open(entry->second.last) ||
      is_known(entry->second, occurrence)) {
    return std::nullopt;
  }
  entry->second.settled = occurrence.t;
  entry->second.last.cleared = std::max(occurrence.t, entry->second.last.raised);
  return change(entry->second.last, AlertState::Cleared, occurrence.t, kService,
                occurrence.message);
}

Expected<Alert*> AlertBook::find_open(const std::string& alert_id) {
  for (auto& [key, entry] : by_key_) {
    if (entry.last.alert_id == alert_id && is_open(entry.last)) {
      return &entry.last;
    }
  }
  return Unexpected{{ErrorCode::InvalidInput, fmt::format("no alert '{}' is open", alert_id)}};
}

Expected<Alert> AlertBook::acknowledge(const std::string& alert_id, TaiTime t,
                                       const std::string& by, const std::string& note) {
  return find_open(alert_id).and_then([&](Alert* alert) -> Expected<Alert> {
    if (alert->state == AlertState::Acknowledged) {
      return Unexpected{
          {ErrorCode::InvalidInput,
           fmt::format("alert '{}' ({}) has been acknowledged already", alert_id, alert->key)}};
    }
    return change(*alert, AlertState::Acknowledged, t, by, note);
  });
}

Expected<Alert> AlertBook::shelve(const std::string& alert_id, TaiTime t, TaiTime until,
                                  const std::string& by, const std::string& note) {
  return find_open(alert_id).map([&](Alert* alert) {
    change(*alert, AlertState::Shelved, t, by, note);
    alert->shelved_until = until;
    return *alert;
  });
}

std::vector<Alert> AlertBook::expire(TaiTime t) {
  std::vector<Alert> changed;
  for (auto& [key, entry] : by_key_) {
    if (entry.last.state == AlertState::Shelved && entry.last.shelved_until <= t) {
      changed.push_back(change(entry.last, AlertState::Active, t, kService, "its time is up"));
    }
  }
  return changed;
}

std::vector<Alert> AlertBook::open() const {
  std::vector<Alert> alerts;
  for (const auto& [key, entry] : by_key_) {
    if (is_open(entry.last)) {
      alerts.push_back(entry.last);
    }
  }
  return alerts;
}

}  // namespace spindrift
