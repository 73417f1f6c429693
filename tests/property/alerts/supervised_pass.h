/// @file
/// Runs simulated passes through processing and supervision as a service does, without bus, archive
/// and wall clock.

#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <functional>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "services/alerts/alert_desk.h"
#include "services/ingest/sequence_tracker.h"
#include "services/processor/processor.h"
#include "services/serving/session_watch.h"
#include "services/simulation/ground_model.h"
#include "services/simulation/pass_files.h"
#include "services/simulation/scenario.h"
#include "services/simulation/simulated_pass.h"
#include "tests/support/scenario_text.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/test_paths.h"
#include "tests/support/text_of.h"

namespace spindrift::testing {

using AnySample = TelemetryKinds::Of<std::variant, TelemetrySample>;

inline TaiTime& time_of(AnySample& sample) {
  return std::visit([](auto& is) -> TaiTime& { return is.value.t; }, sample);
}

/// Holds a sample and its time of arrival.
struct Sent {
  TaiTime came;
  AnySample sample;
};

struct Flight {
  Mission mission;
  std::vector<Sent>
      sent;  ///< Samples of one source in order of time; each arrives at its own time.
};

/// Numbers the samples of each topic as one session.
inline void number(std::vector<Sent>& sent) {
  std::map<std::size_t, std::uint64_t> next;
  for (Sent& one : sent) {
    std::visit([&](auto& is) { is.origin.seq = next[one.sample.index()]++; }, one.sample);
  }
}

inline Flight flown(const std::string& scenario_text, const std::string& more_of_mission = "") {
  const TemporaryFolder folder;
  const auto scenario = load_scenario(folder.write("scenario.toml", scenario_text)).value();
  const SimulatedPass pass = simulated_pass(scenario).value();
  const auto written = folder.path() / "pass";
  write_pass(written, scenario, pass).value();
  const auto path = written / "mission.toml";
  Flight flight{.mission = mission_of(path, text_of(path) + more_of_mission).value(), .sent = {}};
  in_order_of_arrival(pass.telemetry, [&]<class Value>(const Placed<Value>& placed) {
    flight.sent.push_back(
        {.came = placed.value.t,
         .sample = TelemetrySample<Value>{.spacecraft = scenario.spacecraft_id,
                                          .origin = {.source = "front-end", .session = 1, .seq = 0},
                                          .value = placed.value}});
  });
  std::stable_sort(flight.sent.begin(), flight.sent.end(),
                   [](const Sent& a, const Sent& b) { return a.came < b.came; });
  number(flight.sent);
  return flight;
}

/// Holds what became of the alerts under a key.
struct Raised {
  AlertSeverity severity;  ///< Severity of the first alert, as is `t`.
  TaiTime t;
  std::set<std::string> ids = {};       ///< Occurrences.
  std::int64_t begun = 0;               ///< How often the condition has begun.
  std::optional<TaiTime> cleared = {};  ///< Empty while an alert is open.
};
using RaisedByKey = std::map<std::string, Raised>;

class SupervisedPass {
 public:
  SupervisedPass(const Mission& mission, RunMode mode)
      : id_{mission.spacecraft_id},
        processor_{Processor::make({mission}, {.mode = mode, .telemetry = {"simulated"}}).value()},
        desk_{{mission}, mode, load_ground_models({&mission, 1}).value()} {
    see(processor_.begin());
  }

  /// Processes all samples at once, like `process`.
  RaisedByKey process(const std::vector<Sent>& sent) {
    SampleBatch batch;
    std::int64_t place = 0;
    for (const Sent& one : sent) {
      add(one, {place++}, batch);
    }
    see(processor_.process(std::move(batch)));
    finish();
    return raised_;
  }

  /// Ends the run, like `process` and a service that stops.
  void finish() { see(processor_.finish()); }

  /// Returns the keys of the open alerts.
  std::set<std::string> open() const {
    std::set<std::string> keys;
    for (const OpenAlert& one : desk_.open()) {
      keys.insert(one.alert.key);
    }
    return keys;
  }

  /// Called with time and quality of each answer in force when supervision has seen it.
  std::function<void(TaiTime, Quality)> on_answer = [](TaiTime /*t*/, Quality /*quality*/) {};
  /// Called with each state of the service before supervision sees it, and the seconds since start.
  std::function<void(ServiceState&, double)> on_state = [](ServiceState& /*state*/, double /*t*/) {
  };

  /// Processes the samples in steps of one second, like `serve`, and so long beyond their end.
  RaisedByKey serve(const std::vector<Sent>& sent, int longer_s = 15) {
    const TaiTime start = sent.front().came;
    auto next = sent.begin();
    for (int second = 1; next != sent.end() || second <= end_s_ + longer_s; ++second) {
      const TaiTime now = shifted(start, second);
      SampleBatch batch;
      for (std::int64_t place = 0; next != sent.end() && next->came < now; ++next) {
        add(*next, {place++}, batch);
        note(*next);
        end_s_ = second;
      }
      take(std::move(batch), now, second);
      supervise(now, second);
    }
    return raised_;
  }

 private:
  void add(const Sent& one, BatchPlace place, SampleBatch& batch) {
    std::visit(
        [&]<class Value>(TelemetrySample<Value> sample) {
          sample.place = place;
          batch.samples.of<Value>().push_back(std::move(sample));
        },
        one.sample);
  }

  void note(const Sent& one) {
    std::visit(
        [&](const auto& sample) {
          tracker_.record(sample.origin, sample.spacecraft, one.sample.index());
          last_came_ = one.came;
          late_s_ = seconds_between(sample.value.t, one.came);
        },
        one.sample);
  }

  void take(SampleBatch batch, TaiTime now, int second) {
    const Moment moment{.now = std::chrono::steady_clock::time_point{std::chrono::seconds{second}},
                        .host = now};
    Routed routed = size_of(batch) > 0 ? processor_.route(std::move(batch), moment)
                                       : processor_.fall_silent({id_}, moment);
    for (const ArchiveBatch& samples : routed.samples) {
      sessions_.follow(samples);
    }
    see(std::move(routed.samples));
    for (const PassInput& work : routed.work) {
      see(processor_.compute(work));
      for (BackgroundTask& task : processor_.take_background_tasks(work)) {
        if (auto products = task.solve()) {
          task.batch.products = *std::move(products);
          see({std::move(task.batch)});
        }
      }
    }
  }

  void supervise(TaiTime now, int second) {
    ServiceState state{.t = now,
                       .pass_t = now,
                       .silent_s = seconds_between(last_came_, now),
                       .late_s = late_s_,
                       .sources = sessions_.report(id_, {})};
    for (const auto& [source, missing] : gaps_.beat(tracker_.by_source())) {
      state.sources[source].missing = static_cast<std::int64_t>(missing);
    }
    on_state(state, second);
    for (const ArchiveBatch& batch : desk_.evaluate({{id_, state}}, now)) {
      note_alerts(batch);
    }
  }

  void see(std::vector<ArchiveBatch> batches) {
    for (ArchiveBatch& batch : batches) {
      desk_.evaluate(batch);
      desk_.note_stored({&batch, 1});
      note_alerts(batch);
      for (const Product& product : batch.products) {
        if (const auto* const answer = std::get_if<SpinAnswer>(&product)) {
          on_answer(answer->t, answer->quality);
        } else if (const auto* const attitude = std::get_if<AttitudeEstimate>(&product)) {
          on_answer(attitude->t, attitude->assessment.quality);
        }
      }
    }
  }

  void note_alerts(const ArchiveBatch& batch) {
    for (const Product& product : batch.products) {
      const auto* const alert = std::get_if<Alert>(&product);
      if (alert == nullptr) {
        continue;
      }
      Raised& raised =
          raised_.try_emplace(alert->key, Raised{.severity = alert->severity, .t = alert->raised})
              .first->second;
      raised.ids.insert(alert->alert_id);
      raised.begun = alert->count;
      raised.cleared = alert->cleared;
    }
  }

  std::string id_;
  Processor processor_;
  AlertDesk desk_;
  SequenceTracker tracker_;
  GapWatch gaps_;
  SessionWatch sessions_;
  TaiTime last_came_ = {};
  double late_s_ = 0.0;
  int end_s_ = 0;
  RaisedByKey raised_;
};

/// Returns deploy/scenarios/separation.toml without faults and with star fixes from 120 s on.
inline std::string three_axis_text() {
  std::string text = text_of(scenarios() / "separation.toml");
  text = text.substr(0, text.find("[faults]"));
  text = replaced(text, "duration_s = 309.0", "duration_s = 600.0");
  return replaced(text, "first_star_fix_s = 300.0", "first_star_fix_s = 120.0");
}

}  // namespace spindrift::testing
