#include "services/processor/pass_run.h"

#include <spdlog/spdlog.h>

#include <chrono>
#include <iterator>
#include <memory>
#include <utility>
#include <variant>

#include "pipelines/spin/batch/batch_estimator.h"
#include "services/clock/wall_clock.h"
#include "services/words/notice_words.h"

namespace spindrift {
namespace {

constexpr std::chrono::minutes kBetweenBatches{1};

Expected<BatchSolution> solve(const SpinConfig& config, const Orbit& orbit, PassEdges edges) {
  const auto starts = edges.starts(config.prior);
  return spindrift::solve_batch(config, orbit, std::move(edges).edges(), starts);
}

/// Its estimate, and what else it says.
/// @return Unobservable when any of it is withheld.
Expected<std::vector<Product>> products_of(const BatchSolution& solution) {
  std::vector<Product> products{solution.estimate, std::make_shared<const BatchSolution>(solution)};
  for (const Product& product : products) {
    if (const auto why = why_withheld(product)) {
      return Unexpected{{ErrorCode::Unobservable, sentence_of(*why)}};
    }
  }
  return products;
}

}  // namespace

PassRun::PassRun(const Mission& mission, const std::string& run_id, BatchPlan plan)
    : spacecraft_id_{mission.spacecraft_id},
      config_{*mission.spin()},
      orbit_{*mission.orbit},
      pass_{config_, orbit_},
      plan_{plan} {
  begin(run_id);
}

void PassRun::begin(const std::string& run_id) {
  RunSummary fresh;
  fresh.run_id = run_id;
  fresh.spacecraft_id = spacecraft_id_;
  summary_ = std::move(fresh);
  pass_ = SpinPass{config_, orbit_};
  again_from_.reset();
  edges_ = {};
  next_batch_.reset();
}

ArchiveBatch PassRun::batch() const {
  ArchiveBatch batch;
  batch.run_id = summary_.run_id;
  batch.spacecraft_id = spacecraft_id_;
  return batch;
}

void PassRun::go_on(const std::string& run_id, TaiTime again_from) {
  begin(run_id);
  again_from_ = again_from;
}

std::vector<ArchiveBatch> PassRun::compute(const PassInput& input) {
  std::vector<ArchiveBatch> batches;
  if (input.run_id != summary_.run_id) {
    batches.push_back(finish());
    finished_.push_back(std::move(summary_));
    begin(input.run_id);
  }
  Computed computed;
  computed.fill(batch());
  const auto take = [&]<class Value>(const Arrived<Value>& arrived) {
    // Of the other kinds of telemetry it knows nothing.
    if constexpr (requires { pass_.push(arrived.value); }) {
      keep(pass_.push(arrived.value), arrived.value.t, computed);
    }
  };
  in_order_of_arrival(input.values, input.silences, take, [&](std::int64_t /*place*/) {
    keep(pass_.fall_silent(), std::nullopt, computed);
  });
  for (ArchiveBatch& batch : computed) {
    if (!batch.products.empty() || batch.continuation) {
      batches.push_back(std::move(batch));
    }
  }
  return batches;
}

void PassRun::keep(SpinOutput output, std::optional<TaiTime> t, Computed& computed) {
  withheld_.take_from(output);
  note(output);
  if (again_from_ && t && *t >= *again_from_) {
    computed.front().continuation = Continuation{.t = *std::exchange(again_from_, {})};
  }
  if (again_from_) {
    return;
  }
  for (SpinProduct& made : output.products) {
    Product product = product_of(std::move(made));
    const std::size_t place = is_detail(product) ? 1 + product.index() : 0;
    computed.at(place).products.push_back(std::move(product));
  }
}

BackgroundTask PassRun::batch_task() const {
  return {.spacecraft_id = spacecraft_id_,
          // Configuration and orbit stay as they are.
          .solve = [this, solved = batch(), edges = edges_]() -> Expected<ArchiveBatch> {
            const auto solution = solve(config_, orbit_, edges);
            return solution.and_then(&products_of).map([&](std::vector<Product> products) {
              ArchiveBatch with_solution = solved;
              with_solution.products = std::move(products);
              return with_solution;
            });
          }};
}

/// By the time of telemetry, so that the same telemetry gives the same solutions. What is stored
/// already needs none.
void PassRun::note_time(TaiTime t) {
  if (plan_ == BatchPlan::WholePass || (next_batch_ && t < *next_batch_)) {
    return;
  }
  if (next_batch_ && !again_from_) {
    edges_.keep_last(kLastRevolutions);
    due_.push_back(batch_task());
  }
  next_batch_ = t + kBetweenBatches;
}

std::vector<BackgroundTask> PassRun::take_background_tasks() { return std::exchange(due_, {}); }

ArchiveBatch PassRun::finish() {
  ArchiveBatch last = batch();
  SpinOutput output = pass_.finish();
  withheld_.take_from(output);
  const std::size_t due = due_.size();
  note(output);
  due_.erase(due_.begin() + static_cast<std::ptrdiff_t>(due), due_.end());  // The last is below.
  for (SpinProduct& product : output.products) {
    last.products.push_back(product_of(std::move(product)));
  }
  last.finished_utc = utc_now();
  if (plan_ == BatchPlan::EveryMinute) {
    edges_.keep_last(kLastRevolutions);
  }
  if (edges_.forgot_some()) {
    spdlog::warn("{}: more edges than the batch solution can hold: it rests on the last {}",
                 spacecraft_id_, PassEdges::kMost);
  }
  solve_batch(last);
  return last;
}

void PassRun::solve_batch(ArchiveBatch& last) {
  const auto solution = solve(config_, orbit_, std::exchange(edges_, {}));
  if (auto products = solution.and_then(&products_of)) {
    summary_.count(solution->estimate);
    summary_.batch = *solution;
    std::move(products->begin(), products->end(), std::back_inserter(last.products));
  } else if (summary_.edges_accepted > 0 || !summary_.edges_rejected.empty()) {
    spdlog::warn("{}: no batch solution: {}", spacecraft_id_, products.error().message);
  }
}

std::vector<RunSummary> PassRun::summaries() const {
  std::vector<RunSummary> summaries = finished_;
  summaries.push_back(summary_);
  return summaries;
}

void PassRun::note(const SpinOutput& output) {
  for (const Notice& notice : output.notices) {
    spdlog::warn("{}: {}", spacecraft_id_, sentence_of(notice));
  }
  for (const SpinProduct& product : output.products) {
    summary_.count(product);
    edges_.note(product);
    if (const auto* estimate = std::get_if<SpinEstimate>(&product)) {
      note_time(estimate->t);
    }
  }
}

}  // namespace spindrift
