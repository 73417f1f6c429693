#include "services/simulation/monte_carlo.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <mutex>
#include <optional>
#include <system_error>
#include <thread>
#include <utility>

#include "pipelines/core/shown.h"
#include "services/base/progress_bar.h"
#include "services/mission/mission.h"
#include "services/mission/values.h"
#include "services/processor/processor.h"
#include "services/simulation/dispersions.h"
#include "services/simulation/pass_files.h"

namespace spindrift {
namespace {

SampleBatch batch_of(const std::string& spacecraft_id, const PlacedValues& telemetry) {
  SampleBatch batch;
  telemetry.for_each([&]<class Value>(const PlacedOfKind<Value>& of_kind) {
    for (const Placed<Value>& placed : of_kind) {
      batch.samples.of<Value>().push_back({.spacecraft = spacecraft_id,
                                           .origin = {.source = "simulate"},
                                           .value = placed.value,
                                           .place = placed.place});
    }
  });
  return batch;
}

/// Returns the summary that the command `process` would give of the files of a pass.
Expected<RunSummary> processed(const std::filesystem::path& folder, const SimulatedPass& pass) {
  return load_mission(folder / "mission.toml").and_then([&](const Mission& mission) {
    return Processor::make({mission}, {.mode = RunMode::Process, .telemetry = {folder.string()}})
        .map([&](Processor&& processor) {
          processor.begin();
          processor.take(batch_of(mission.spacecraft_id, pass.telemetry));
          processor.finish();
          return processor.summaries().front();
        });
  });
}

Expected<std::vector<Measure>> measured(const Scenario& scenario,
                                        const std::filesystem::path& folder) {
  return simulated_pass(scenario, Progress::Hidden).and_then([&](const SimulatedPass& pass) {
    return write_pass(folder, scenario, pass)
        .and_then([&](const auto& /*paths*/) { return processed(folder, pass); })
        .map([&](const RunSummary& summary) { return run_outcome(scenario, pass, summary); });
  });
}

std::int64_t seed_of(const TomlDocument& document, std::int64_t run) {
  return value_of<std::int64_t>(document.values, "pass.seed") + run;
}

Error error_of_run(const TomlDocument& document, std::int64_t run, const Error& error) {
  return {error.code,
          fmt::format("run {}, seed {}: {}", run, seed_of(document, run), error.message)};
}

/// Checks the draws of all runs before any is simulated.
Expected<void> check_draws(const TomlDocument& document, std::int64_t runs) {
  for (std::int64_t run = 0; run < runs; ++run) {
    if (const auto sound = dispersed(document, run).and_then(soundness); !sound) {
      return Unexpected{error_of_run(document, run, sound.error())};
    }
  }
  return {};
}

Expected<RunResult> result_of(const TomlDocument& document, const std::filesystem::path& out,
                              std::int64_t run) {
  return dispersed(document, run)
      .and_then([](TomlDocument&& own) { return scenario_of(std::move(own)); })
      .and_then([&](const Scenario& scenario) {
        return measured(scenario, out / fmt::format("{:04}", run));
      })
      .map([&](std::vector<Measure>&& measures) {
        return RunResult{
            .run = run, .seed = seed_of(document, run), .measures = std::move(measures)};
      })
      .map_error([&](const Error& error) { return error_of_run(document, run, error); });
}

/// Checks that `out` is empty, since files of other runs would be taken for those of these.
Expected<void> check_empty(const std::filesystem::path& out) {
  std::error_code failure;
  if (!std::filesystem::exists(out, failure) || std::filesystem::is_empty(out, failure)) {
    return {};
  }
  return Unexpected{
      {ErrorCode::InvalidConfiguration,
       fmt::format("{}: must be an empty folder, or not be there", shown(out.string()))}};
}

/// Simulates the runs one after the other on each thread, until all are done or one has failed.
class Runs {
 public:
  Runs(const TomlDocument& document, const MonteCarloPlan& plan)
      : document_{document},
        plan_{plan},
        results_(static_cast<std::size_t>(plan.runs)),
        progress_{"running", static_cast<std::uint64_t>(plan.runs)} {}

  void work() {
    for (std::int64_t run = next_++; run < plan_.runs && !failed_; run = next_++) {
      auto result = result_of(document_, plan_.out, run);
      if (!result) {
        failed_ = true;
      }
      results_.at(static_cast<std::size_t>(run)) = std::move(result);
      const std::lock_guard lock{mutex_};
      progress_.advance_to(++done_);
    }
  }

  /// Returns the results in order. Runs are begun in order, so all before a finished one exist.
  Expected<std::vector<RunResult>> results() && {
    std::vector<RunResult> all;
    for (auto& result : results_) {
      if (!*result) {
        return Unexpected{std::move(result->error())};
      }
      all.push_back(std::move(**result));
    }
    return all;
  }

 private:
  const TomlDocument& document_;
  const MonteCarloPlan& plan_;
  std::vector<std::optional<Expected<RunResult>>> results_;
  std::atomic<std::int64_t> next_ = 0;
  std::atomic<bool> failed_ = false;
  std::mutex mutex_;
  std::uint64_t done_ = 0;
  ProgressBar progress_;
};

}  // namespace

Expected<MonteCarloResult> monte_carlo(const MonteCarloPlan& plan) {
  const auto document = read_scenario(plan.scenario);
  if (!document) {
    return Unexpected{document.error()};
  }
  // Reports every problem of the file itself first, with line numbers.
  const auto scenario = scenario_of(*document);
  if (!scenario) {
    return Unexpected{scenario.error()};
  }
  if (auto empty = check_empty(plan.out); !empty) {
    return Unexpected{std::move(empty.error())};
  }
  if (auto drawn = check_draws(*document, plan.runs); !drawn) {
    return Unexpected{std::move(drawn.error())};
  }
  Runs runs{*document, plan};
  {
    std::vector<std::jthread> threads;
    for (int i = 1; i < plan.jobs; ++i) {
      threads.emplace_back([&runs] { runs.work(); });
    }
    runs.work();
  }
  return std::move(runs).results().map([&](std::vector<RunResult>&& results) {
    return MonteCarloResult{.spacecraft_id = scenario->spacecraft_id, .runs = std::move(results)};
  });
}

}  // namespace spindrift
