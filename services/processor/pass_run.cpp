#include "services/processor/pass_run.h"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <chrono>
#include <iterator>
#include <memory>
#include <utility>
#include <variant>

#include "pipelines/spin/batch/batch_estimator.h"
#include "pipelines/time/utc.h"
#include "services/clock/wall_clock.h"
#include "services/processor/what_is_thrown.h"
#include "services/words/notice_words.h"

namespace spindrift {
namespace {

constexpr std::chrono::minutes kBetweenBatches{1};

Expected<BatchSolution> solve_edges(const SpinConfig& config, const Orbit& orbit, PassEdges edges) {
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
  const auto made = made_before_.find(run_id);
  again_from_ = made == made_before_.end() ? std::nullopt : std::optional{made->second.again_from};
  reached_ = {};
  failed_ = false;
  edges_ = {};
  next_batch_.reset();
  last_batch_.reset();
}

ArchiveBatch PassRun::batch() const {
  ArchiveBatch batch;
  batch.run_id = summary_.run_id;
  batch.spacecraft_id = spacecraft_id_;
  return batch;
}

void PassRun::go_on(const std::string& first, std::map<std::string, MadeBefore> made) {
  made_before_ = std::move(made);
  begin(first);
}

std::vector<ArchiveBatch> PassRun::compute(const PassInput& input) {
  std::vector<ArchiveBatch> batches;
  if (input.run_id != summary_.run_id) {
    end_run(batches);
    begin(input.run_id);
  }
  Computed computed;
  computed.fill(batch());
  // What was made of the samples before one that fails is kept, however many came with it.
  compute_or_fail(computed.front().products, [&] { compute(input, computed); });
  for (ArchiveBatch& batch : computed) {
    if (!batch.products.empty() || batch.continuation) {
      batches.push_back(std::move(batch));
    }
  }
  return batches;
}

void PassRun::compute(const PassInput& input, Computed& computed) {
  const auto take = [&]<class Value>(const Arrived<Value>& arrived) {
    // Of the other kinds of telemetry it knows nothing.
    if constexpr (requires { pass_.push(arrived.value); }) {
      reached_ = arrived.value.t;
      keep(pass_.push(arrived.value), arrived.value.t, computed);
    }
  };
  in_order_of_arrival(input.values, input.silences, take, [&](std::int64_t /*place*/) {
    keep(pass_.fall_silent(), std::nullopt, computed);
  });
}

template <class Compute>
void PassRun::compute_or_fail(std::vector<Product>& products, const Compute& compute) {
  if (failed_) {
    return;
  }
  if (const auto what = what_is_thrown(compute)) {
    failed_ = true;
    spdlog::error(
        "{}: computing failed at {}: {}: run {} is DOUBTFUL, its samples are stored, and nothing "
        "more is computed of it",
        spacecraft_id_, format_utc(reached_), *what, summary_.run_id);
    products.emplace_back(RunFault{.t = reached_, .what = *what});
  }
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

/// By the time of telemetry, so that the same telemetry gives the same solutions.
void PassRun::note_time(TaiTime t) {
  if (plan_ == BatchPlan::WholePass || (next_batch_ && t < *next_batch_)) {
    return;
  }
  if (next_batch_) {
    edges_.keep_last(kLastRevolutions);
    const auto last = edges_.last();
    // Its last edge names a solution: one a minute, and one only.
    if (last && last != last_batch_ && !is_stored(*last)) {
      due_.push_back({.batch = batch(), .solve = [this, edges = edges_] { return solve(edges); }});
    }
    last_batch_ = last;
  }
  next_batch_ = t + kBetweenBatches;
}

/// And is not withdrawn.
bool PassRun::is_stored(TaiTime batch) const {
  const auto made = made_before_.find(summary_.run_id);
  return made != made_before_.end() && batch < made->second.again_from &&
         std::binary_search(made->second.batches.begin(), made->second.batches.end(), batch);
}

std::vector<BackgroundTask> PassRun::take_background_tasks() { return std::exchange(due_, {}); }

Expected<std::vector<Product>> PassRun::solve(const PassEdges& edges) const {
  Expected<std::vector<Product>> products;
  const auto what = what_is_thrown(
      [&] { products = solve_edges(config_, orbit_, edges).and_then(&products_of); });
  if (!what) {
    return products;
  }
  const TaiTime t = edges.last().value_or(TaiTime{});
  spdlog::error("{}: batch solution failed at {}: {}: its run is DOUBTFUL", spacecraft_id_,
                format_utc(t), *what);
  return std::vector<Product>{RunFault{.t = t, .what = *what}};
}

/// What was still held. Then the last batch solution is due, whatever became due before.
void PassRun::settle(std::vector<Product>& products) {
  const std::size_t due = due_.size();
  compute_or_fail(products, [&] {
    SpinOutput output = pass_.finish();
    withheld_.take_from(output);
    note(output);
    for (SpinProduct& product : output.products) {
      products.push_back(product_of(std::move(product)));
    }
  });
  due_.erase(due_.begin() + static_cast<std::ptrdiff_t>(due), due_.end());
  if (plan_ == BatchPlan::EveryMinute) {
    edges_.keep_last(kLastRevolutions);
  }
  if (edges_.forgot_some()) {
    spdlog::warn("{}: more edges than the batch solution can hold: it rests on the last {}",
                 spacecraft_id_, PassEdges::kMost);
  }
}

ArchiveBatch PassRun::finish() {
  ArchiveBatch last = batch();
  settle(last.products);
  if (!failed_) {
    if (auto products = solve(std::exchange(edges_, {}))) {
      summary_.count_batch(*products);
      std::move(products->begin(), products->end(), std::back_inserter(last.products));
    } else if (summary_.edges_accepted > 0 || !summary_.edges_rejected.empty()) {
      spdlog::warn("{}: no batch solution: {}", spacecraft_id_, products.error().message);
    }
  }
  last.finished_utc = utc_now();
  return last;
}

/// Where solutions of the run may be waiting to be solved it is finished behind them, so that a run
/// that is finished lacks none.
void PassRun::end_run(std::vector<ArchiveBatch>& batches) {
  if (plan_ == BatchPlan::WholePass) {
    batches.push_back(finish());
    finished_.push_back(std::move(summary_));
    return;
  }
  ArchiveBatch held = batch();
  settle(held.products);
  BackgroundTask last{.batch = batch(),
                      .solve = [this, failed = failed_, edges = std::exchange(edges_, {})] {
                        return failed ? std::vector<Product>{} : solve(edges);
                      }};
  last.batch.finished_utc = utc_now();
  last.summary = &finished_.emplace_back(std::move(summary_));
  batches.push_back(std::move(held));
  due_.push_back(std::move(last));
}

std::vector<RunSummary> PassRun::summaries() const {
  std::vector<RunSummary> summaries{finished_.begin(), finished_.end()};
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
