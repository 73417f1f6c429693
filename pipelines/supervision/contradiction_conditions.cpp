#include "pipelines/supervision/contradiction_conditions.h"

#include <algorithm>
#include <chrono>
#include <set>
#include <utility>

#include "pipelines/time/time_span.h"

namespace spindrift {
namespace {

constexpr std::chrono::minutes kRecent{1};

}  // namespace

ConditionChanges ContradictionConditions::evaluate(const SampleContradiction& contradiction) {
  newest_ = std::max(newest_, contradiction.t);
  std::set<std::string> all;
  std::set<std::string> doubted;
  for (const SampleContradiction::By& by : contradiction.by) {
    all.insert(by.name);
    if (by.sender != Sender::Preferred) {
      doubted.insert(by.name);
    }
  }
  ConditionChanges changes;
  for (const std::string& name : doubted.empty() ? all : doubted) {
    Source& source = sources_.try_emplace(name, name).first->second;
    source.last_minute.push_back(newest_);
    source.involved = all;
    add(look(name, source), changes);
  }
  return changes;
}

ConditionChanges ContradictionConditions::evaluate(TaiTime t) {
  ConditionChanges changes;
  if (t > newest_) {
    newest_ = t;
    for (auto& [name, source] : sources_) {
      add(look(name, source), changes);
    }
  }
  return changes;
}

std::optional<ConditionChange> ContradictionConditions::look(const std::string& name,
                                                             Source& source) const {
  auto& times = source.last_minute;
  while (!times.empty() && span_between(times.front(), newest_) >= kRecent) {
    times.pop_front();
  }
  auto change = source.watch.update(
      newest_, {.value = static_cast<double>(times.size()), .limit = limit_samples_});
  if (change && change->change != Change::Cleared) {
    change->evidence.sources.assign(source.involved.begin(), source.involved.end());
    for (const std::string& other : source.involved) {
      if (other != name) {
        change->who += (change->who.empty() ? "" : ", ") + other;
      }
    }
  }
  return change;
}

}  // namespace spindrift
