#include "services/spindrift/reconstruct.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <nlohmann/json.hpp>
#include <string>
#include <utility>

#include "pipelines/core/shown.h"
#include "services/archive/archive.h"
#include "services/archive/stored_separation.h"
#include "services/clock/wall_clock.h"
#include "services/mission/mission.h"
#include "services/processor/processor.h"
#include "services/processor/separation_solving.h"
#include "services/scenario/output_file.h"
#include "services/separation/separation_json.h"
#include "services/separation/separation_plot.h"
#include "services/separation/separation_text.h"
#include "services/spindrift/orbit_notice.h"
#include "services/spindrift/outcome.h"
#include "services/spindrift/submit_all.h"
#include "services/spindrift/telemetry_input.h"
#include "services/words/json_line.h"

namespace spindrift {
namespace {

Unexpected refused(std::string message) {
  return Unexpected{{ErrorCode::InvalidConfiguration, std::move(message)}};
}

/// That of the newest run in the archive. Its orbit file lies beside the archive or nowhere.
Expected<Mission> stored_mission(const std::filesystem::path& db) {
  const auto stored = find_stored_mission(db);
  if (!stored) {
    return Unexpected{stored.error()};
  }
  const std::string what =
      fmt::format("the mission of run {} in {}", stored->run_id, shown(db.string()));
  auto mission = mission_of(db, stored->config_toml);
  if (!mission) {
    return refused(fmt::format("{}: give --mission: {}", what, mission.error().message));
  }
  if (mission->orbit_sha256 != stored->orbit_sha256) {
    return refused(fmt::format(
        "{}: the orbit file beside the archive is not that of the run: give --mission", what));
  }
  return mission;
}

Expected<Mission> mission_for(const ReconstructOptions& options) {
  auto mission = options.mission ? load_mission(*options.mission) : stored_mission(options.db);
  const std::string from = shown(options.mission.value_or(options.db).string());
  if (mission && mission->kind() != SpacecraftKind::ThreeAxis) {
    return refused(fmt::format(
        R"({}: spacecraft.kind = "spin": must be "three_axis" for this command)", from));
  }
  if (mission && !mission->separation) {
    return refused(fmt::format(
        "{}: [reconstruction]: missing: t1_tai_ns, when the spacecraft separated, is needed",
        from));
  }
  return mission;
}

/// What is reconstructed from, and what of it is not in the archive yet.
struct Recorded {
  SeparationSamples samples;
  std::vector<SampleBatch> to_store;
  BadRows bad_rows;
};

template <class Value>
void append(const SampleBatch& batch, const std::string& spacecraft_id,
            std::vector<Value>& values) {
  for (const TelemetrySample<Value>& sample : batch.samples.of<Value>()) {
    if (sample.spacecraft == spacecraft_id) {
      values.push_back(sample.value);
    }
  }
}

Expected<Recorded> recorded_in_files(const std::vector<std::filesystem::path>& paths,
                                     const std::string& spacecraft_id) {
  auto input = TelemetryInput::open(paths, spacecraft_id, false);
  if (!input) {
    return Unexpected{std::move(input.error())};
  }
  Recorded recorded;
  while (true) {
    auto batch = input->next();
    if (!batch) {
      return Unexpected{std::move(batch.error())};
    }
    if (is_empty(*batch)) {
      recorded.bad_rows = input->bad_rows();
      return recorded;
    }
    append(*batch, spacecraft_id, recorded.samples.gyro);
    append(*batch, spacecraft_id, recorded.samples.sun);
    append(*batch, spacecraft_id, recorded.samples.stars);
    append(*batch, spacecraft_id, recorded.samples.orbit_states);
    recorded.to_store.push_back(std::move(*batch));
  }
}

Expected<Recorded> recorded(const ReconstructOptions& options, const Mission& mission) {
  if (!options.telemetry.empty()) {
    return recorded_in_files(options.telemetry, mission.spacecraft_id);
  }
  return find_separation_samples(options.db, mission.spacecraft_id,
                                 mission.separation->times.separation)
      .map([](SeparationSamples&& samples) {
        return Recorded{.samples = std::move(samples), .to_store = {}, .bad_rows = {}};
      });
}

/// @return InvalidConfiguration where no method gives an answer: the samples do not allow one.
Expected<SolvedSeparation> solved(const ReconstructOptions& options, const Mission& mission,
                                  SeparationSamples samples) {
  const ReconstructionRequest request{.sensors = std::get<ThreeAxisConfig>(mission.config),
                                      .times = mission.separation->times,
                                      .gyro = std::move(samples.gyro),
                                      .sun_directions = std::move(samples.sun),
                                      .star_fixes = std::move(samples.stars),
                                      .orbit = mission.orbit,
                                      .orbit_states = std::move(samples.orbit_states),
                                      .node_at_every_gyro_sample = true};
  auto solved = solve_separation(request, mission.separation->launcher, options.method);
  if (solved.methods.empty()) {
    return refused(fmt::format("{}: {}", mission.spacecraft_id, fmt::join(solved.failures, "\n")));
  }
  return solved;
}

/// A run with the samples, by the path on which `process` stores them, and what was made of them.
/// @return its id.
Expected<std::string> store(const ReconstructOptions& options, const Mission& mission,
                            std::vector<SampleBatch> samples,
                            const std::vector<ReconstructionProduct>& methods) {
  std::vector<std::string> telemetry{options.telemetry.begin(), options.telemetry.end()};
  if (telemetry.empty()) {
    telemetry.push_back(options.db.string());
  }
  auto processor = Processor::make({mission}, {.mode = RunMode::Process, .telemetry = telemetry});
  if (!processor) {
    return Unexpected{processor.error()};
  }
  auto archive = Archive::open(options.db, {});
  if (!archive) {
    return Unexpected{archive.error()};
  }
  ArchiveBatch last{.run_id = {}, .spacecraft_id = mission.spacecraft_id};
  const auto submit = [&](std::vector<ArchiveBatch> batches) {
    last.run_id = batches.empty() ? last.run_id : batches.back().run_id;
    return submit_all(**archive, std::move(batches));
  };
  Expected<void> stored =
      processor->arrive_after(options.db).and_then([&] { return submit(processor->begin()); });
  for (SampleBatch& batch : samples) {
    stored = stored.and_then([&] { return submit(processor->route(std::move(batch)).samples); });
  }
  stored = stored.and_then([&] {
    last.products.assign(methods.begin(), methods.end());
    last.finished_utc = utc_now();
    return (*archive)->submit(last);
  });
  return outcome_of(stored, (*archive)->close()).map([&] { return last.run_id; });
}

Expected<void> print(const ReconstructOptions& options, const SeparationReport& report,
                     const SolvedSeparation& solved) {
  const std::string plot = options.plot.empty() ? std::string{} : plot_of(report);
  if (!plot.empty()) {
    if (auto written = write_file(options.plot, plot); !written) {
      return written;
    }
  }
  if (options.json) {
    nlohmann::json json = to_json(report);
    json["db"] = options.db.string();
    json["failures"] = solved.failures;
    json["plot"] = plot.empty() ? nlohmann::json{} : nlohmann::json(options.plot.string());
    fmt::print("{}", json_line(json));
    return {};
  }
  fmt::print("{}archive: {}\n", to_text(report), options.db.string());
  if (!plot.empty()) {
    fmt::print("plot: {}\n", options.plot.string());
  }
  return {};
}

}  // namespace

Expected<bool> reconstruct(const ReconstructOptions& options) {
  const auto mission = mission_for(options);
  if (!mission) {
    return Unexpected{mission.error()};
  }
  warn_of_orbit(options.mission.value_or(options.db), *mission);
  auto from = recorded(options, *mission);
  if (!from) {
    return Unexpected{std::move(from.error())};
  }
  if (from->bad_rows.count > 0) {
    spdlog::warn("{}", from->bad_rows.text());
  }
  const auto answer = solved(options, *mission, std::move(from->samples));
  if (!answer) {
    return Unexpected{answer.error()};
  }
  for (const std::string& failure : answer->failures) {
    spdlog::error("{}: {}", mission->spacecraft_id, failure);
  }
  const auto run_id = store(options, *mission, std::move(from->to_store), answer->methods);
  if (!run_id) {
    return Unexpected{run_id.error()};
  }
  return print(options,
               {.spacecraft_id = mission->spacecraft_id,
                .run_id = *run_id,
                .methods = answer->methods},
               *answer)
      .map([&] { return answer->failures.empty(); });
}

}  // namespace spindrift
