#include "services/serving/session_watch.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace spindrift {

void SessionWatch::go_on(const std::string& spacecraft, const LastOrigins& origins,
                         std::optional<TaiTime> newest) {
  const std::lock_guard lock{mutex_};
  Spacecraft& one = spacecraft_[spacecraft];
  one.newest = newest;
  for (const auto& of_kind : origins) {
    for (const Origin& origin : of_kind) {
      if (one.sources.size() < kMostSources || one.sources.contains(origin.source)) {
        one.sources[origin.source].sessions.insert(origin.session);
      }
    }
  }
}

void SessionWatch::follow(const ArchiveBatch& batch) {
  const std::lock_guard lock{mutex_};
  samples_ += count_of(batch.samples);
  Spacecraft& one = spacecraft_[batch.spacecraft_id];
  batch.samples.for_each([&](const auto& of_kind) {
    const Origin* last = nullptr;
    Source* source = nullptr;
    for (const auto& sample : of_kind) {
      if (last == nullptr || last->session != sample.origin.session ||
          last->source != sample.origin.source) {
        last = &sample.origin;
        source = source_of(one, sample.origin);
      }
      if (source != nullptr && source->before && sample.value.t <= *source->before) {
        ++source->record.repeated;
      }
    }
  });
  batch.samples.for_each([&](const auto& of_kind) {
    for (const auto& sample : of_kind) {
      one.newest = std::max(one.newest.value_or(sample.value.t), sample.value.t);
    }
  });
}

SessionWatch::Source* SessionWatch::source_of(Spacecraft& spacecraft, const Origin& origin) {
  auto& sources = spacecraft.sources;
  if (sources.size() >= kMostSources && !sources.contains(origin.source)) {
    return nullptr;
  }
  Source& source = sources[origin.source];
  const bool is_first = source.sessions.empty();
  if (source.sessions.size() < kMostSessions && source.sessions.insert(origin.session).second) {
    source.record.restarts += is_first ? 0 : 1;
    source.session = origin.session;
    source.before = spacecraft.newest;
  } else if (source.session != origin.session) {
    source.session = origin.session;
    source.before.reset();
  }
  return &source;
}

std::map<std::string, SourceRecord> SessionWatch::report(
    const std::string& spacecraft, const std::map<std::string, std::uint64_t>& missing) const {
  const std::lock_guard lock{mutex_};
  std::map<std::string, SourceRecord> records;
  if (const auto one = spacecraft_.find(spacecraft); one != spacecraft_.end()) {
    for (const auto& [name, source] : one->second.sources) {
      SourceRecord& record = records.emplace(name, source.record).first->second;
      if (const auto gap = missing.find(name); source.session && gap != missing.end()) {
        record.missing = static_cast<std::int64_t>(gap->second);
      }
    }
  }
  return records;
}

std::uint64_t SessionWatch::samples() const {
  const std::lock_guard lock{mutex_};
  return samples_;
}

std::map<std::string, std::uint64_t> GapWatch::beat(
    const std::map<std::string, SequenceCounts>& by_source) {
  std::map<std::string, std::uint64_t> now;
  std::map<std::string, std::uint64_t> lasting;
  for (const auto& [source, counts] : by_source) {
    if (counts.missing == 0) {
      continue;
    }
    now.emplace(source, counts.missing);
    if (const auto before = before_.find(source); before != before_.end()) {
      lasting.emplace(source, std::min(before->second, counts.missing));
    }
  }
  before_ = std::move(now);
  return lasting;
}

std::string to_text(const std::map<std::string, std::uint64_t>& gaps) {
  std::string text;
  for (const auto& [source, missing] : gaps) {
    text += fmt::format("{}{} {}", text.empty() ? "" : ", ", source, missing);
  }
  return text;
}

}  // namespace spindrift
