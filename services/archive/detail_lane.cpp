#include "services/archive/detail_lane.h"

#include <limits>
#include <numeric>
#include <utility>

namespace spindrift {
namespace {

// About ten revolutions; more share pages no better, and their commit takes too long.
constexpr std::size_t kEnough = 64;
constexpr std::chrono::seconds kLongest{1};

}  // namespace

void DetailLane::push(ArchiveBatch batch, Instant now) {
  const auto group = waiting_
                         .try_emplace({batch.run_id, batch.products.front().index()},
                                      Waiting{.batches = {}, .rows = 0, .since = now})
                         .first;
  by_due_.erase({due(group->second), &group->first});
  const std::size_t rows = row_count(batch);
  group->second.rows += rows;
  rows_ += rows;
  group->second.batches.push_back(std::move(batch));
  by_due_.emplace(due(group->second), &group->first);
}

std::vector<ArchiveBatch> DetailLane::take_due(Instant now, std::size_t rows) {
  std::vector<ArchiveBatch> taken;
  if (const auto next = next_due(); next && *next <= now) {
    move(waiting_.find(*by_due_.begin()->second), rows, taken);
  }
  return taken;
}

std::vector<ArchiveBatch> DetailLane::take_all(const std::string& run_id) {
  std::vector<ArchiveBatch> taken;
  auto group = waiting_.lower_bound({run_id, 0});
  while (group != waiting_.end() && group->first.first == run_id) {
    move(group++, std::numeric_limits<std::size_t>::max(), taken);
  }
  return taken;
}

std::optional<DetailLane::Instant> DetailLane::next_due() const {
  return by_due_.empty() ? std::nullopt : std::optional{by_due_.begin()->first};
}

std::size_t DetailLane::size() const {
  return std::accumulate(
      waiting_.begin(), waiting_.end(), std::size_t{0},
      [](std::size_t sum, const auto& run) { return sum + run.second.batches.size(); });
}

DetailLane::Instant DetailLane::due(const Waiting& waiting) {
  return waiting.rows >= kEnough ? waiting.since : waiting.since + kLongest;
}

void DetailLane::move(Groups::iterator group, std::size_t rows, std::vector<ArchiveBatch>& taken) {
  Waiting& waiting = group->second;
  by_due_.erase({due(waiting), &group->first});
  for (const std::size_t before = waiting.rows;
       !waiting.batches.empty() && before - waiting.rows < rows;) {
    waiting.rows -= row_count(waiting.batches.front());
    rows_ -= row_count(waiting.batches.front());
    taken.push_back(std::move(waiting.batches.front()));
    waiting.batches.pop_front();
  }
  if (waiting.batches.empty()) {
    waiting_.erase(group);
  } else {
    by_due_.emplace(due(waiting), &group->first);
  }
}

}  // namespace spindrift
