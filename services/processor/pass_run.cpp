#include "services/processor/pass_run.h"

#include <spdlog/spdlog.h>

#include <chrono>
#include <cstdint>
#include <iterator>
#include <limits>
#include <map>
#include <optional>
#include <string_view>
#include <utility>
#include <variant>

#include "services/clock/wall_clock.h"

namespace spindrift {
namespace {

/// So much of what was stored last is made again: longer than a pass holds anything back, since an
/// orderly stop has settled early what was held.
constexpr std::chrono::minutes kMadeAgain{10};
constexpr std::size_t kProductsPerBatch = 4096;

/// Products from here on are made again; all before are stored, for they are in order.
TaiTime made_again_from(const StoredPass& stored) {
  const auto reached = stored.last_revolution ? stored.last_revolution : stored.earliest;
  return reached ? *reached - kMadeAgain : TaiTime::min();
}

/// The fix and the estimates in force, those that are announced, as they pass by.
class LatestResults {
 public:
  void note(const std::vector<SpinProduct>& products) {
    for (const SpinProduct& product : products) {
      if (const auto* estimate = std::get_if<SpinEstimate>(&product)) {
        latest_.insert_or_assign(name_of(estimate->estimator), product);
      } else if (const auto* fix = std::get_if<SpinFix>(&product);
                 fix != nullptr && (fix->accepted || fix->resolution == Resolution::Ambiguous)) {
        latest_.insert_or_assign("fix", product);
      }
    }
  }

  void move_to(std::vector<SpinProduct>& products) {
    for (auto& [name, product] : std::exchange(latest_, {})) {
      products.push_back(std::move(product));
    }
  }

 private:
  std::map<std::string_view, SpinProduct> latest_;
};

/// Calls `feed` with each sample of `stored` in order of arrival until it gives an error.
template <class Feed>
Expected<void> in_order_of_arrival(const StoredPass& stored, const Feed& feed) {
  auto frame = stored.frames.begin();
  const auto feed_frames_before = [&](std::int64_t arrival) {
    Expected<void> fed;
    for (; fed && frame != stored.frames.end() && frame->arrival < arrival; ++frame) {
      fed = feed(frame->frame);
    }
    return fed;
  };
  for (const StoredPulse& stored_pulse : stored.pulses) {
    auto fed = feed_frames_before(stored_pulse.arrival);
    if (fed) {
      fed = feed(stored_pulse.pulse);
    }
    if (!fed) {
      return fed;
    }
  }
  return feed_frames_before(std::numeric_limits<std::int64_t>::max());
}

}  // namespace

PassRun::PassRun(const Mission& mission, std::string run_id)
    : config_{*mission.spin}, orbit_{*mission.orbit}, pass_{config_, orbit_} {
  summary_.run_id = std::move(run_id);
  summary_.spacecraft_id = mission.spacecraft_id;
}

void PassRun::begin(const std::string& run_id) {
  RunSummary fresh;
  fresh.run_id = run_id;
  fresh.spacecraft_id = summary_.spacecraft_id;
  summary_ = std::move(fresh);
  pass_ = SpinPass{config_, orbit_};
}

ArchiveBatch PassRun::batch() const {
  ArchiveBatch batch;
  batch.run_id = summary_.run_id;
  batch.spacecraft_id = summary_.spacecraft_id;
  return batch;
}

Expected<void> PassRun::go_on(const StoredPass& stored, const Submit& submit) {
  begin(stored.run_id);
  const TaiTime again_from = made_again_from(stored);
  ArchiveBatch again = batch();
  again.continuation = Continuation{.t = again_from};
  LatestResults latest;
  bool is_again = false;
  const auto feed = [&](const auto& sample) -> Expected<void> {
    SpinOutput output = pass_.push(sample);
    is_again = is_again || sample.t >= again_from;
    if (!is_again) {
      latest.note(output.products);
      keep(std::move(output), nullptr);
      return {};
    }
    latest.move_to(again.products);
    keep(std::move(output), &again.products);
    return again.products.size() < kProductsPerBatch ? Expected<void>{}
                                                     : submit(std::exchange(again, batch()));
  };
  if (auto fed = in_order_of_arrival(stored, feed); !fed) {
    return fed;
  }
  latest.move_to(again.products);
  spdlog::info("{}: continuing run {} after {} revolutions: {} samples read back",
               summary_.spacecraft_id, stored.run_id, summary_.revolutions,
               stored.pulses.size() + stored.frames.size());
  return submit(std::move(again));
}

std::vector<ArchiveBatch> PassRun::compute(const PassInput& input) {
  std::vector<ArchiveBatch> batches;
  if (input.run_id != summary_.run_id) {
    batches.push_back(finish());
    begin(input.run_id);
  }
  ArchiveBatch computed = batch();
  for (const Pulse& pulse : input.pulses) {
    keep(pass_.push(pulse), &computed.products);
  }
  for (const CodedFrame& frame : input.frames) {
    keep(pass_.push(frame), &computed.products);
  }
  if (!computed.products.empty()) {
    batches.push_back(std::move(computed));
  }
  return batches;
}

ArchiveBatch PassRun::finish() {
  ArchiveBatch last = batch();
  keep(pass_.finish(), &last.products);
  last.finished_utc = utc_now();
  return last;
}

void PassRun::keep(SpinOutput output, std::vector<SpinProduct>* products) {
  for (const std::string& notice : output.notices) {
    spdlog::warn("{}: {}", summary_.spacecraft_id, notice);
  }
  for (const SpinProduct& product : output.products) {
    summary_.count(product);
  }
  if (products != nullptr) {
    std::move(output.products.begin(), output.products.end(), std::back_inserter(*products));
  }
}

}  // namespace spindrift
