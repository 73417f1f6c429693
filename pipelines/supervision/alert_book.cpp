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
constexpr double kHoldOffPerRaising = 10.0;

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
  ++alert.revision;
  alert.updated = t;
  alert.by = by;
  alert.note = note;
  return alert;
}

/// Returns the state of an alert whose condition holds.
AlertState state_of(const Alert& alert) {
  return alert.shelved_until ? AlertState::Shelved
         : alert.accepted    ? AlertState::Acknowledged
                             : AlertState::Active;
}

}  // namespace

void AlertBook::take_up(const std::string& run_id, Alert alert) {
  const TaiTime settled = alert.cleared.value_or(alert.returned.value_or(alert.raised));
  const std::string key = alert.key;
  const AlertState state = alert.state;
  by_key_.insert_or_assign(
      key, Entry{.last = std::move(alert), .run_id = run_id, .settled = settled, .given = state});
}

std::string AlertBook::run_of(const std::string& key) const {
  const auto entry = by_key_.find(key);
  return entry == by_key_.end() ? std::string{} : entry->second.run_id;
}

std::int64_t AlertBook::count_of(const std::string& key) const {
  const auto entry = by_key_.find(key);
  return entry == by_key_.end() ? 0 : entry->second.last.count;
}

bool AlertBook::has_room(const Alert& alert, TaiTime t) const {
  const auto in_the_hour = std::count_if(given_.begin(), given_.end(), [t](TaiTime given) {
    return (given > t ? given - t : t - given) < std::chrono::hours{1};
  });
  return static_cast<std::size_t>(in_the_hour) < (alert.returned ? kMostAnHour / 2 : kMostAnHour);
}

void AlertBook::count_given(TaiTime t) {
  given_.push_back(t);
  if (given_.size() > kMostAnHour) {
    given_.pop_front();
  }
}

std::optional<Alert> AlertBook::give(Entry& entry) {
  Alert& alert = entry.last;
  if (!has_room(alert, alert.updated)) {
    ++entry.not_given;
    return std::nullopt;
  }
  count_given(alert.updated);
  alert.from = std::exchange(entry.given, alert.state);
  if (const auto not_given = std::exchange(entry.not_given, 0); not_given > 0) {
    alert.note += fmt::format("{}{} changes before it are left out, as there are too many",
                              alert.note.empty() ? "" : "; ", not_given);
  }
  return alert;
}

std::vector<Alert> AlertBook::catch_up(TaiTime t) {
  std::vector<Alert> given;
  for (auto& [key, entry] : by_key_) {
    if (entry.not_given > 0 && has_room(entry.last, t)) {
      --entry.not_given;  // The last of them is the one that is given.
      entry.last.updated = std::max(entry.last.updated, t);
      if (auto alert = give(entry)) {
        given.push_back(*std::move(alert));
      }
    }
  }
  return given;
}

/// An alert whose end was not given goes on, since its successor would leave it open for ever.
bool AlertBook::returns(const Entry& entry, const Occurrence& occurrence) {
  const double hold_off_s = std::max(occurrence.hold_off_s, kHoldOffPerRaising * occurrence.took_s);
  return entry.not_given > 0 ||
         (occurrence.t >= entry.settled &&
          seconds_between(entry.settled, occurrence.t) - occurrence.took_s <= hold_off_s);
}

TaiTime AlertBook::after(const std::string& key, TaiTime t) const {
  const auto entry = by_key_.find(key);
  return entry == by_key_.end() ? t : std::max(t, entry->second.settled + kMoment);
}

std::optional<Alert> AlertBook::raise(const Occurrence& occurrence) {
  const auto [found, is_first] = by_key_.try_emplace(occurrence.key);
  Entry& entry = found->second;
  if (!is_first && is_known(entry, occurrence)) {
    return std::nullopt;
  }
  if (!is_first && is_open(entry.last)) {
    entry.run_id = occurrence.run_id;
    entry.settled = occurrence.t;
    return std::nullopt;
  }
  Alert& alert = entry.last;
  if (!is_first && returns(entry, occurrence)) {
    alert.returned = occurrence.t;
    alert.cleared.reset();
  } else {
    alert = {.alert_id = id_of(occurrence),
             .key = occurrence.key,
             .revision = 0,
             .raised = occurrence.t,
             .shelved_until = alert.shelved_until,
             .count = is_first ? 0 : alert.count};
    entry.given.reset();
  }
  entry.run_id = occurrence.run_id;
  entry.settled = occurrence.t;
  ++alert.count;
  alert.severity = occurrence.severity;
  alert.message = occurrence.message;
  alert.evidence = occurrence.evidence;
  change(alert, state_of(alert), occurrence.t, kService, "");
  return give(entry);
}

std::optional<Alert> AlertBook::clear(const Occurrence& occurrence) {
  const auto found = by_key_.find(occurrence.key);
  if (found == by_key_.end() || !is_open(found->second.last) ||
      is_known(found->second, occurrence)) {
    return std::nullopt;
  }
  Entry& entry = found->second;
  entry.settled = occurrence.t;
  entry.last.cleared = std::max(occurrence.t, entry.last.raised);
  change(entry.last, AlertState::Cleared, occurrence.t, kService, occurrence.message);
  return give(entry);
}

std::optional<Alert> AlertBook::renew(const Occurrence& occurrence) {
  const auto found = by_key_.find(occurrence.key);
  if (found == by_key_.end() || !is_open(found->second.last) || found->second.not_given > 0 ||
      is_known(found->second, occurrence)) {
    return std::nullopt;
  }
  Alert& alert = found->second.last;
  change(alert, alert.state, occurrence.t, "", "");
  alert.message = occurrence.message;
  alert.evidence = occurrence.evidence;
  return alert;
}

Expected<AlertBook::Entry*> AlertBook::find_open(const std::string& alert_id) {
  for (auto& [key, entry] : by_key_) {
    if (entry.last.alert_id == alert_id && is_open(entry.last)) {
      return &entry;
    }
  }
  return Unexpected{{ErrorCode::InvalidInput, fmt::format("no alert '{}' is open", alert_id)}};
}

/// What an operator says is always given.
Alert AlertBook::obey(Entry& entry, AlertState to, TaiTime t, const std::string& by,
                      const std::string& note) {
  change(entry.last, to, t, by, note);
  entry.last.from = std::exchange(entry.given, to);
  count_given(t);
  return entry.last;
}

Expected<Alert> AlertBook::acknowledge(const std::string& alert_id, TaiTime t,
                                       const std::string& by, const std::string& note) {
  return find_open(alert_id).and_then([&](Entry* entry) -> Expected<Alert> {
    Alert& alert = entry->last;
    if (alert.state == AlertState::Acknowledged) {
      return Unexpected{
          {ErrorCode::InvalidInput,
           fmt::format("alert '{}' ({}) has been acknowledged already", alert_id, alert.key)}};
    }
    alert.shelved_until.reset();
    alert.accepted = Acknowledgement{.by = by, .t = t};
    return obey(*entry, AlertState::Acknowledged, t, by, note);
  });
}

Expected<Alert> AlertBook::shelve(const std::string& alert_id, TaiTime t, TaiTime until,
                                  const std::string& by, const std::string& note) {
  return find_open(alert_id).map([&](Entry* entry) {
    entry->last.shelved_until = until;
    entry->last.accepted.reset();
    return obey(*entry, AlertState::Shelved, t, by, note);
  });
}

std::vector<Alert> AlertBook::expire(TaiTime t) {
  std::vector<Alert> changed;
  for (auto& [key, entry] : by_key_) {
    if (!entry.last.shelved_until || *entry.last.shelved_until > t) {
      continue;
    }
    entry.last.shelved_until.reset();
    if (entry.last.state == AlertState::Shelved) {
      change(entry.last, AlertState::Active, t, kService, "its time is up");
      if (auto alert = give(entry)) {
        changed.push_back(*std::move(alert));
      }
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
