#include "services/program/summary_text.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "pipelines/frames/euler312.h"
#include "pipelines/time/utc.h"
#include "services/archive/last_run.h"
#include "services/archive/stored_pass.h"
#include "services/archive/verdict.h"
#include "services/base/assessment_words.h"
#include "services/base/counted.h"
#include "services/base/decimals.h"
#include "services/base/degrees.h"
#include "services/base/json_key.h"
#include "services/base/json_line.h"
#include "services/base/reasons_json.h"
#include "services/base/warning.h"
#include "services/products/separation_json.h"
#include "services/products/to_json.h"
#include "services/program/batch_text.h"
#include "services/program/comparison_notice.h"
#include "services/reports/separation_report.h"

namespace spindrift {
namespace {

/// Holds an estimate in readable units.
struct Readable {
  double ra_deg;
  double dec_deg;
  double sigma_deg;
  double rpm;
  double sigma_rpm;
  std::string utc;
};

Readable readable(const SpinEstimate& estimate) {
  const auto [ra_deg, dec_deg] = place_deg(estimate.axis_icrf);
  return {.ra_deg = ra_deg,
          .dec_deg = dec_deg,
          .sigma_deg = sigma_deg(estimate.covariance_rad2),
          .rpm = estimate.spin_rate_rad_s * kRpmPerRad_s,
          .sigma_rpm = estimate.spin_rate_sigma_rad_s * kRpmPerRad_s,
          .utc = format_utc(estimate.t)};
}

/// Returns for example "1: 590, 2: 7".
template <class Key>
std::string listed(const std::map<Key, std::int64_t>& counts) {
  std::string text;
  for (const auto& [key, count] : counts) {
    text += fmt::format("{}{}: {}", text.empty() ? "" : ", ", key, count);
  }
  return text;
}

template <class Key>
nlohmann::json to_json(const std::map<Key, std::int64_t>& counts) {
  nlohmann::json json = nlohmann::json::object();
  for (const auto& [key, count] : counts) {
    json[fmt::format("{}", key)] = count;
  }
  return json;
}

std::string rejected_text(const RunSummary& summary) {
  return counted(summary.input_rejected, "bad rows") +
         (summary.input_rejected == 1 ? " or sample" : " or samples");
}

std::string fixes_text(const RunSummary& summary) {
  std::string text =
      fmt::format("  fixes        {}, {} accepted\n", summary.fixes, summary.fixes_accepted);
  if (summary.fixes > 0) {
    text += fmt::format("               case         {}\n", listed(summary.fixes_by_case));
    text += fmt::format("               resolution   {}\n", listed(summary.fixes_by_resolution));
  }
  return text;
}

/// Formats a number to its own decimals in a column of up to `most`, below the points of the
/// others.
std::string in_column(double value, int decimals, int most, int width) {
  const std::string text = fmt::format("{:.{}f}", value, decimals);
  const int missing = most - decimals + (decimals == 0 && most > 0 ? 1 : 0);
  return fmt::format("{:>{}}{:{}}", text, width - missing, "", missing);
}

std::string axis_text(const RunSummary& summary) {
  if (summary.estimates.empty()) {
    return "  spin axis    not determined\n";
  }
  int angle = 0;  // Most decimals of angles.
  int rate = 0;
  for (const auto& [estimator, estimate] : summary.estimates) {
    const Readable shown = readable(estimate);
    angle = std::max(angle, decimals_for(shown.sigma_deg, 4));
    rate = std::max(rate, decimals_for(shown.sigma_rpm, 6));
  }
  std::string text = fmt::format(
      "  spin axis    ICRF, deg   {:>{}}  {:>{}}  {:>{}}  {:>{}}  {:>{}}\n", "RA", angle + 5, "Dec",
      angle + 6, "sigma", angle + 3, "spin rate, rpm", rate + 10, "sigma", rate + 3);
  std::string origins;
  for (const auto& [estimator, estimate] : summary.estimates) {
    const Readable shown = readable(estimate);
    const int of_angle = decimals_for(shown.sigma_deg, 4);
    const int of_rate = decimals_for(shown.sigma_rpm, 6);
    text += fmt::format("               {:<12}{}  {}  {}  {}  {:.{}f}\n", name_of(estimator),
                        in_column(shown.ra_deg, of_angle, angle, angle + 5),
                        in_column(shown.dec_deg, of_angle, angle, angle + 6),
                        in_column(shown.sigma_deg, of_angle, angle, angle + 3),
                        in_column(shown.rpm, of_rate, rate, rate + 10), shown.sigma_rpm, of_rate);
    origins += fmt::format("  {:<13}{}  {}\n", name_of(estimator), shown.utc,
                           sentence_of(estimate.assessment));
  }
  return text + origins;
}

/// Holds the Euler angles of the rotation from ICRF to body, deg.
struct EulerDeg {
  double phi;
  double theta;
  double psi;
  bool near_singular;
};

EulerDeg euler_deg(const AttitudeEstimate& attitude) {
  const Euler312Reading reading = euler312_of(attitude.q_icrf_body);
  return {.phi = reading.angles.phi_rad * kDegPerRad,
          .theta = reading.angles.theta_rad * kDegPerRad,
          .psi = reading.angles.psi_rad * kDegPerRad,
          .near_singular = reading.near_singular};
}

double sigma_deg(const AttitudeEstimate& attitude) { return attitude.sigma_rad() * kDegPerRad; }

std::string sensors_text(const RunSummary& summary) {
  std::string text;
  for (std::size_t kind = 0; kind < kSampleKinds; ++kind) {
    const SensorHealth& sensor = summary.sensors.at(kind);
    if (sensor.last_seen) {
      text += fmt::format("  {:<13}{} accepted\n", name_of(static_cast<SampleKind>(kind)),
                          sensor.accepted);
      for (const auto& [test, count] : summary.samples_rejected.at(kind)) {
        text += fmt::format("               {} rejected: {}\n", count, test);
      }
    }
  }
  return text;
}

std::string attitude_text(const RunSummary& summary) {
  if (!summary.attitude) {
    return "  attitude     not determined\n";
  }
  const AttitudeEstimate& attitude = *summary.attitude;
  const Eigen::Quaterniond& q = attitude.q_icrf_body;
  const auto [phi, theta, psi, near_singular] = euler_deg(attitude);
  const int angle = decimals_for(sigma_deg(attitude), 4);
  const int unit = decimals_for(attitude.sigma_rad(), 6);
  std::string text =
      fmt::format("  attitude     ICRF to body, sigma {:.{}f} deg\n", sigma_deg(attitude), angle);
  text +=
      fmt::format("               quaternion   x {:+.{}f}  y {:+.{}f}  z {:+.{}f}  w {:+.{}f}\n",
                  q.x(), unit, q.y(), unit, q.z(), unit, q.w(), unit);
  text += fmt::format("               Euler 3-1-2  phi {:.{}f}  theta {:.{}f}  psi {:.{}f} deg{}\n",
                      phi, angle, theta, angle, psi, angle,
                      near_singular ? ", near the singularity" : "");
  if (attitude.rate_body_rad_s) {
    const Eigen::Vector3d rate_deg_s = *attitude.rate_body_rad_s * kDegPerRad;
    text += fmt::format("               body rate    x {:+.5f}  y {:+.5f}  z {:+.5f} deg/s\n",
                        rate_deg_s.x(), rate_deg_s.y(), rate_deg_s.z());
  }
  return text + fmt::format("  {:<13}{}  {}\n", name_of(attitude.source), format_utc(attitude.t),
                            sentence_of(attitude.assessment));
}

nlohmann::json sensors_json(const RunSummary& summary) {
  nlohmann::json sensors = nlohmann::json::object();
  for (std::size_t kind = 0; kind < kSampleKinds; ++kind) {
    const SensorHealth& sensor = summary.sensors.at(kind);
    if (sensor.last_seen) {
      sensors[std::string{name_of(static_cast<SampleKind>(kind))}] = {
          {"accepted", sensor.accepted},
          {"rejected", to_json(summary.samples_rejected.at(kind))},
          {"rejected_in_a_row", sensor.rejected_in_a_row},
          {"last_seen_tai_ns", tai_ns(*sensor.last_seen)},
          {"last_seen_utc", format_utc(*sensor.last_seen)}};
    }
  }
  return sensors;
}

/// Shows per sensor the share used and the residual scatter over the assumed noise.
std::string residuals_text(const RunSummary& summary) {
  std::vector<std::string> texts;
  for (const SourceSummary& one : summary.ledger.sources()) {
    texts.push_back(fmt::format("{} {:.0f} %{}", name_of(one.source), 100.0 * one.used,
                                one.noise ? fmt::format(" x {:.2f}", *one.noise) : ""));
  }
  return texts.empty() ? std::string{} : fmt::format("  used x noise {}\n", fmt::join(texts, ", "));
}

nlohmann::json residuals_json(const RunSummary& summary) {
  nlohmann::json residuals = nlohmann::json::object();
  for (const SourceSummary& one : summary.ledger.sources()) {
    residuals[std::string{name_of(one.source)}] = {
        {"used", one.used}, {"noise", one.noise ? nlohmann::json(*one.noise) : nlohmann::json{}}};
  }
  return residuals;
}

std::string reconstructions_text(const RunSummary& summary) {
  std::string text;
  for (const ReconstructionProduct& one : summary.reconstructions) {
    text += fmt::format("  {:<13}{}\n", text.empty() ? "separation" : "", to_text(one));
  }
  return text;
}

std::string disagreements_text(const RunSummary& summary) {
  std::string text;
  for (const Disagreement& disagreement : summary.disagreements) {
    text += fmt::format("  comparison   {}\n", sentence_of(disagreement));
  }
  return text;
}

std::string faults_text(const RunSummary& summary) {
  std::string text;
  for (const RunFault& fault : summary.faults) {
    text +=
        fmt::format("  DOUBTFUL     computing failed at {}: {}\n", format_utc(fault.t), fault.what);
  }
  return text;
}

std::string contradictions_text(const RunSummary& summary) {
  return summary.contradictions.empty()
             ? std::string{}
             : fmt::format("  contradicted {}: samples with more than one value\n",
                           listed(summary.contradictions));
}

std::string to_text(const PassVerdict& verdict) {
  const std::string answer =
      verdict.estimator.empty() || !verdict.quality
          ? std::string{}
          : fmt::format("{} by {}{}: ", name_of(*verdict.quality), verdict.estimator,
                        verdict.t ? " at " + format_utc(*verdict.t) : std::string{});
  return fmt::format("  verdict      {}{}\n", answer, verdict.why);
}

nlohmann::json to_json(const PassVerdict& verdict) {
  const auto known = [](std::string_view text) {
    return text.empty() ? nlohmann::json{} : nlohmann::json(text);
  };
  const auto number = [](const std::optional<double>& value) {
    return value ? nlohmann::json(*value) : nlohmann::json{};
  };
  return {
      {"estimator", known(verdict.estimator)},
      {"quality", known(verdict.quality ? name_of(*verdict.quality) : "")},
      {"t_tai_ns", verdict.t ? nlohmann::json(tai_ns(*verdict.t)) : nlohmann::json{}},
      {"utc", known(verdict.t ? format_utc(*verdict.t) : "")},
      {"separation", verdict.separation ? separation_json(*verdict.separation) : nlohmann::json{}},
      {"sigma_deg", number(verdict.sigma_deg)},
      {"noise_sigma_deg", number(verdict.noise_sigma_deg)},
      {"why", verdict.why},
      {"against", verdict.against}};
}

nlohmann::json to_json(const RunFault& fault) {
  nlohmann::json object = json_of(fault);
  object["utc"] = format_utc(fault.t);
  return object;
}

nlohmann::json to_json(const Disagreement& disagreement) {
  return {{"one", disagreement.one},
          {"other", disagreement.other},
          {"apart_deg", disagreement.apart_deg},
          {"apart_sigmas", disagreement.apart_sigmas}};
}

template <class Estimate>
nlohmann::json estimate_json(const Estimate& estimate) {
  nlohmann::json object = json_of(estimate);
  object["reasons"] = nlohmann::json::parse(to_json_text(estimate.assessment.reasons));
  object["utc"] = format_utc(estimate.t);
  return object;
}

nlohmann::json to_json(const AttitudeEstimate& attitude) {
  nlohmann::json object = estimate_json(attitude);
  const auto [phi, theta, psi, near_singular] = euler_deg(attitude);
  object["euler312_icrf_deg"] = {phi, theta, psi};
  object["near_singular"] = near_singular;
  return object;
}

nlohmann::json to_json(const Advisory& advisory) {
  nlohmann::json object = json_of(advisory);
  object["sensors"] = json_of(advisory.sensors);
  object["utc"] = format_utc(advisory.t);
  return object;
}

template <class Value>
Expected<void> put(Expected<Value>&& found, Value& place) {
  return std::move(found).map([&](Value&& value) { place = std::move(value); });
}

/// Adds to the summary what only the archive knows.
Expected<void> complete(RunSummary& summary, const std::filesystem::path& db) {
  const std::string& run_id = summary.run_id;
  return put(count_stored_edges(db, run_id), summary.edges_stored)
      .and_then([&] { return put(find_verdict(db, run_id), summary.verdict); })
      .and_then([&] { return put(find_faults(db, run_id), summary.faults); })
      .and_then([&] { return put(count_contradictions(db, run_id), summary.contradictions); })
      .and_then([&] { return put(find_disagreements(db, run_id), summary.disagreements); });
}

}  // namespace

nlohmann::json to_json(const SpinEstimate& estimate) { return estimate_json(estimate); }

std::string to_text(const RunSummary& summary) {
  std::string text = fmt::format("{}  run {}{}\n", summary.spacecraft_id, summary.run_id,
                                 summary.verdict.finished ? "" : ", interrupted");
  if (!summary.verdict.finished) {
    text += "  interrupted  what follows rests on a part of the telemetry\n";
  }
  // After a separation the mission asks for the attitude at that time, so it comes first.
  text += reconstructions_text(summary) + to_text(summary.verdict);
  if (summary.kind == SpacecraftKind::ThreeAxis) {
    text += "  received     ";
    for (const auto& [plural, count] : summary.samples_received) {
      text += counted(count, plural) + ", ";
    }
    text += rejected_text(summary) + "\n" + contradictions_text(summary);
    return text + sensors_text(summary) + residuals_text(summary) + attitude_text(summary) +
           faults_text(summary);
  }
  text += fmt::format("  received     {} edges, {} of them stored, {} coded frames, {}\n",
                      summary.edges_received, summary.edges_stored, summary.coded_frames_received,
                      rejected_text(summary));
  text += contradictions_text(summary);
  text += fmt::format("  edges        {} accepted\n", summary.edges_accepted);
  for (const auto& [test, count] : summary.edges_rejected) {
    text += fmt::format("               {} rejected: {}\n", count, test);
  }
  text += residuals_text(summary);
  text += fmt::format("  revolutions  {} with sun1\n", summary.revolutions);
  return text + fixes_text(summary) + axis_text(summary) + faults_text(summary) +
         disagreements_text(summary) + (summary.batch ? to_text(*summary.batch) : std::string{});
}

nlohmann::json to_json(const RunSummary& summary) {
  nlohmann::json json{{"run_id", summary.run_id},
                      {"spacecraft", summary.spacecraft_id},
                      {"kind", name_of(summary.kind)},
                      {"finished", summary.verdict.finished},
                      {"verdict", to_json(summary.verdict)},
                      {"samples_received", nlohmann::json::object()},
                      {"edges_received", summary.edges_received},
                      {"edges_stored", summary.edges_stored},
                      {"coded_frames_received", summary.coded_frames_received},
                      {"edges_accepted", summary.edges_accepted},
                      {"edges_rejected", to_json(summary.edges_rejected)},
                      {"input_rejected", summary.input_rejected},
                      {"revolutions", summary.revolutions},
                      {"fixes", summary.fixes},
                      {"fixes_accepted", summary.fixes_accepted},
                      {"fixes_by_case", to_json(summary.fixes_by_case)},
                      {"fixes_by_resolution", to_json(summary.fixes_by_resolution)},
                      {"mean", nullptr},
                      {"sequential", nullptr},
                      {"batch", nullptr},
                      {"sensors", sensors_json(summary)},
                      {"residuals", residuals_json(summary)},
                      {"attitude", nullptr},
                      {"advisory", nullptr},
                      {"reconstruction", nullptr},
                      {"faults", nlohmann::json::array()},
                      {"contradictions", to_json(summary.contradictions)},
                      {"disagreements", nlohmann::json::array()}};
  for (const auto& [plural, count] : summary.samples_received) {
    json["samples_received"][json_key(plural)] = count;
  }
  for (const auto& [estimator, estimate] : summary.estimates) {
    json[std::string{name_of(estimator)}] = to_json(estimate);
  }
  if (summary.attitude) {
    json["attitude"] = to_json(*summary.attitude);
  }
  if (summary.advisory) {
    json["advisory"] = to_json(*summary.advisory);
  }
  if (!summary.reconstructions.empty()) {
    const nlohmann::json report = to_json(SeparationReport{.spacecraft_id = summary.spacecraft_id,
                                                           .run_id = summary.run_id,
                                                           .methods = summary.reconstructions});
    json["reconstruction"] = {{"batch", report["batch"]}, {"sequential", report["sequential"]}};
  }
  if (summary.batch) {
    json["batch"].update(to_json(*summary.batch));
  }
  for (const RunFault& fault : summary.faults) {
    json["faults"].push_back(to_json(fault));
  }
  for (const Disagreement& disagreement : summary.disagreements) {
    json["disagreements"].push_back(to_json(disagreement));
  }
  return json;
}

std::string to_text(const SpinEstimate& estimate) {
  const Readable shown = readable(estimate);
  const int decimals = decimals_for(shown.sigma_deg, 4);
  return fmt::format("axis RA {:.{}f} Dec {:.{}f} deg, sigma {:.{}f} deg, {:.{}f} rpm, {}: {}",
                     shown.ra_deg, decimals, shown.dec_deg, decimals, shown.sigma_deg, decimals,
                     shown.rpm, decimals_for(shown.sigma_rpm, 6), name_of(estimate.estimator),
                     sentence_of(estimate.assessment));
}

std::string to_text(const AttitudeEstimate& attitude) {
  const auto [phi, theta, psi, near_singular] = euler_deg(attitude);
  const int decimals = decimals_for(sigma_deg(attitude), 4);
  return fmt::format(
      "attitude ICRF to body, Euler 3-1-2 {:.{}f} {:.{}f} {:.{}f} deg, sigma {:.{}f} deg, {}: {}",
      phi, decimals, theta, decimals, psi, decimals, sigma_deg(attitude), decimals,
      name_of(attitude.source), sentence_of(attitude.assessment));
}

std::string to_text(const ReconstructionProduct& reconstruction) {
  const Reconstruction& solution = reconstruction->solution;
  const ReconstructedEvent& separation = *find(solution, SeparationEvent::Separation);
  return fmt::format("T1 {}, {}", format_utc(separation.attitude.t),
                     to_text(estimate_of(solution, separation)));
}

Expected<std::string> report(const Processor& processor, const std::filesystem::path& db,
                             bool json) {
  const auto& other_spacecraft = processor.other_spacecraft();
  std::vector<RunSummary> summaries = processor.summaries();
  for (RunSummary& summary : summaries) {
    if (const auto completed = complete(summary, db); !completed) {
      return Unexpected{completed.error()};
    }
  }
  if (json) {
    nlohmann::json object{{"db", db.string()},
                          {"runs", nlohmann::json::array()},
                          {"other_spacecraft", other_spacecraft}};
    for (const RunSummary& summary : summaries) {
      object["runs"].push_back(to_json(summary));
    }
    return json_line(with_warnings(object));
  }
  std::string text;
  for (const RunSummary& summary : summaries) {
    text += to_text(summary);
  }
  for (const auto& [spacecraft, samples] : other_spacecraft) {
    text += fmt::format("{}  no mission here: {} samples not stored\n", spacecraft, samples);
  }
  return text + fmt::format("archive: {}\n", db.string());
}

}  // namespace spindrift
