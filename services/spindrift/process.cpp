#include "services/spindrift/process.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <string>
#include <utility>

#include "services/archive/archive.h"
#include "services/mission/mission.h"
#include "services/processor/processor.h"
#include "services/spindrift/outcome.h"
#include "services/spindrift/pulse_input.h"
#include "services/spindrift/submit_all.h"
#include "services/spindrift/summary_text.h"

namespace spindrift {
namespace {

// Pulses a batch: large enough that a commit costs nothing, small enough to stay in the cache.
constexpr std::size_t kBatch = 4096;

std::string one_a_line(const std::vector<std::filesystem::path>& paths) {
  std::string lines;
  for (const std::filesystem::path& path : paths) {
    lines += (lines.empty() ? "" : "\n") + path.string();
  }
  return lines;
}

Expected<void> run(Processor& processor, PulseTelemetry telemetry, Archive& archive) {
  if (auto begun = submit_all(archive, processor.begin()); !begun) {
    return begun;
  }
  if (auto noted = submit_all(
          archive, processor.take({.pulses = {}, .rejected = std::move(telemetry.rejected)}));
      !noted) {
    return noted;
  }
  auto& samples = telemetry.samples;
  for (std::size_t from = 0; from < samples.size(); from += kBatch) {
    const std::size_t to = std::min(from + kBatch, samples.size());
    SampleBatch batch;
    batch.pulses.assign(
        std::make_move_iterator(samples.begin() + static_cast<std::ptrdiff_t>(from)),
        std::make_move_iterator(samples.begin() + static_cast<std::ptrdiff_t>(to)));
    if (auto stored = submit_all(archive, processor.take(std::move(batch))); !stored) {
      return stored;
    }
  }
  return submit_all(archive, processor.finish());
}

}  // namespace

Expected<void> process(const ProcessOptions& options) {
  const auto mission = load_mission(options.mission);
  if (!mission) {
    return Unexpected{mission.error()};
  }
  auto processor =
      Processor::make({*mission}, {.mode = "process", .telemetry = one_a_line(options.telemetry)});
  if (!processor) {
    return Unexpected{processor.error()};
  }
  auto telemetry = load_pulses(options.telemetry, mission->spacecraft_id);
  if (!telemetry) {
    return Unexpected{telemetry.error()};
  }
  if (!telemetry->rejected.empty()) {
    if (options.strict) {
      return Unexpected{{ErrorCode::InvalidConfiguration, bad_rows(telemetry->rejected)}};
    }
    spdlog::warn("{}", bad_rows(telemetry->rejected));
  }

  auto archive = Archive::open(options.db, {});
  if (!archive) {
    return Unexpected{archive.error()};
  }
  const auto done = run(*processor, std::move(*telemetry), **archive);
  // Whatever stopped the run: what was accepted is stored before the archive is let go.
  if (auto outcome = outcome_of(done, (*archive)->close()); !outcome) {
    return outcome;
  }
  fmt::print("{}", report(processor->summaries(), processor->other_spacecraft(), options.db,
                          options.json));
  return {};
}

}  // namespace spindrift
