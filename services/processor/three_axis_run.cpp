#include "services/processor/three_axis_run.h"

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <memory>
#include <utility>
#include <variant>

#include "pipelines/three_axis/sample_kind.h"
#include "pipelines/time/utc.h"
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
  std::vector<Product> products = solved.products();
  if (!why.empty()) {
    products.emplace_back(
        told("one_reconstruction_only", {{"spacecraft", spacecraft_id}, {"why", why}},
             fmt::format("{}: no second {}: {}", spacecraft_id, kReconstruction, why)));
  }
  return products;
}

ThreeAxisPass fresh_pass(const Mission& mission) {
  const auto& config = std::get<ThreeAxisConfig>(mission.config);
  return {config, mission.orbit,
          config.magnetometer ? std::optional{igrf().value()} : std::nullopt};
}

}  // namespace

ThreeAxisRun::ThreeAxisRun(const Mission& mission, const std::string& run_id, SolvingPlan plan)
    : PassRun{mission, run_id, fresh_pass(mission), plan},
      config_{std::get<ThreeAxisConfig>(mission.config)},
      orbit_{mission.orbit},
      separation_{mission.separation} {
  begin(run_id);
}

void ThreeAxisRun::forget() {
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

std::vector<ArchiveBatch> ThreeAxisRun::compute(const PassInput& input) {
  std::vector<ArchiveBatch> batches = PassRun::compute(input);
  record(input);
  return batches;
}

/// Records samples as they arrive, even those that the pass still holds back.
void ThreeAxisRun::record(const PassInput& input) {
  if (!record_) {
    return;
  }
  in_order_of_arrival(
      input.values, input.silences, input.actions, [this](const auto& placed) { record(placed); },
      [this](BatchPlace /*silence*/) {
        if (record_->fall_silent(kBetweenSilences) && plan_ == SolvingPlan::Meanwhile) {
          hand_out_solutions();
        }
      });
}

template <class Value>
void ThreeAxisRun::record(const Placed<Value>& placed) {
  if constexpr (requires { record_->push(placed.value); }) {
    if (excluded_.hold(placed.value.t, kind_of(placed.value))) {
      return;
    }
    const bool is_due = record_->push(placed.value);
    const bool is_corrected = record_->take_correction(kBetweenSilences);
    has_forgotten_ = has_forgotten_ || is_corrected;
    if ((is_due || is_corrected) && plan_ == SolvingPlan::Meanwhile) {
      hand_out_solutions();
    }
  }
}

void ThreeAxisRun::record(const Placed<OperatorAction>& placed) {
  const OperatorAction& action = placed.value;
  if (const auto* const does = std::get_if<AttitudeAction>(&action.does)) {
    std::visit([&](const auto& what) { excluded_.apply(action.t.value(), what); }, *does);
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
std::optional<BackgroundTask> ThreeAxisRun::last_solution() const {
  if (expects_solution()) {
    return solving(std::make_shared<const ReconstructionRequest>(record_->request()), std::nullopt);
  }
  if (record_) {
    spdlog::info("{}: no {}: no sample to use within {} after T1, {}", computing_.spacecraft_id(),
                 kReconstruction, SeparationRecord::kLongest,
                 format_utc(separation_->times.separation));
  }
  return std::nullopt;
}

void ThreeAxisRun::note(const ThreeAxisOutput& output) {
  for (const ThreeAxisProduct& product : output.products) {
    summary_.count(product);
  }
}

}  // namespace spindrift
