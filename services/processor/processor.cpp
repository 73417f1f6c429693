#include "services/processor/processor.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <chrono>
#include <iterator>
#include <string_view>
#include <utility>

#include "services/archive/last_run.h"
#include "services/processor/told.h"

namespace spindrift {
namespace {

/// Products of this much telemetry time before the last stored one are made again. It is longer
/// than a pass holds anything back: an orderly stop settles early what was held.
constexpr std::chrono::minutes kMadeAgain{10};

/// Returns the time from which products are made again. All before it are stored: each table is
/// filled in order, and none is behind what was made last. `reached` limits the time because an
/// orderly stop may have made products of samples from beyond it.
TaiTime made_again_from(const StoredPass& stored, std::optional<TaiTime> reached) {
  const auto last = stored.last_made ? stored.last_made : stored.earliest;
  return last && reached ? std::min(*last, *reached) - kMadeAgain : TaiTime::min();
}

std::variant<SpinRun, ThreeAxisRun> computing_side(const Mission& mission,
                                                   const SpacecraftRun& run) {
  const auto plan =
      run.start().mode == RunMode::Process ? SolvingPlan::AtTheEnd : SolvingPlan::Meanwhile;
  if (mission.spin() == nullptr) {
    return ThreeAxisRun{mission, run.run_id(), plan};
  }
  return SpinRun{mission, run.run_id(), plan};
}

/// Says why a run is not continued: a run holds results of one configuration only.
std::string why_not_continued(const LastRun& last, const RunStart& now) {
  std::string changed;
  const auto note = [&](bool differs, std::string_view what) {
    changed += differs ? fmt::format("{}{}", changed.empty() ? "" : ", ", what) : "";
  };
  note(last.config_sha256 != now.config_sha256, "the mission file");
  note(last.orbit_sha256 != now.orbit_sha256, "the orbit file");
  note(last.software_version != now.software_version, "the program");
  note(last.telemetry != now.telemetry, "the source of telemetry");
  return fmt::format("since run {} these have changed: {}", last.run_id, changed);
}

template <class Value>
void append(std::vector<Value>& values, std::vector<Value> more) {
  std::move(more.begin(), more.end(), std::back_inserter(values));
}

void add(SpacecraftRun::Taken taken, Routed& routed) {
  append(routed.samples, std::move(taken.batches));
  for (PassInput& input : taken.inputs) {
    if (!is_empty(input)) {
      routed.work.push_back(std::move(input));
    }
  }
}

}  // namespace

Expected<Processor> Processor::make(const std::vector<Mission>& missions,
                                    const TelemetrySource& source) {
  Processor processor;
  std::string problems;
  const auto refuse = [&](const std::string& problem) {
    problems += (problems.empty() ? "" : "\n") + problem;
  };
  for (const Mission& mission : missions) {
    const std::string& spacecraft = mission.spacecraft_id;
    if (!processor.index_of_.emplace(spacecraft, processor.runs_.size()).second) {
      refuse(fmt::format("two mission files name the spacecraft '{}': one is allowed", spacecraft));
    } else {
      processor.runs_.emplace_back(mission, source, processor.runs_.size());
      processor.passes_.push_back(computing_side(mission, processor.runs_.back()));
    }
  }
  if (!problems.empty()) {
    return Unexpected{{ErrorCode::InvalidConfiguration, problems}};
  }
  return processor;
}

Expected<void> Processor::arrive_after(const std::filesystem::path& archive) {
  for (SpacecraftRun& run : runs_) {
    const auto last = find_last_first_arrival(archive, run.spacecraft_id());
    if (!last) {
      return Unexpected{last.error()};
    }
    if (*last) {
      run.arrive_after(**last);
    }
  }
  return {};
}

std::vector<ArchiveBatch> Processor::begin() {
  std::vector<ArchiveBatch> batches;
  for (SpacecraftRun& run : runs_) {
    append(batches, run.begin().batches);
  }
  return batches;
}

Expected<GoneOn> Processor::go_on(const std::filesystem::path& archive, const Moment& moment) {
  GoneOn gone_on;
  for (std::size_t i = 0; i < runs_.size(); ++i) {
    auto actions = find_stored_actions(archive, runs_[i].spacecraft_id(), runs_[i].start());
    if (!actions) {
      return Unexpected{actions.error()};
    }
    runs_[i].take_up(*std::move(actions));
    const auto stored =
        find_stored_passes(archive, runs_[i].spacecraft_id(), runs_[i].start(), runs_[i].senders());
    if (!stored) {
      return Unexpected{stored.error()};
    }
    if (stored->empty()) {
      auto last = find_last_run(archive, runs_[i].spacecraft_id(), runs_[i].start().mode);
      if (!last) {
        return Unexpected{last.error()};
      }
      if (*last) {
        begin_behind(i, **std::move(last), gone_on);
      } else {
        add(runs_[i].begin(), gone_on.routed);
      }
    } else {
      go_on(i, *stored, moment, gone_on);
    }
  }
  return gone_on;
}

void Processor::begin_behind(std::size_t i, LastRun last, GoneOn& gone_on) {
  SpacecraftRun& run = runs_[i];
  const std::string why = why_not_continued(last, run.start());
  run.begin_later(
      told("new_run", {{"spacecraft", run.spacecraft_id()}, {"run_id", run.run_id()}, {"why", why}},
           fmt::format("{}: a new run begins: {}: {}", run.spacecraft_id(), run.run_id(), why)));
  gone_on.last_runs.emplace(run.spacecraft_id(), std::move(last));
}

void Processor::go_on(std::size_t i, const std::vector<StoredPass>& stored, const Moment& moment,
                      GoneOn& gone_on) {
  SpacecraftRun::Taken taken = runs_[i].go_on(stored, moment.of(runs_[i].spacecraft_id()));
  const std::string& first = stored.front().run_id;
  AllMadeBefore made;
  for (std::size_t run = 0; run < stored.size(); ++run) {
    made.emplace(stored[run].run_id,
                 MadeBefore{.again_from = made_again_from(stored[run], taken.reached.at(run)),
                            .batches = stored[run].batches,
                            .reconstructed = stored[run].reconstructed});
  }
  std::visit([&](auto& pass) { pass.go_on(first, std::move(made)); }, passes_[i]);
  add(std::move(taken), gone_on.routed);
  for (const StoredPass& pass : stored) {
    for (const LeftOut& left_out : pass.left_out) {
      left_out.values.for_each([&]<class Value>(const std::vector<Arrived<Value>>& of_kind) {
        if (!of_kind.empty()) {
          gone_on.last_origins[kTelemetryKind<Value>].push_back(left_out.last);
        }
      });
    }
    for (std::size_t kind = 0; kind < pass.last_origins.size(); ++kind) {
      append(gone_on.last_origins.at(kind), pass.last_origins.at(kind));
    }
    spdlog::info("{}: continuing run {}: {} samples read back", runs_[i].spacecraft_id(),
                 pass.run_id, count_of(pass.values));
  }
}

Routed Processor::route(SampleBatch samples, const Moment& moment) {
  std::map<std::size_t, SampleBatch> by_run;
  if (!samples.rejected.empty() || !samples.counts.empty()) {
    by_run[0].rejected = std::move(samples.rejected);
    by_run[0].counts = std::move(samples.counts);
  }
  for (const auto& [spacecraft, count] : samples.others) {
    count_other(spacecraft, count);
  }
  samples.samples.for_each([&](auto& of_kind) { distribute(of_kind, by_run); });
  for (OperatorAction& action : samples.actions) {
    if (const auto known = index_of_.find(action.spacecraft); known != index_of_.end()) {
      by_run[known->second].actions.push_back(std::move(action));
    }
  }
  Routed routed;
  for (auto& [run, of_run] : by_run) {
    add(runs_.at(run).receive(std::move(of_run), moment.of(runs_.at(run).spacecraft_id())), routed);
  }
  if (!told_of_others_.empty() && runs_.front().has_begun()) {
    // As with rejected input, these notices are stored with the first run.
    ArchiveBatch& told = routed.samples.emplace_back();
    told.run_id = runs_.front().run_id();
    told.spacecraft_id = runs_.front().spacecraft_id();
    told.products = std::exchange(told_of_others_, {});
  }
  return routed;
}

template <class Value>
void Processor::distribute(SamplesOfKind<Value>& samples,
                           std::map<std::size_t, SampleBatch>& by_run) {
  // The bus delivers samples spacecraft by spacecraft, so most need no new lookup.
  const std::string* last = nullptr;
  SamplesOfKind<Value>* place = nullptr;
  for (TelemetrySample<Value>& sample : samples) {
    if (last == nullptr || sample.spacecraft != *last) {
      const auto known = index_of_.find(sample.spacecraft);
      last = known == index_of_.end() ? nullptr : &known->first;
      place =
          known == index_of_.end() ? nullptr : &by_run[known->second].samples.template of<Value>();
    }
    if (place == nullptr) {
      count_other(sample.spacecraft, 1);
    } else {
      place->push_back(std::move(sample));
    }
  }
}

Routed Processor::fall_silent(const std::vector<std::string>& spacecraft, const Moment& moment) {
  Routed routed;
  for (const std::string& id : spacecraft) {
    add(runs_[index_of_.at(id)].fall_silent(), routed);
  }
  for (SpacecraftRun& run : runs_) {
    if (const auto next = run.next_decision(); next && *next <= moment.now) {
      add(run.decide(moment.of(run.spacecraft_id())), routed);
    }
  }
  return routed;
}

std::optional<std::chrono::steady_clock::time_point> Processor::next_decision() const {
  std::optional<std::chrono::steady_clock::time_point> first;
  for (const SpacecraftRun& run : runs_) {
    if (const auto next = run.next_decision()) {
      first = std::min(first.value_or(*next), *next);
    }
  }
  return first;
}

std::vector<SourceProblem> Processor::source_problems() const {
  std::vector<SourceProblem> problems;
  for (const SpacecraftRun& run : runs_) {
    append(problems, run.source_problems());
  }
  return problems;
}

std::vector<ArchiveBatch> Processor::compute(const PassInput& work) {
  return std::visit([&](auto& pass) { return pass.compute(work); }, passes_.at(work.spacecraft));
}

std::vector<BackgroundTask> Processor::take_background_tasks(const PassInput& work) {
  return std::visit([](auto& pass) { return pass.take_background_tasks(); },
                    passes_.at(work.spacecraft));
}

std::vector<ArchiveBatch> Processor::process(SampleBatch samples) {
  Routed routed = route(std::move(samples));
  std::vector<ArchiveBatch> batches = std::move(routed.samples);
  for (const PassInput& work : routed.work) {
    append(batches, compute(work));
  }
  return batches;
}

std::vector<ArchiveBatch> Processor::finish() {
  std::vector<ArchiveBatch> batches;
  for (std::size_t i = 0; i < runs_.size(); ++i) {
    append(batches, finish(i));
  }
  return batches;
}

std::vector<ArchiveBatch> Processor::finish(std::size_t spacecraft) {
  if (!runs_.at(spacecraft).has_begun()) {
    return {};
  }
  SpacecraftRun::Taken rest = runs_.at(spacecraft).finish();
  std::vector<ArchiveBatch> batches = std::move(rest.batches);
  for (const PassInput& input : rest.inputs) {
    append(batches, compute(input));
  }
  batches.push_back(std::visit([](auto& pass) { return pass.finish(); }, passes_.at(spacecraft)));
  return batches;
}

void Processor::count_other(const std::string& spacecraft, std::int64_t samples) {
  auto& [name, count] = entry_of(other_spacecraft_, spacecraft);
  if (count == 0) {
    told_of_others_.emplace_back(
        told("other_spacecraft", {{"spacecraft", name}},
             fmt::format("samples of {}, which has no mission file here, are left to others",
                         name == kStillMoreSpacecraft ? "still more spacecraft"
                                                      : fmt::format("spacecraft '{}'", name))));
  }
  count += samples;
}

bool Processor::is_live() const {
  return !runs_.empty() && runs_.front().start().mode == RunMode::Live;
}

std::vector<std::string> Processor::spacecraft() const {
  std::vector<std::string> ids;
  for (const SpacecraftRun& run : runs_) {
    ids.push_back(run.spacecraft_id());
  }
  return ids;
}

std::vector<RunSummary> Processor::summaries() const {
  std::vector<RunSummary> summaries;
  for (std::size_t i = 0; i < runs_.size(); ++i) {
    if (!runs_[i].has_begun()) {
      continue;
    }
    for (RunSummary& summary :
         std::visit([](const auto& pass) { return pass.summaries(); }, passes_[i])) {
      const Received received = runs_[i].received(summary.run_id);
      TelemetryKinds::for_each([&]<class Value>(Kind<Value> /*kind*/) {
        if (const std::int64_t count = received.of<Value>(); count > 0) {
          summary.samples_received.emplace(Telemetry<Value>::kPlural, count);
        }
      });
      summary.edges_received = received.of<Pulse>() + received.frame_edges;
      summary.coded_frames_received = received.of<CodedFrame>();
      summary.input_rejected = received.rejected_inputs;
      summaries.push_back(std::move(summary));
    }
  }
  return summaries;
}

}  // namespace spindrift
