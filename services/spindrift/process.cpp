#include "services/spindrift/process.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <cstdint>
#include <span>
#include <string>
#include <utility>

#include "services/archive/archive.h"
#include "services/mission/mission.h"
#include "services/processor/processor.h"
#include "services/progress/progress_bar.h"
#include "services/spindrift/comparison_notice.h"
#include "services/spindrift/orbit_notice.h"
#include "services/spindrift/outcome.h"
#include "services/spindrift/submit_all.h"
#include "services/spindrift/summary_text.h"
#include "services/spindrift/telemetry_input.h"

namespace spindrift {
namespace {

std::vector<std::string> texts_of(const std::vector<std::filesystem::path>& paths) {
  return {paths.begin(), paths.end()};
}

Expected<void> run(Processor& processor, TelemetryInput& telemetry, Archive& archive) {
  if (auto begun = submit_all(archive, processor.begin()); !begun) {
    return begun;
  }
  ProgressBar progress{"processing", telemetry.bytes_total()};
  while (true) {
    auto batch = telemetry.next();
    if (!batch) {
      return Unexpected{std::move(batch.error())};
    }
    if (is_empty(*batch)) {
      return submit_all(archive, processor.finish());
    }
    if (auto stored = submit_all(archive, processor.take(std::move(*batch))); !stored) {
      return stored;
    }
    progress.advance_to(telemetry.bytes_given());
  }
}

/// Whoever has edges is told by the pass why they give no axis.
void warn_where_no_edge_came(const Processor& processor, std::uint64_t bad_rows) {
  std::int64_t others = 0;
  for (const auto& [spacecraft, samples] : processor.other_spacecraft()) {
    others += samples;
  }
  for (const RunSummary& summary : processor.summaries()) {
    if (summary.kind == SpacecraftKind::Spin && summary.edges_received == 0) {
      spdlog::warn(
          "{}: no edge of it in the telemetry, and no axis: {} bad rows, {} samples of other "
          "spacecraft",
          summary.spacecraft_id, bad_rows, others);
    }
  }
}

}  // namespace

Expected<void> process(const ProcessOptions& options) {
  const auto mission = load_mission(options.mission);
  if (!mission) {
    return Unexpected{mission.error()};
  }
  warn_of_orbit(options.mission, *mission);
  auto processor =
      Processor::make({*mission}, {.mode = "process", .telemetry = texts_of(options.telemetry)});
  if (!processor) {
    return Unexpected{processor.error()};
  }
  auto telemetry = TelemetryInput::open(options.telemetry, mission->spacecraft_id, options.strict);
  if (!telemetry) {
    return Unexpected{telemetry.error()};
  }
  auto archive =
      Archive::open(options.db, {.on_committed = [&](std::span<const ArchiveBatch> stored) {
                      warn_of_disagreements(options.db, stored);
                    }});
  if (!archive) {
    return Unexpected{archive.error()};
  }
  const auto done = run(*processor, *telemetry, **archive);
  // Whatever stopped the run: what was accepted is stored before the archive is let go.
  if (auto outcome = outcome_of(done, (*archive)->close()); !outcome) {
    return outcome;
  }
  if (telemetry->bad_rows().count > 0) {
    spdlog::warn("{}", telemetry->bad_rows().text());
  }
  warn_where_no_edge_came(*processor, telemetry->bad_rows().count);
  return report(*processor, options.db, options.json).map([](const std::string& text) {
    fmt::print("{}", text);
  });
}

}  // namespace spindrift
