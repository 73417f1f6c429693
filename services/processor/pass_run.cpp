#include "services/processor/pass_run.h"

#include <spdlog/spdlog.h>

#include <iterator>
#include <map>
#include <optional>
#include <string_view>
#include <utility>
#include <variant>

#include "services/clock/wall_clock.h"

namespace spindrift {
namespace {

constexpr std::size_t kProductsPerBatch = 4096;

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

}  // namespace

PassRun::PassRun(const Mission& mission, const std::string& run_id)
    : spacecraft_id_{mission.spacecraft_id},
      config_{*mission.spin},
      orbit_{*mission.orbit},
      pass_{config_, orbit_} {
  begin(run_id);
}

void PassRun::begin(const std::string& run_id) {
  RunSummary fresh;
  fresh.run_id = run_id;
  fresh.spacecraft_id = spacecraft_id_;
  summary_ = std::move(fresh);
  pass_ = SpinPass{config_, orbit_};
}

ArchiveBatch PassRun::batch() const {
  ArchiveBatch batch;
  batch.run_id = summary_.run_id;
  batch.spacecraft_id = spacecraft_id_;
  return batch;
}

Expected<void> PassRun::go_on(const StoredPass& stored, std::span<const PassInput> inputs,
                              TaiTime again_from, const Submit& submit) {
  begin(stored.run_id);
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
  for (const PassInput& input : inputs) {
    Expected<void> fed;
    for (auto pulse = input.pulses.begin(); fed && pulse != input.pulses.end(); ++pulse) {
      fed = feed(*pulse);
    }
    for (auto frame = input.frames.begin(); fed && frame != input.frames.end(); ++frame) {
      fed = feed(*frame);
    }
    if (!fed) {
      return fed;
    }
  }
  latest.move_to(again.products);
  spdlog::info("{}: continuing run {} after {} revolutions: {} samples read back", spacecraft_id_,
               stored.run_id, summary_.revolutions, stored.pulses.size() + stored.frames.size());
  return submit(std::move(again));
}

std::vector<ArchiveBatch> PassRun::compute(const PassInput& input) {
  std::vector<ArchiveBatch> batches;
  if (input.run_id != summary_.run_id) {
    batches.push_back(finish());
    finished_.push_back(std::move(summary_));
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

std::vector<RunSummary> PassRun::summaries() const {
  std::vector<RunSummary> summaries = finished_;
  summaries.push_back(summary_);
  return summaries;
}

void PassRun::keep(SpinOutput output, std::vector<SpinProduct>* products) {
  for (const std::string& notice : output.notices) {
    spdlog::warn("{}: {}", spacecraft_id_, notice);
  }
  for (const SpinProduct& product : output.products) {
    summary_.count(product);
  }
  if (products != nullptr) {
    std::move(output.products.begin(), output.products.end(), std::back_inserter(*products));
  }
}

}  // namespace spindrift
