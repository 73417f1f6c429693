#include "services/simulation/monte_carlo.h"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <atomic>
#include <initializer_list>
#include <mutex>
#include <optional>
#include <system_error>
#include <thread>
#include <utility>
#include <variant>

#include "pipelines/core/shown.h"
#include "pipelines/frames/celestial.h"
#include "pipelines/frames/rotation_vector.h"
#include "services/base/degrees.h"
#include "services/base/progress_bar.h"
#include "services/mission/mission.h"
#include "services/mission/values.h"
#include "services/processor/processor.h"
#include "services/processor/run_summary.h"
#include "services/simulation/dispersions.h"
#include "services/simulation/pass_files.h"
#include "services/simulation/scenario.h"
#include "services/simulation/simulated_pass.h"

namespace spindrift {
namespace {

using Eigen::Vector3d;

class Measures {
 public:
  void add(std::string name, std::optional<double> value) {
    all_.push_back({std::move(name), value});
  }

  /// @param error_rad Empty: there is no solution.
  template <class Vector, class Covariance>
  void add_error(const std::string& of, const std::optional<Vector>& error_rad,
                 const Covariance& covariance_rad2) {
    add(of + "_error_deg",
        error_rad ? std::optional{kDegPerRad * error_rad->norm()} : std::nullopt);
    add(of + "_normalised_square",
        error_rad ? std::optional{error_rad->dot(covariance_rad2.ldlt().solve(*error_rad))}
                  : std::nullopt);
  }

  std::vector<Measure> all() && { return std::move(all_); }

 private:
  std::vector<Measure> all_;
};

/// Returns the small rotation from the solution to the truth, body axes.
Vector3d attitude_error_rad(const Eigen::Quaterniond& found, const Eigen::Quaterniond& truth) {
  return rotation_vector_of(found.conjugate() * truth);
}

/// Returns the error in the tangent plane at the found axis: east, north.
Eigen::Vector2d axis_error_rad(const Vector3d& found_icrf, const Vector3d& truth_icrf) {
  const Eigen::Matrix<double, 3, 2> basis = tangent_basis(found_icrf);
  const Vector3d across = truth_icrf - found_icrf.dot(truth_icrf) * found_icrf;
  const double angle_rad = angle_between_rad(found_icrf, truth_icrf);
  return across.norm() > 0.0 ? Eigen::Vector2d{angle_rad * basis.transpose() * across.normalized()}
                             : Eigen::Vector2d::Zero().eval();
}

void add_axes(const SpinScenario& flight, const RunSummary& summary, Measures& measures) {
  for (const SpinEstimator estimator :
       {SpinEstimator::Mean, SpinEstimator::Sequential, SpinEstimator::Batch}) {
    const auto found = summary.estimates.find(estimator);
    std::optional<Eigen::Vector2d> error_rad;
    Eigen::Matrix2d covariance_rad2 = Eigen::Matrix2d::Identity();
    if (found != summary.estimates.end()) {
      error_rad = axis_error_rad(found->second.axis_icrf, flight.truth.motion.axis_icrf);
      covariance_rad2 = found->second.covariance_rad2;
    }
    measures.add_error(std::string{name_of(estimator)}, error_rad, covariance_rad2);
  }
}

void add_reconstruction(const SimulatedPass& pass, const RunSummary& summary,
                        ReconstructionMethod method, Measures& measures) {
  const auto& all = summary.reconstructions;
  const auto made = std::find_if(all.begin(), all.end(), [method](const auto& reconstruction) {
    return reconstruction->solution.method == method;
  });
  std::optional<Vector3d> error_rad;
  Eigen::Matrix3d covariance_rad2 = Eigen::Matrix3d::Identity();
  if (made != all.end()) {
    const ReconstructedAttitude& found = (*made)->solution.events.front().attitude;
    error_rad = attitude_error_rad(found.q_icrf_body, pass.motion->at(0.0).q_icrf_body);
    covariance_rad2 = found.covariance_rad2;
  }
  measures.add_error(fmt::format("{}_t1", name_of(method)), error_rad, covariance_rad2);
}

void add_attitude(const Scenario& scenario, const SimulatedPass& pass, const RunSummary& summary,
                  Measures& measures) {
  std::optional<Vector3d> error_rad;
  Eigen::Matrix3d covariance_rad2 = Eigen::Matrix3d::Identity();
  if (const auto& found = summary.attitude) {
    const double t_s = seconds_between(scenario.start, found->t);
    error_rad = attitude_error_rad(found->q_icrf_body, pass.motion->at(t_s).q_icrf_body);
    covariance_rad2 = found->covariance_rad2;
  }
  measures.add_error("attitude", error_rad, covariance_rad2);
}

void add_control(const SimulatedPass& pass, std::initializer_list<const char*> names,
                 Measures& measures) {
  for (const char* const name : names) {
    const auto& value = pass.truth[name];
    measures.add(name, value.is_number() ? std::optional{value.get<double>()} : std::nullopt);
  }
}

/// Returns the error of each estimator's axis at the end (spinner), of each method's attitude at T1
/// (separation), and of the filter's last attitude (every three-axis spacecraft), each with its
/// normalised square e' P^-1 e, whose mean is 2 for an axis and 3 for an attitude. For an
/// orientation and for a rescue the results of the control are added, as in truth.json.
/// @return The same names for every run of a scenario.
std::vector<Measure> run_outcome(const Scenario& scenario, const SimulatedPass& pass,
                                 const RunSummary& summary) {
  Measures measures;
  if (const auto* const spin = std::get_if<SpinScenario>(&scenario.flight)) {
    add_axes(*spin, summary, measures);
    return std::move(measures).all();
  }
  if (std::holds_alternative<SeparationScenario>(scenario.flight)) {
    add_reconstruction(pass, summary, ReconstructionMethod::Batch, measures);
    add_reconstruction(pass, summary, ReconstructionMethod::Sequential, measures);
  }
  if (std::holds_alternative<OrientationScenario>(scenario.flight)) {
    add_control(pass,
                {"pointing_s", "settled_s", "last_off_deg", "wheel_nms_most", "wheel_rpm_most"},
                measures);
  }
  if (std::holds_alternative<RescueScenario>(scenario.flight)) {
    add_control(pass, {"lost_s", "control_s", "reached_s", "filter_off_deg", "last_off_deg"},
                measures);
  }
  add_attitude(scenario, pass, summary, measures);
  return std::move(measures).all();
}

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
          processor.process(batch_of(mission.spacecraft_id, pass.telemetry));
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
