#include "services/spindrift/process.h"

#include <fmt/format.h>

#include <csignal>
#include <cstdint>
#include <span>
#include <string>
#include <utility>

#include "services/alerts/alert_desk.h"
#include "services/archive/archive.h"
#include "services/archive/stored_faults.h"
#include "services/archive/submit_all.h"
#include "services/comparison/ground_model.h"
#include "services/mission/mission.h"
#include "services/processor/processor.h"
#include "services/progress/progress_bar.h"
#include "services/spindrift/comparison_notice.h"
#include "services/spindrift/orbit_notice.h"
#include "services/spindrift/outcome.h"
#include "services/spindrift/summary_text.h"
#include "services/spindrift/telemetry_input.h"
#include "services/standard_error/warning.h"
#include "services/words/counted.h"

namespace spindrift {
namespace {

std::vector<std::string> texts_of(const std::vector<std::filesystem::path>& paths) {
  return {paths.begin(), paths.end()};
}

// NOLINTNEXTLINE(cppcoreguidelines-avoid-non-const-global-variables): a signal handler has no other
volatile std::sig_atomic_t interrupted = 0;

/// The second signal does what it does without a handler.
void stop_at_first_signal() {
  struct sigaction action {};
  action.sa_handler = [](int /*signal*/) { interrupted = 1; };
  action.sa_flags = static_cast<int>(SA_RESETHAND);
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
}

/// Until all is computed, or a signal. @return whether all is.
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
    if (auto stored = submit_all(archive, processor.take(std::move(*batch))); !stored) {
      return Unexpected{stored.error()};
    }
    progress.advance_to(telemetry.bytes_given());
  }
  return false;
}

/// Whoever has edges is told by the pass why they give no axis.
void warn_where_no_edge_came(const Processor& processor, std::uint64_t bad_rows) {
  std::int64_t others = 0;
  for (const auto& [spacecraft, samples] : processor.other_spacecraft()) {
    others += samples;
  }
  for (const RunSummary& summary : processor.summaries()) {
    if (summary.kind == SpacecraftKind::Spin && summary.edges_received == 0) {
      warn("no_edge",
           {{"spacecraft", summary.spacecraft_id},
            {"bad_rows", bad_rows},
            {"samples_of_others", others}},
           fmt::format(
               "{}: no edge of it in the telemetry, and no axis: {}, {} of other spacecraft",
               summary.spacecraft_id, counted(bad_rows, "bad rows"), counted(others, "samples")));
    }
  }
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
  telemetry->find_preferred(*mission);
  auto processor = Processor::make(
      {*mission}, {.mode = RunMode::Process, .telemetry = texts_of(options.telemetry)});
  if (!processor) {
    return Unexpected{processor.error()};
  }
  const auto models = load_ground_models({&*mission, 1});
  if (!models) {
    return Unexpected{models.error()};
  }
  AlertDesk desk{{*mission}, RunMode::Process, *models};
  auto archive =
      Archive::open(options.db, {.on_submit = [&](ArchiveBatch& batch) { desk.see(batch); },
                                 .on_committed =
                                     [&](std::span<const ArchiveBatch> stored) {
                                       warn_of_disagreements(options.db, stored);
                                     }});
  if (!archive) {
    return Unexpected{archive.error()};
  }
  stop_at_first_signal();
  const auto done = processor->arrive_after(options.db).and_then([&] {
    return run(*processor, *telemetry, **archive);
  });
  // Whatever stopped the run: what was accepted is stored before the archive is let go.
  if (auto outcome = outcome_of(done.map([](bool) {}), (*archive)->close()); !outcome) {
    return Unexpected{outcome.error()};
  }
  if (telemetry->bad_rows().count > 0) {
    warn("bad_rows", {{"rows", telemetry->bad_rows().count}}, telemetry->bad_rows().text());
  }
  warn_where_no_edge_came(*processor, telemetry->bad_rows().count);
  return report(*processor, options.db, options.json).and_then([&](const std::string& text) {
    fmt::print("{}", text);
    return computed_without_fault(*processor, options.db).map([&](bool sound) {
      return *done && sound;
    });
  });
}

}  // namespace spindrift
