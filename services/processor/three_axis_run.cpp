#include "services/processor/three_axis_run.h"

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <iterator>
#include <memory>
#include <utility>
#include <variant>

#include "pipelines/three_axis/sample_kind.h"
#include "pipelines/time/utc.h"
#include "services/base/wall_clock.h"
#include "services/mission/igrf.h"
#include "services/processor/separation_solving.h"
#include "services/processor/told.h"

namespace spindrift {
namespace {

constexpr std::string_view kReconstruction = "reconstruction of the separation";

/// Returns the solutions as products, with a notice when only one method gave a solution.
/// @return Unobservable when no method gave one.
Expected<std::vector<Product>> products_of(const std::string& spacecraft_id,
                                           SolvedSeparation solved) {
  const std::string why = fmt::format("{}", fmt::join(solved.failures, "; "));
  if (solved.methods.empty()) {
    return Unexpected{{ErrorCode::Unobservable, why}};
  }
  std::vector<Product> products{solved.methods.begin(), solved.methods.end()};
  if (!why.empty()) {
    products.emplace_back(
        told("one_reconstruction_only", {{"spacecraft", spacecraft_id}, {"why", why}},
             fmt::format("{}: no second {}: {}", spacecraft_id, kReconstruction, why)));
  }
  return products;
}

}  // namespace

ThreeAxisPass ThreeAxisRun::new_pass() const { return {config_, orbit_, field_}; }

ThreeAxisRun::ThreeAxisRun(const Mission& mission, const std::string& run_id, SolvingPlan plan)
    : config_{std::get<ThreeAxisConfig>(mission.config)},
      orbit_{mission.orbit},
      field_{config_.magnetometer ? std::optional{igrf().value()} : std::nullopt},
      separation_{mission.separation},
      computing_{mission.spacecraft_id, run_id, new_pass(), mission.stores_residuals},
      plan_{plan} {
  begin(run_id);
}

void ThreeAxisRun::begin(const std::string& run_id) {
  computing_.begin(run_id, new_pass());
  summary_ = {};
  summary_.run_id = run_id;
  summary_.spacecraft_id = computing_.spacecraft_id();
  summary_.kind = SpacecraftKind::ThreeAxis;
  excluded_ = {};
  has_forgotten_ = false;
  if (separation_) {
    record_.emplace(ReconstructionRequest{.sensors = config_,
                                          .times = separation_->times,
                                          .gyro = {},
                                          .sun_directions = {},
                                          .star_fixes = {},
                                          .orbit = orbit_,
                                          .disturbance_rad_s2 = separation_->disturbance_rad_s2,
                                          .node_at_every_gyro_sample = true});
  }
}

void ThreeAxisRun::go_on(const std::string& first, AllMadeBefore made) {
  computing_.go_on(std::move(made));
  begin(first);
}

std::vector<ArchiveBatch> ThreeAxisRun::compute(const PassInput& input) {
  std::vector<ArchiveBatch> batches;
  if (input.run_id != computing_.run_id()) {
    end_run(batches);
    begin(input.run_id);
  }
  auto computed =
      computing_.compute(input, [this](const ThreeAxisOutput& output) { note(output); });
  std::move(computed.begin(), computed.end(), std::back_inserter(batches));
  record(input);
  return batches;
}

/// Records samples as they arrive, even those that the pass still holds back.
void ThreeAxisRun::record(const PassInput& input) {
  if (!record_) {
    return;
  }
  in_order_of_arrival(
      input.values, input.silences, input.actions, [this](const auto& arrived) { record(arrived); },
      [this](std::int64_t /*silence*/) {
        if (record_->fall_silent(kBetweenSilences) && plan_ == SolvingPlan::Meanwhile) {
          hand_out_solutions();
        }
      });
}

template <class Value>
void ThreeAxisRun::record(const Arrived<Value>& arrived) {
  if constexpr (requires { record_->push(arrived.value); }) {
    if (excluded_.hold(arrived.value.t, kind_of(arrived.value))) {
      return;
    }
    const bool is_due = record_->push(arrived.value);
    const bool is_corrected = record_->take_correction(kBetweenSilences);
    has_forgotten_ = has_forgotten_ || is_corrected;
    if ((is_due || is_corrected) && plan_ == SolvingPlan::Meanwhile) {
      hand_out_solutions();
    }
  }
}

void ThreeAxisRun::record(const OperatorAction& action) {
  if (const auto* const does = std::get_if<AttitudeAction>(&action.does)) {
    std::visit([&](const auto& what) { excluded_.add(action.t.value(), what); }, *does);
    if (record_->forget(excluded_)) {
      has_forgotten_ = true;
      if (plan_ == SolvingPlan::Meanwhile) {
        hand_out_solutions();
      }
    }
  }
}

void ThreeAxisRun::hand_out_solutions() {
  const auto request = std::make_shared<const ReconstructionRequest>(record_->request());
  for (const auto method : {ReconstructionMethod::Batch, ReconstructionMethod::Sequential}) {
    if (!is_stored(method)) {
      due_.push_back(solving(request, method));
    }
  }
}

/// Returns whether a solution of at least as many samples is stored. After samples were dropped a
/// stored solution may rest on them, so it does not count.
bool ThreeAxisRun::is_stored(ReconstructionMethod method) const {
  const MadeBefore* const made = computing_.made_before();
  if (made == nullptr || has_forgotten_) {
    return false;
  }
  const auto stored = made->reconstructed.find(name_of(method));
  return stored != made->reconstructed.end() && stored->second >= sample_count(record_->request());
}

BackgroundTask ThreeAxisRun::solving(std::shared_ptr<const ReconstructionRequest> request,
                                     std::optional<ReconstructionMethod> method) const {
  const TaiTime separation = request->times.separation;
  return {.batch = computing_.batch(),
          .solve =
              [=, launcher = separation_->launcher, spacecraft_id = computing_.spacecraft_id()] {
                return solved_or_fault(spacecraft_id, kReconstruction, separation, [&] {
                  return products_of(spacecraft_id, solve_separation(*request, launcher, method));
                });
              },
          .what = kReconstruction,
          .is_awaited = true};
}

/// Returns the solution of all samples that have arrived, by both methods.
BackgroundTask ThreeAxisRun::solving_at_end() const {
  return solving(std::make_shared<const ReconstructionRequest>(record_->request()), std::nullopt);
}

std::vector<BackgroundTask> ThreeAxisRun::take_background_tasks() {
  return std::exchange(due_, {});
}

bool ThreeAxisRun::has_separation() const {
  return record_ && sample_count(record_->request()) > 0;
}

ArchiveBatch ThreeAxisRun::finish() {
  ArchiveBatch last = computing_.batch();
  computing_.finish(last.products, [this](const ThreeAxisOutput& output) { note(output); });
  if (has_separation()) {
    if (auto products = solving_at_end().solve()) {
      summary_.count_solution(*products);
      std::move(products->begin(), products->end(), std::back_inserter(last.products));
    } else {
      last.products.emplace_back(
          told("no_reconstruction",
               {{"spacecraft", computing_.spacecraft_id()}, {"why", products.error().message}},
               fmt::format("{}: no {}: {}", computing_.spacecraft_id(), kReconstruction,
                           products.error().message)));
    }
  } else if (record_) {
    spdlog::info("{}: no {}: no sample to use within {} after T1, {}", computing_.spacecraft_id(),
                 kReconstruction, SeparationRecord::kLongest,
                 format_utc(separation_->times.separation));
  }
  last.finished_utc = utc_now();
  return last;
}

/// Finishes the run behind its waiting solutions, as SpinRun does.
void ThreeAxisRun::end_run(std::vector<ArchiveBatch>& batches) {
  if (plan_ == SolvingPlan::AtTheEnd || !has_separation()) {
    batches.push_back(finish());
    finished_.push_back(summary());
    return;
  }
  ArchiveBatch held = computing_.batch();
  computing_.finish(held.products, [this](const ThreeAxisOutput& output) { note(output); });
  batches.push_back(std::move(held));
  BackgroundTask last = solving_at_end();
  last.batch.finished_utc = utc_now();
  last.summary = &finished_.emplace_back(summary());
  due_.push_back(std::move(last));
}

std::vector<RunSummary> ThreeAxisRun::summaries() const {
  std::vector<RunSummary> summaries{finished_.begin(), finished_.end()};
  summaries.push_back(summary());
  return summaries;
}

RunSummary ThreeAxisRun::summary() const {
  RunSummary summary = summary_;
  summary.sensors = computing_.pass().sensors();
  return summary;
}

void ThreeAxisRun::note(const ThreeAxisOutput& output) {
  for (const ThreeAxisProduct& product : output.products) {
    summary_.count(product);
  }
}

}  // namespace spindrift
