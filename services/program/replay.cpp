#include <fmt/format.h>

#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>
#include <vector>

#include "services/base/counted.h"
#include "services/base/json_line.h"
#include "services/base/progress_bar.h"
#include "services/base/warning.h"
#include "services/mission/mission.h"
#include "services/program/commands.h"
#include "services/program/telemetry_input.h"
#include "services/program/telemetry_output.h"
#include "services/telemetry/stray_rows.h"

namespace spindrift {
namespace {

/// Returns when each sample is due; a sample with a stray time is due with the one before it.
std::vector<TaiTime> due_times(const SampleBatch& batch) {
  std::vector<TaiTime> due;
  in_order_of_arrival(batch.samples, [&](const auto& sample) { due.push_back(sample.value.t); });
  for (const auto& [row, after] : find_stray_rows(due)) {
    due[row] = due[after];
  }
  return due;
}

/// @param after_each Called after every published sample.
template <class AfterEach>
Expected<void> publish(const SampleBatch& batch, TelemetryOutput& output, AfterEach after_each) {
  const std::vector<TaiTime> due = due_times(batch);
  auto next = due.begin();
  Expected<void> sent;
  in_order_of_arrival(batch.samples, [&](const auto& sample) {
    if (sent && (sent = output.publish(sample.spacecraft, sample.value, *next++))) {
      after_each();
    }
  });
  return sent;
}

Expected<void> publish(TelemetryInput& telemetry, TelemetryOutput& output) {
  ProgressBar progress{"replaying", telemetry.bytes_total()};
  while (true) {
    const std::uint64_t bytes_before = telemetry.bytes_given();
    const auto batch = telemetry.next();
    if (!batch) {
      return Unexpected{batch.error()};
    }
    if (is_empty(*batch)) {
      return {};
    }
    // A batch may last a minute in real time: progress is counted per sample.
    const std::uint64_t bytes = telemetry.bytes_given() - bytes_before;
    const auto after_each = [&, done = std::uint64_t{0},
                             count = count_of(batch->samples)]() mutable {
      progress.advance_to(bytes_before + bytes * ++done / count);
    };
    if (auto sent = publish(*batch, output, after_each); !sent) {
      return sent;
    }
  }
}

}  // namespace

Expected<void> replay(const ReplayOptions& options) {
  const auto mission = load_mission(options.mission);
  if (!mission) {
    return Unexpected{mission.error()};
  }
  auto telemetry = TelemetryInput::open(options.telemetry, mission->spacecraft_id, false);
  if (!telemetry) {
    return Unexpected{telemetry.error()};
  }
  const auto sent =
      send_telemetry({.bus = {.domain = options.domain, .partition = options.partition},
                      .source = "replay",
                      .speed = options.speed,
                      .rehearsal = options.now ? std::optional{Rehearsal::OfThePast} : std::nullopt,
                      .kinds = telemetry->kinds()},
                     [&](TelemetryOutput& output) { return publish(*telemetry, output); });
  const BadRows& bad = telemetry->bad_rows();
  if (bad.count > 0) {
    warn("bad_rows", {{"rows", bad.count}}, bad.text());
  }
  if (!sent) {
    return Unexpected{sent.error()};
  }
  if (auto read = telemetry->check_read(); !read) {
    return read;
  }
  if (options.json) {
    nlohmann::json object = sent->json();
    object["input_rejected"] = bad.count;
    fmt::print("{}", json_line(with_warnings(object)));
  } else {
    fmt::print("{} published, {} left out\n", sent->text(), counted(bad.count, "bad rows"));
  }
  return {};
}

}  // namespace spindrift
