#include "services/console/metrics.h"

#include <fmt/format.h>
#include <prometheus/metric_family.h>
#include <prometheus/text_serializer.h>

#include <sstream>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace spindrift {
namespace {

using prometheus::ClientMetric;
using prometheus::MetricFamily;
using prometheus::MetricType;
using Labels = std::vector<ClientMetric::Label>;

/// Collects the metrics of one name.
class Family {
 public:
  Family(std::string_view name, std::string help, MetricType type = MetricType::Gauge)
      : family_{.name = fmt::format("spindrift_{}", name),
                .help = std::move(help),
                .type = type,
                .metric = {}} {}

  Family& add(double value, Labels labels = {}) {
    ClientMetric metric;
    metric.label = std::move(labels);
    (family_.type == MetricType::Counter ? metric.counter.value : metric.gauge.value) = value;
    family_.metric.push_back(std::move(metric));
    return *this;
  }
  Family& add(const DurationHistogram& durations) {
    ClientMetric metric;
    metric.histogram.sample_count = durations.count();
    metric.histogram.sample_sum = durations.sum_s();
    for (std::size_t i = 0; i < DurationHistogram::kBounds_s.size(); ++i) {
      metric.histogram.bucket.push_back({.cumulative_count = durations.counts().at(i),
                                         .upper_bound = DurationHistogram::kBounds_s.at(i)});
    }
    family_.metric.push_back(std::move(metric));
    return *this;
  }
  /// Adds a number of `object`, if present.
  Family& add(const nlohmann::json& object, const char* member, Labels labels = {}) {
    if (const auto value = object.find(member); value != object.end() && value->is_number()) {
      add(value->get<double>(), std::move(labels));
    }
    return *this;
  }

  void put_into(std::vector<MetricFamily>& families) {
    if (!family_.metric.empty()) {
      families.push_back(std::move(family_));
    }
  }

 private:
  MetricFamily family_;
};

std::string text_of(const nlohmann::json& object, const char* member) {
  return object.value(member, std::string{});
}

void add_service(const nlohmann::json& service, std::vector<MetricFamily>& all) {
  const auto counter = [&](const char* name, const char* help, const char* member) {
    Family{name, help, MetricType::Counter}.add(service, member).put_into(all);
  };
  Family{"build_info", "1, with the version"}
      .add(1.0, {{"version", text_of(service, "version")}, {"mode", text_of(service, "mode")}})
      .put_into(all);
  counter("samples_received_total",
          "Samples that came, those of other spacecraft and duplicates "
          "too",
          "samples_received");
  counter("samples_committed_total", "Samples that are stored", "samples_committed");
  counter("samples_rejected_total", "Samples that were unreadable or impossible",
          "samples_rejected");
  counter("samples_duplicate_total", "Samples that came again", "duplicates");
  Family{"samples_missing", "Gaps in the numbers of the sources, that may still be filled"}
      .add(service, "gaps")
      .put_into(all);
  Family{"queue_depth", "What waits to be routed, computed and stored"}
      .add(service, "queue_depth")
      .put_into(all);
}

void add_archive(const ArchiveStatistics& archive, std::vector<MetricFamily>& all) {
  Family{"commit_seconds", "How long commits took", MetricType::Histogram}
      .add(archive.commits)
      .put_into(all);
  Family{"rows_committed_total", "Rows that are stored", MetricType::Counter}
      .add(static_cast<double>(archive.rows_committed))
      .put_into(all);
  Family{"archive_failing", "1 while the archive stores nothing"}
      .add(archive.failure ? 1.0 : 0.0)
      .put_into(all);
}

void add_spacecraft(const nlohmann::json& spacecraft, std::vector<MetricFamily>& all) {
  Family age{"data_age_seconds", "Since the last sample of the spacecraft came"};
  Family sigma{"sigma_degrees", "Of the answer to report"};
  Family quality{"quality", "1 for the quality of the answer to report"};
  Family link{"link", "1 for the state of the link"};
  for (const auto& [id, state] : spacecraft.items()) {
    age.add(state, "data_age_s", {{"spacecraft", id}});
    sigma.add(state, "sigma_deg", {{"spacecraft", id}});
    link.add(1.0, {{"spacecraft", id}, {"state", text_of(state, "state")}});
    if (state.contains("quality")) {
      quality.add(1.0, {{"spacecraft", id}, {"quality", text_of(state, "quality")}});
    }
  }
  for (Family* const one : {&age, &sigma, &quality, &link}) {
    one->put_into(all);
  }
}

void add_alerts(const nlohmann::json& alerts, std::vector<MetricFamily>& all) {
  Family open{"alert", "1 for each open alert"};
  for (const nlohmann::json& alert : alerts) {
    open.add(1.0, {{"spacecraft", text_of(alert, "spacecraft")},
                   {"key", text_of(alert, "key")},
                   {"severity", text_of(alert, "severity")},
                   {"state", text_of(alert, "state")}});
  }
  open.put_into(all);
  Family{"alerts_open", "Open alerts"}.add(static_cast<double>(alerts.size())).put_into(all);
}

}  // namespace

std::string metrics_text(const nlohmann::json& state, const ArchiveStatistics& archive,
                         const DurationHistogram& latencies, const ViewerCounts& viewers,
                         std::optional<std::int64_t> webhook_failures) {
  std::vector<MetricFamily> all;
  add_service(state.at("service"), all);
  add_archive(archive, all);
  Family{"latency_seconds",
         "From when the last sample that a result rests on was queued to its announcement",
         MetricType::Histogram}
      .add(latencies)
      .put_into(all);
  add_spacecraft(state.at("spacecraft"), all);
  add_alerts(state.at("alerts"), all);
  if (webhook_failures) {
    Family{"webhook_failures_total", "How often the webhook did not take alerts",
           MetricType::Counter}
        .add(static_cast<double>(*webhook_failures))
        .put_into(all);
  }
  Family{"viewers", "Who watches the console"}
      .add(static_cast<double>(viewers.watching))
      .put_into(all);
  Family{"viewers_dropped_total", "Viewers that took nothing any more", MetricType::Counter}
      .add(static_cast<double>(viewers.dropped))
      .put_into(all);
  std::ostringstream text;
  prometheus::TextSerializer{}.Serialize(text, all);
  return std::move(text).str();
}

}  // namespace spindrift
