#include "services/serving/computing.h"

#include <utility>
#include <vector>

#include "services/archive/submit_all.h"

namespace spindrift {
namespace {

// More samples or batches than these are a burst, which goes to the backlog.
constexpr std::size_t kFewSamples = 64;
constexpr std::size_t kFewBatches = 8;

}  // namespace

Expected<void> Computing::enqueue(PassInput input, std::size_t batches_behind) {
  const bool is_little = sample_count(input) <= kFewSamples && batches_behind <= kFewBatches;
  // The queue of solutions must have room, because the routing thread must not wait for it.
  if (is_little && waiting_ == 0 && tasks_.is_roomy()) {
    return compute(input);
  }
  leave_to_backlog(std::move(input));
  return {};
}

void Computing::leave_to_backlog(PassInput input) {
  ++waiting_;
  backlog_.push(std::move(input));
}

Expected<void> Computing::work_off() {
  let_samples_come_first();
  while (const auto input = backlog_.take()) {
    if (auto stored = compute(*input); !stored) {
      return stored;
    }
    --waiting_;
  }
  return {};
}

Expected<void> Computing::compute(const PassInput& input) {
  if (patience_.ended) {
    samples_left_ += sample_count(input);
  } else {
    std::vector<ArchiveBatch> batches = processor_.compute(input);
    for (ArchiveBatch& batch : batches) {
      batch.came = input.came;
    }
    if (auto stored = submit_all(archive_, std::move(batches)); !stored) {
      return stored;
    }
  }
  for (BackgroundTask& task : processor_.take_background_tasks(input)) {
    tasks_.push(std::move(task));
  }
  return {};
}

}  // namespace spindrift
