#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>

#include "pipelines/core/shown.h"
#include "pipelines/time/utc.h"
#include "services/alerts/alert_desk.h"
#include "services/alerts/stored_alerts.h"
#include "services/archive/archive.h"
#include "services/archive/stored_rows.h"
#include "services/archive/submit_all.h"
#include "services/base/json_line.h"
#include "services/base/wall_clock.h"
#include "services/base/warning.h"
#include "services/processor/processor.h"
#include "services/program/commands.h"
#include "services/program/orbit_notice.h"
#include "services/program/outcome.h"
#include "services/program/telemetry_input.h"
#include "services/simulation/comparison_report.h"
#include "services/simulation/ground_model.h"
#include "services/simulation/output_file.h"

namespace spindrift {
namespace {

/// Runs the comparison and collects its notices.
class Telling {
 public:
  Telling(std::shared_ptr<const GroundModel> model, double band_sigmas)
      : span_{span_of(*model)}, comparison_{std::move(model), band_sigmas} {}

  template <class Sample>
  void compare(const Sample& sample) {
    if (sample.t >= span_.from && sample.t <= span_.to) {
      note(comparison_.compare(sample));
    }
  }
  void finish() { note(comparison_.finish()); }

  std::vector<ChannelComparison> channels() const { return comparison_.channels(); }
  const ModelSpan& span() const { return span_; }
  const std::vector<ComparedSample>& samples() const { return samples_; }
  const ConditionChanges& changes() const { return changes_; }

 private:
  void note(ModelComparison::Compared compared) {
    std::move(compared.samples.begin(), compared.samples.end(), std::back_inserter(samples_));
    std::move(compared.changes.begin(), compared.changes.end(), std::back_inserter(changes_));
  }

  ModelSpan span_;
  ModelComparison comparison_;
  std::vector<ComparedSample> samples_;
  ConditionChanges changes_;
};

Expected<void> compare_files(const CompareOptions& options, const std::string& spacecraft_id,
                             Telling& telling) {
  auto input = TelemetryInput::open(options.telemetry, spacecraft_id, false);
  if (!input) {
    return Unexpected{std::move(input.error())};
  }
  while (true) {
    const auto batch = input->next();
    if (!batch) {
      return Unexpected{batch.error()};
    }
    if (is_empty(*batch)) {
      break;
    }
    in_order_of_arrival(batch->samples, [&](const auto& sample) {
      if (sample.spacecraft == spacecraft_id) {
        telling.compare(sample.value);
      }
    });
  }
  static_cast<void>(told_bad_rows(input->bad_rows()));  // Results of files are not stored.
  return {};
}

Expected<void> compare_archive(const CompareOptions& options, const Mission& mission,
                               Telling& telling) {
  return find_telemetry(options.db, mission.spacecraft_id, mission.preferred_source,
                        telling.span().from, telling.span().to)
      .map([&](const PlacedValues& values) {
        in_order_of_arrival(values, [&](const auto& placed) { telling.compare(placed.value); });
      });
}

/// Hands the open departure alerts of earlier runs to `desk`, so that a continuing departure is not
/// raised twice and one that is over is cleared.
Expected<void> take_up_departures(const std::filesystem::path& db, const std::string& spacecraft_id,
                                  AlertDesk& desk) {
  return find_alerts(db).map([&](const std::vector<StoredAlert>& alerts) {
    for (const StoredAlert& stored : alerts) {
      if (stored.mode == RunMode::Process && stored.spacecraft == spacecraft_id &&
          stored.alert.key.starts_with(name_of(AlertCode::ModelDeparture))) {
        desk.take_up(stored.spacecraft, stored.run_id, stored.alert);
      }
    }
  });
}

/// Stores a run with the result of each channel and the alerts. @return The run's id.
Expected<std::string> store(const CompareOptions& options, const Mission& mission,
                            const Telling& telling) {
  auto processor = Processor::make(
      {mission}, {.mode = RunMode::Process,
                  .telemetry = absolute_texts(std::vector{options.db, options.model})});
  if (!processor) {
    return Unexpected{processor.error()};
  }
  AlertDesk desk{{mission}, RunMode::Process};
  if (const auto open = take_up_departures(options.db, mission.spacecraft_id, desk); !open) {
    return Unexpected{open.error()};
  }
  return Archive::open(options.db,
                       {.on_submit = [&](ArchiveBatch& batch) { desk.evaluate(batch); }})
      .and_then([&](std::unique_ptr<Archive>&& archive) {
        ArchiveBatch last{.run_id = {}, .spacecraft_id = mission.spacecraft_id};
        const auto stored = processor->arrive_after(options.db)
                                .and_then([&] {
                                  auto begun = processor->begin();
                                  last.run_id = begun.back().run_id;
                                  return submit_all(*archive, std::move(begun));
                                })
                                .and_then([&] {
                                  for (ChannelComparison& channel : telling.channels()) {
                                    last.products.emplace_back(std::move(channel));
                                  }
                                  desk.tell(telling.changes(), last);
                                  last.finished_utc = utc_now();
                                  return archive->submit(last);
                                });
        return outcome_of(stored, archive->close()).map([&] { return last.run_id; });
      });
}

bool has_values(const ComparisonReport& report) {
  return std::any_of(report.channels.begin(), report.channels.end(),
                     [](const ChannelComparison& one) { return one.residuals.count() > 0; });
}

Expected<void> write_plot(const CompareOptions& options, const ComparisonReport& report,
                          const Telling& telling) {
  return options.plot.empty() ? Expected<void>{}
                              : write_file(options.plot, plot_of(report, telling.samples()));
}

void print(const CompareOptions& options, const ComparisonReport& report,
           const std::string& run_id) {
  if (options.json) {
    nlohmann::json object = to_json(report);
    object["run_id"] = run_id.empty() ? nlohmann::json(nullptr) : nlohmann::json(run_id);
    object["plot"] =
        options.plot.empty() ? nlohmann::json(nullptr) : nlohmann::json(options.plot.string());
    fmt::print("{}", json_line(with_warnings(object)));
    return;
  }
  fmt::print("{}", to_text(report));
  if (!run_id.empty()) {
    fmt::print("run {} in {}\n", run_id, options.db.string());
  }
  if (!options.plot.empty()) {
    fmt::print("plot: {}\n", options.plot.string());
  }
}

Unexpected nothing_compared(const CompareOptions& options, const std::string& spacecraft_id,
                            const ModelSpan& span) {
  return refused(fmt::format(
      "{}: no sample of {} from {} to {} that the model {} could be compared with",
      shown(options.telemetry.empty() ? options.db.string() : options.telemetry.front().string()),
      shown(spacecraft_id), format_utc(span.from), format_utc(span.to),
      shown(options.model.string())));
}

}  // namespace

Expected<void> compare(const CompareOptions& options) {
  const auto mission = load_mission(options.mission);
  if (!mission) {
    return Unexpected{mission.error()};
  }
  warn_of_orbit(options.mission, *mission);
  const auto model = load_ground_model(options.model, *mission);
  if (!model) {
    return Unexpected{model.error()};
  }
  const std::string& id = mission->spacecraft_id;
  Telling telling{*model, mission->alerts.departure_sigmas};
  if (auto compared = options.telemetry.empty() ? compare_archive(options, *mission, telling)
                                                : compare_files(options, id, telling);
      !compared) {
    return compared;
  }
  telling.finish();
  if (telling.samples().empty()) {
    return nothing_compared(options, id, telling.span());
  }
  const ComparisonReport report{.spacecraft_id = id,
                                .model = options.model,
                                .span = telling.span(),
                                .band_sigmas = mission->alerts.departure_sigmas,
                                .channels = telling.channels()};
  if (!options.plot.empty() && !has_values(report)) {
    return refused("--plot: flight has no value that the model has, too: there is nothing to draw");
  }
  const auto run_id =
      options.db.empty() ? Expected<std::string>{std::string{}} : store(options, *mission, telling);
  if (!run_id) {
    return Unexpected{run_id.error()};
  }
  return write_plot(options, report, telling).map([&] { print(options, report, *run_id); });
}

}  // namespace spindrift
