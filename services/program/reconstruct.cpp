#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <cstddef>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>

#include "pipelines/core/shown.h"
#include "pipelines/three_axis/sample_kind.h"
#include "pipelines/time/contested.h"
#include "services/archive/archive.h"
#include "services/archive/stored_separation.h"
#include "services/archive/submit_all.h"
#include "services/base/json_line.h"
#include "services/base/wall_clock.h"
#include "services/base/warning.h"
#include "services/mission/mission.h"
#include "services/operator/request_socket.h"
#include "services/processor/pass_computing.h"
#include "services/processor/processor.h"
#include "services/processor/separation_solving.h"
#include "services/program/commands.h"
#include "services/program/orbit_notice.h"
#include "services/program/outcome.h"
#include "services/program/requests.h"
#include "services/program/telemetry_input.h"
#include "services/reports/separation_report.h"
#include "services/simulation/output_file.h"

namespace spindrift {
namespace {

/// Returns the mission of the newest run in the archive. Its orbit file is searched where the run
/// had it and beside the archive, which may have come from another machine.
Expected<Mission> stored_mission(const std::filesystem::path& db) {
  const auto stored = find_stored_mission(db);
  if (!stored) {
    return Unexpected{stored.error()};
  }
  std::string why;
  for (const std::filesystem::path& path : {stored->config_path, db}) {
    auto mission = mission_of(path, stored->config_toml);
    if (mission && mission->orbit_sha256 == stored->orbit_sha256) {
      return mission;
    }
    why = mission ? "the orbit file is not that of the run" : mission.error().message;
  }
  return refused(fmt::format("the mission of run {} in {}: give --mission: {}", stored->run_id,
                             shown(db.string()), why));
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

struct ToStore {
  std::vector<SampleBatch> samples;   ///< Empty when the archive already has them.
  std::vector<Product> products;      ///< Contradictions and notices, then the reconstructions.
  std::optional<std::string> sha256;  ///< Hash over all files; empty when there are none.
};

/// Holds the input of the reconstruction and the part of it that is not in the archive yet.
struct Recorded {
  SeparationSamples samples;
  ToStore to_store;
};

template <class Value>
void append(const SampleBatch& batch, const std::string& spacecraft_id, SenderNames& senders,
            std::vector<Value>& values) {
  for (TelemetrySample<Value> sample : batch.samples.of<Value>()) {
    if (sample.spacecraft == spacecraft_id) {
      senders.put_into(sample);
      values.push_back(sample.value);
    }
  }
}

/// Keeps one value where senders contradict each other, and reports the contradictions.
/// @param products Receives the contradictions.
template <class Value>
void settle(const std::string& spacecraft_id, const std::vector<std::string>& senders,
            std::vector<Value>& values, std::vector<Product>& products) {
  bool is_told = false;
  const auto in_time = [](const Value& a, const Value& b) { return a.t < b.t; };
  std::stable_sort(values.begin(), values.end(), in_time);
  values = those_that_count(values, [&](const auto& said, const auto& used) {
    SampleContradiction contradiction{
        .t = said.front().t, .kind = name_of(kind_of(said.front())), .by = senders_of(said, used)};
    fill_in_names(contradiction, senders);
    if (!std::exchange(is_told, true)) {
      products.emplace_back(told(spacecraft_id, contradiction));
    }
    products.emplace_back(std::move(contradiction));
  });
}

Expected<Recorded> recorded_in_files(const std::vector<std::filesystem::path>& paths,
                                     Mission& mission) {
  const std::string& spacecraft_id = mission.spacecraft_id;
  auto input = TelemetryInput::open(paths, spacecraft_id, false);
  if (!input) {
    return Unexpected{std::move(input.error())};
  }
  auto sha256 = input->sha256();
  if (!sha256) {
    return Unexpected{std::move(sha256.error())};
  }
  Recorded recorded;
  SeparationSamples& samples = recorded.samples;
  ToStore& to_store = recorded.to_store;
  to_store.sha256 = *std::move(sha256);
  if (auto notice = input->find_preferred(mission)) {
    to_store.products.emplace_back(*std::move(notice));
  }
  SenderNames senders{mission.preferred_source};
  while (true) {
    auto batch = input->next();
    if (!batch) {
      return Unexpected{std::move(batch.error())};
    }
    if (is_empty(*batch)) {
      const auto settle_all = [&](auto&... values) {
        (settle(spacecraft_id, *senders.names(), values, to_store.products), ...);
      };
      settle_all(samples.gyro, samples.sun, samples.stars, samples.orbit_states);
      if (auto bad_rows = told_bad_rows(input->bad_rows())) {
        to_store.products.emplace_back(*std::move(bad_rows));
      }
      return recorded;
    }
    append(*batch, spacecraft_id, senders, samples.gyro);
    append(*batch, spacecraft_id, senders, samples.sun);
    append(*batch, spacecraft_id, senders, samples.stars);
    append(*batch, spacecraft_id, senders, samples.orbit_states);
    to_store.samples.push_back(std::move(*batch));
  }
}

Expected<Recorded> recorded(const ReconstructOptions& options, Mission& mission) {
  if (!options.telemetry.empty()) {
    return recorded_in_files(options.telemetry, mission);
  }
  return find_separation_samples(options.db, mission.spacecraft_id, mission.preferred_source,
                                 mission.separation->times.separation)
      .map([](SeparationSamples&& samples) {
        return Recorded{.samples = std::move(samples), .to_store = {}};
      });
}

/// @return InvalidConfiguration when the samples allow no method to give an answer.
Expected<SolvedSeparation> solved(const ReconstructOptions& options, const Mission& mission,
                                  SeparationSamples samples) {
  const ReconstructionRequest request{.sensors = std::get<ThreeAxisConfig>(mission.config),
                                      .times = mission.separation->times,
                                      .gyro = std::move(samples.gyro),
                                      .sun_directions = std::move(samples.sun),
                                      .star_fixes = std::move(samples.stars),
                                      .orbit = mission.orbit,
                                      .orbit_states = std::move(samples.orbit_states),
                                      .disturbance_rad_s2 = mission.separation->disturbance_rad_s2,
                                      .node_at_every_gyro_sample = true};
  auto solved = solve_separation(request, mission.separation->launcher, options.method);
  if (solved.methods.empty()) {
    return refused(fmt::format("{}: {}", mission.spacecraft_id, fmt::join(solved.failures, "\n")));
  }
  return solved;
}

/// Stores a run with the samples, by the path on which `process` stores them, and the products.
/// @return The run's id.
Expected<std::string> store(const ReconstructOptions& options, const Mission& mission,
                            ToStore to_store, Archive& archive) {
  auto processor = Processor::make(
      {mission}, {.mode = RunMode::Process,
                  .telemetry = absolute_texts(options.telemetry.empty() ? std::vector{options.db}
                                                                        : options.telemetry),
                  .sha256 = std::move(to_store.sha256)});
  if (!processor) {
    return Unexpected{processor.error()};
  }
  ArchiveBatch last{.run_id = {},
                    .spacecraft_id = mission.spacecraft_id,
                    .stores_residuals = mission.stores_residuals};
  const auto submit = [&](std::vector<ArchiveBatch> batches) {
    last.run_id = batches.empty() ? last.run_id : batches.back().run_id;
    return submit_all(archive, std::move(batches));
  };
  Expected<void> stored =
      processor->arrive_after(options.db).and_then([&] { return submit(processor->begin()); });
  for (SampleBatch& batch : to_store.samples) {
    stored = stored.and_then([&] { return submit(processor->route(std::move(batch)).samples); });
  }
  return stored
      .and_then([&] {
        last.products = std::move(to_store.products);
        last.finished_utc = utc_now();
        return archive.submit(last);
      })
      .and_then([&] { return archive.flush(); })
      .map([&] { return last.run_id; });
}

/// The output to print, whether computed here or by the service.
struct Shown {
  std::string text;
  nlohmann::json object;
  std::string plot;  ///< Empty when no plot was asked for.
  std::vector<std::string> failures;
};

/// @param store_in Called with the mission and what to store; returns the run's id.
template <class StoreIn>
Expected<Shown> made(const ReconstructOptions& options, const StoreIn& store_in) {
  auto mission = mission_for(options);
  if (!mission) {
    return Unexpected{mission.error()};
  }
  warn_of_orbit(options.mission.value_or(options.db), *mission);
  auto from = recorded(options, *mission);
  if (!from) {
    return Unexpected{std::move(from.error())};
  }
  const auto answer = solved(options, *mission, std::move(from->samples));
  if (!answer) {
    return Unexpected{answer.error()};
  }
  std::ranges::move(answer->products(), std::back_inserter(from->to_store.products));
  const auto run_id = store_in(*mission, std::move(from->to_store));
  if (!run_id) {
    return Unexpected{run_id.error()};
  }
  const SeparationReport report{
      .spacecraft_id = mission->spacecraft_id, .run_id = *run_id, .methods = answer->methods};
  Shown shown{.text = to_text(report),
              .object = to_json(report),
              .plot = options.plot.empty() ? std::string{} : plot_of(report),
              .failures = {}};
  shown.object["failures"] = answer->failures;
  for (const std::string& failure : answer->failures) {
    shown.failures.push_back(fmt::format("{}: {}", mission->spacecraft_id, failure));
  }
  return shown;
}

/// Reconstructs in this process, with the archive opened for it.
Expected<Shown> made_here(const ReconstructOptions& options) {
  return made(options, [&](const Mission& mission, ToStore to_store) {
    return Archive::open(options.db, {}).and_then([&](std::unique_ptr<Archive>&& archive) {
      auto run_id = store(options, mission, std::move(to_store), *archive);
      return outcome_of(run_id.map([](const std::string&) {}), archive->close()).map([&] {
        return *run_id;
      });
    });
  });
}

/// Asks the service that holds the archive to reconstruct. @return Empty when no service holds it.
Expected<std::optional<Shown>> made_by_holder(const ReconstructOptions& options) {
  nlohmann::json request{{"do", kReconstructRequest},
                         {"mission", nullptr},
                         {"method", nullptr},
                         {"plot", !options.plot.empty()}};
  if (options.mission) {
    request["mission"] = std::filesystem::absolute(*options.mission).string();
  }
  if (options.method) {
    request["method"] = name_of(*options.method);
  }
  const auto answer = ask_holder(options.db, request);
  if (!answer) {
    return Unexpected{answer.error()};
  }
  if (!*answer) {
    return std::nullopt;
  }
  const nlohmann::json& told = **answer;
  if (told.contains("error")) {
    return Unexpected{
        {told.value("bad_input", false) ? ErrorCode::InvalidConfiguration : ErrorCode::Unavailable,
         told["error"].get<std::string>()}};
  }
  return Shown{.text = told.at("text").get<std::string>(),
               .object = told.at("object"),
               .plot = told.at("plot").get<std::string>(),
               .failures = told.at("failures").get<std::vector<std::string>>()};
}

Expected<void> print(const ReconstructOptions& options, Shown shown) {
  if (!shown.plot.empty()) {
    if (auto written = write_file(options.plot, shown.plot); !written) {
      return written;
    }
  }
  if (options.json) {
    shown.object["db"] = options.db.string();
    shown.object["plot"] =
        shown.plot.empty() ? nlohmann::json{} : nlohmann::json(options.plot.string());
    fmt::print("{}", json_line(with_warnings(shown.object)));
    return {};
  }
  fmt::print("{}archive: {}\n", shown.text, options.db.string());
  if (!shown.plot.empty()) {
    fmt::print("plot: {}\n", options.plot.string());
  }
  return {};
}

}  // namespace

nlohmann::json answer_reconstruct(const nlohmann::json& request, const std::filesystem::path& db,
                                  Archive& archive) {
  ReconstructOptions options{.mission = std::nullopt,
                             .telemetry = {},
                             .db = db,
                             .method = std::nullopt,
                             .plot = request.value("plot", false) ? "plot.svg" : ""};
  if (const auto mission = request.find("mission");
      mission != request.end() && mission->is_string()) {
    options.mission = mission->get<std::string>();
  }
  if (const auto method = request.find("method"); method != request.end() && method->is_string()) {
    options.method = named(method->get_ref<const std::string&>(), ReconstructionMethod::Sequential);
  }
  const auto shown = made(options, [&](const Mission& mission, ToStore to_store) {
    return store(options, mission, std::move(to_store), archive);
  });
  if (!shown) {
    return {{"error", shown.error().message},
            {"bad_input", shown.error().code == ErrorCode::InvalidConfiguration}};
  }
  return {{"text", shown->text},
          {"object", shown->object},
          {"plot", shown->plot},
          {"failures", shown->failures}};
}

Expected<bool> reconstruct(const ReconstructOptions& options) {
  // Samples of files need a run of this process, while no service holds the archive.
  auto by_holder = options.telemetry.empty() ? made_by_holder(options)
                                             : Expected<std::optional<Shown>>{std::nullopt};
  if (!by_holder) {
    return Unexpected{by_holder.error()};
  }
  auto shown = *by_holder ? Expected<Shown>{**std::move(by_holder)} : made_here(options);
  if (!shown) {
    return Unexpected{shown.error()};
  }
  for (const std::string& failure : shown->failures) {
    spdlog::error("{}", failure);
  }
  const bool complete = shown->failures.empty();
  return print(options, *std::move(shown)).map([&] { return complete; });
}

}  // namespace spindrift
