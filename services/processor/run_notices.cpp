#include "services/processor/run_notices.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <cmath>
#include <string_view>
#include <utility>

#include "pipelines/time/time_span.h"
#include "pipelines/time/utc.h"
#include "services/base/counted.h"
#include "services/processor/told.h"

namespace spindrift {
namespace {

std::string named(const SourceId& source) {
  return fmt::format("'{}' (session {})", source.name, source.session);
}

std::string span_text(TaiTime from, TaiTime to) {
  return fmt::format("{:.0f} s {}", std::abs(elapsed_s(from, to)),
                     to > from ? "ahead of" : "behind");
}

std::string problem_text(const std::string& spacecraft, const SourceWatch::News& apart) {
  return fmt::format("{}: the samples of source {} are left out: it says {}, {} the clock with {}",
                     spacecraft, named(apart.source), format_utc(apart.t),
                     span_text(apart.clock, apart.t), format_utc(apart.clock));
}

}  // namespace

RunNotices::RunNotices(const Mission& mission)
    : spacecraft_id_{mission.spacecraft_id},
      spacecraft_kind_{mission.kind()},
      tables_{mission.tables} {}

void RunNotices::tell_sources(SourceWatch& sources, std::vector<Product>& products) const {
  for (const SourceWatch::News& news : sources.take_news()) {
    if (news.healed) {
      products.emplace_back(told("source_agrees",
                                 {{"spacecraft", spacecraft_id_}, {"source", news.source.name}},
                                 fmt::format("{}: source {} agrees with the others again",
                                             spacecraft_id_, named(news.source))));
    } else {
      products.emplace_back(
          told("source_apart",
               {{"spacecraft", spacecraft_id_},
                {"source", news.source.name},
                {"t_tai_ns", tai_ns(news.t)},
                {"clock_tai_ns", tai_ns(news.clock)}},
               fmt::format("{}; until it agrees with it, or the others are silent",
                           problem_text(spacecraft_id_, news))));
    }
  }
}

RunNotice RunNotices::clock_told(const std::string& source, TaiTime t) const {
  return told("source_apart_from_host",
              {{"spacecraft", spacecraft_id_}, {"source", source}, {"t_tai_ns", tai_ns(t)}},
              fmt::format("{}: source '{}' says {}, and the clock of this host another time: one "
                          "of them is wrong, or what it sends is recorded; until a source is in "
                          "time by the host, this one is the clock",
                          spacecraft_id_, source, format_utc(t)));
}

void RunNotices::tell_new_run(const SourceId& successor, TaiTime t,
                              const std::optional<SourceId>& leader, TaiTime before) const {
  spdlog::log(t < before ? spdlog::level::warn : spdlog::level::info,
              "{}: a new run begins with source {}: it says {}, {} {} with {}, which is silent or "
              "has the clock of this host against it",
              spacecraft_id_, named(successor), format_utc(t), span_text(before, t),
              leader ? "source " + named(*leader) : "the others", format_utc(before));
}

std::vector<SourceProblem> RunNotices::problems(const SourceWatch& sources) const {
  std::vector<SourceProblem> problems;
  for (const auto& [apart, heard] : sources.apart()) {
    problems.push_back({.text = problem_text(spacecraft_id_, apart), .heard = heard});
  }
  return problems;
}

void RunNotices::tell_both(std::vector<Product>& products) {
  if (spacecraft_kind_ == SpacecraftKind::Spin && !std::exchange(told_both_, true)) {
    products.emplace_back(told(
        "pulses_and_coded_frames", {{"spacecraft", spacecraft_id_}},
        fmt::format("{}: both pulses and coded frames arrive: an edge that both give is used as "
                    "the one that comes first",
                    spacecraft_id_)));
  }
}

void RunNotices::tell_silences(const ReachWatch::Silences& silences,
                               std::vector<Product>& products) const {
  if (silences.count == 0) {
    return;
  }
  const auto [count, from, to] = silences;
  products.emplace_back(
      told("silences",
           {{"spacecraft", spacecraft_id_},
            {"silences", count},
            {"longest_from_tai_ns", tai_ns(from)},
            {"longest_to_tai_ns", tai_ns(to)}},
           fmt::format("{}: the telemetry has {} of more than {} minutes without a sample{}, from "
                       "{} to {}: it is computed as one pass all the same",
                       spacecraft_id_, counted(count, "spans"), ReachWatch::kSilence.count(),
                       count == 1 ? "" : ", the longest", format_utc(from), format_utc(to))));
}

void RunNotices::tell_undescribed(const TelemetrySamples& samples, std::vector<Product>& products) {
  TelemetryKinds::for_each([&]<class Value>(Kind<Value> /*kind*/) {
    constexpr std::string_view kSensor = Telemetry<Value>::kSensor;
    bool& is_told = told_undescribed_[kTelemetryKind<Value>];
    if (is_told || samples.of<Value>().empty()) {
      return;
    }
    if (kSensor.empty()) {
      if (spacecraft_kind_ == SpacecraftKind::Spin) {
        is_told = true;
        spdlog::info("{}: {} arrive: they are stored; the orbit is the mission file's",
                     spacecraft_id_, Telemetry<Value>::kPlural);
      }
    } else if (!tables_.contains(std::string{kSensor})) {
      is_told = true;
      products.emplace_back(
          told("no_sensor",
               {{"spacecraft", spacecraft_id_},
                {"samples", Telemetry<Value>::kPlural},
                {"table", kSensor}},
               fmt::format("{}: {} arrive, and the mission file has no [{}]: they are stored, and "
                           "nothing is computed from them",
                           spacecraft_id_, Telemetry<Value>::kPlural, kSensor)));
    }
  });
}

}  // namespace spindrift
