#include <fmt/format.h>

#include <algorithm>
#include <csignal>
#include <cstdint>
#include <iterator>
#include <string>
#include <utility>

#include "pipelines/time/utc.h"
#include "services/alerts/alert_desk.h"
#include "services/archive/archive.h"
#include "services/archive/last_run.h"
#include "services/archive/submit_all.h"
#include "services/archive/verdict.h"
#include "services/base/counted.h"
#include "services/base/progress_bar.h"
#include "services/mission/mission.h"
#include "services/processor/processor.h"
#include "services/processor/told.h"
#include "services/program/commands.h"
#include "services/program/comparison_notice.h"
#include "services/program/orbit_notice.h"
#include "services/program/outcome.h"
#include "services/program/summary_text.h"
#include "services/program/telemetry_input.h"
#include "services/simulation/ground_model.h"

namespace spindrift {
namespace {

// NOLINTNEXTLINE(cppcoreguidelines-avoid-non-const-global-variables): a signal handler has no other
volatile std::sig_atomic_t interrupted = 0;

/// The second signal gets the default action, which ends the program.
void stop_at_first_signal() {
  struct sigaction action {};
  action.sa_handler = [](int /*signal*/) { interrupted = 1; };
  action.sa_flags = static_cast<int>(SA_RESETHAND);
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
}

/// Processes until the input ends or a signal arrives. @return Whether the input ended.
Expected<bool> run(Processor& processor, TelemetryInput& telemetry, Archive& archive) {
  if (auto begun = submit_all(archive, processor.begin()); !begun) {
    return Unexpected{begun.error()};
  }
  ProgressBar progress{"processing", telemetry.bytes_total()};
  while (interrupted == 0) {
    auto batch = telemetry.next();
    if (!batch) {
      return Unexpected{std::move(batch.error())};
    }
    if (is_empty(*batch)) {
      return submit_all(archive, processor.finish()).map([] { return true; });
    }
    if (auto stored = submit_all(archive, processor.process(std::move(*batch))); !stored) {
      return Unexpected{stored.error()};
    }
    progress.advance_to(telemetry.bytes_given());
  }
  return false;
}

/// Returns notices about spinners without edges (where edges exist, the pass itself says why they
/// give no axis) and about estimators that disagree.
/// @param of_files Notices about all files. When passes follow each other in one recording, the bad
///        rows cannot be attributed and go with the first pass.
std::vector<ArchiveBatch> told_at_the_end(const Processor& processor,
                                          std::vector<RunNotice> of_files, const BadRows& bad_rows,
                                          const std::filesystem::path& db) {
  std::int64_t others = 0;
  for (const auto& [spacecraft, samples] : processor.other_spacecraft()) {
    others += samples;
  }
  std::vector<ArchiveBatch> batches;
  for (const RunSummary& summary : processor.summaries()) {
    ArchiveBatch batch;
    batch.run_id = summary.run_id;
    batch.spacecraft_id = summary.spacecraft_id;
    std::move(of_files.begin(), of_files.end(), std::back_inserter(batch.products));
    of_files.clear();
    if (summary.kind == SpacecraftKind::Spin && summary.edges_received == 0) {
      batch.products.emplace_back(told(
          "no_edge",
          {{"spacecraft", summary.spacecraft_id},
           {"bad_rows", bad_rows.count},
           {"samples_of_others", others}},
          fmt::format("{}: no edge of it in the telemetry, and no axis: {}, {} of other spacecraft",
                      summary.spacecraft_id, counted(bad_rows.count, "bad rows"),
                      counted(others, "samples"))));
    }
    for (RunNotice& notice : told_disagreements(db, summary.spacecraft_id, summary.run_id)) {
      batch.products.emplace_back(std::move(notice));
    }
    if (!batch.products.empty()) {
      batches.push_back(std::move(batch));
    }
  }
  return batches;
}

/// Flushes what `run` computed, then logs and stores the notices that are known only then.
Expected<void> tell_at_the_end(Archive& archive, const Processor& processor,
                               const TelemetryInput& telemetry, std::vector<RunNotice> of_files,
                               const std::filesystem::path& db) {
  if (auto bad_rows = told_bad_rows(telemetry.bad_rows())) {
    of_files.push_back(*std::move(bad_rows));
  }
  return archive.flush().and_then([&] {
    return submit_all(archive,
                      told_at_the_end(processor, std::move(of_files), telemetry.bad_rows(), db));
  });
}

/// @return InvalidConfiguration if no run has an answer and the orbit ends before or begins after
///         the last one's telemetry.
Expected<void> check_orbit(const Mission& mission, const Processor& processor,
                           const std::filesystem::path& db) {
  const OrbitEphemeris* const orbit = mission.orbit ? mission.orbit->ephemeris() : nullptr;
  const auto last = find_last_run(db, mission.spacecraft_id, RunMode::Process);
  const auto summaries = processor.summaries();
  const bool has_answer = std::any_of(summaries.begin(), summaries.end(), [](const auto& run) {
    return !run.estimates.empty() || run.attitude.has_value();
  });
  if (orbit == nullptr || has_answer || !last || !*last || !(*last)->first_sample ||
      (orbit->usable_from() <= *(*last)->last_sample &&
       orbit->usable_to() >= *(*last)->first_sample)) {
    return {};
  }
  return refused(fmt::format(
      "{}: the orbit covers {} to {}, and the telemetry {} to {}: without the orbit of these dates "
      "there is no answer",
      mission.spacecraft_id, format_utc(orbit->usable_from(), 0), format_utc(orbit->usable_to(), 0),
      format_utc(*(*last)->first_sample, 0), format_utc(*(*last)->last_sample, 0)));
}

Expected<bool> computed_without_fault(const Processor& processor, const std::filesystem::path& db) {
  for (const RunSummary& summary : processor.summaries()) {
    const auto faults = find_faults(db, summary.run_id);
    if (!faults || !faults->empty()) {
      return faults.map([](const auto& /*faults*/) { return false; });
    }
  }
  return true;
}

}  // namespace

Expected<bool> process(const ProcessOptions& options) {
  auto mission = load_mission(options.mission);
  if (!mission) {
    return Unexpected{mission.error()};
  }
  warn_of_orbit(options.mission, *mission);
  auto telemetry = TelemetryInput::open(options.telemetry, mission->spacecraft_id, options.strict);
  if (!telemetry) {
    return Unexpected{telemetry.error()};
  }
  std::vector<RunNotice> of_files;
  if (auto notice = telemetry->find_preferred(*mission)) {
    of_files.push_back(*std::move(notice));
  }
  auto sha256 = telemetry->sha256();
  if (!sha256) {
    return Unexpected{sha256.error()};
  }
  auto processor = Processor::make({*mission}, {.mode = RunMode::Process,
                                                .telemetry = absolute_texts(options.telemetry),
                                                .sha256 = *std::move(sha256),
                                                .label = options.label});
  if (!processor) {
    return Unexpected{processor.error()};
  }
  const auto models = load_ground_models({&*mission, 1});
  if (!models) {
    return Unexpected{models.error()};
  }
  AlertDesk desk{{*mission}, RunMode::Process, *models};
  auto archive =
      Archive::open(options.db, {.on_submit = [&](ArchiveBatch& batch) { desk.evaluate(batch); }});
  if (!archive) {
    return Unexpected{archive.error()};
  }
  stop_at_first_signal();
  const auto done = processor->arrive_after(options.db)
                        .and_then([&] { return run(*processor, *telemetry, **archive); })
                        .and_then([&](bool all) {
                          return tell_at_the_end(**archive, *processor, *telemetry,
                                                 std::move(of_files), options.db)
                              .map([&] { return all; });
                        });
  // Accepted batches are stored before the archive is closed, whatever stopped the run.
  if (auto outcome = outcome_of(done.map([](bool) {}), (*archive)->close()); !outcome) {
    return Unexpected{outcome.error()};
  }
  return report(*processor, options.db, options.json)
      .and_then([&](const std::string& text) {
        fmt::print("{}", text);
        return telemetry->check_read();
      })
      .and_then([&] { return check_orbit(*mission, *processor, options.db); })
      .and_then([&] { return computed_without_fault(*processor, options.db); })
      .map([&](bool sound) { return *done && sound; });
}

}  // namespace spindrift
