#include "services/spindrift/summary_text.h"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>

#include "pipelines/frames/celestial.h"
#include "pipelines/time/utc.h"

namespace spindrift {
namespace {

constexpr double kDegPerRad = 180.0 / std::numbers::pi;
constexpr double kRpmPerRad_s = 30.0 / std::numbers::pi;

/// An estimate in the units of people.
struct Readable {
  double ra_deg;
  double dec_deg;
  double sigma_deg;
  double rpm;
  double sigma_rpm;
  std::string utc;
};

Readable readable(const SpinEstimate& estimate) {
  const RaDec place = ra_dec_of(estimate.axis_icrf);
  return {.ra_deg = place.ra_rad * kDegPerRad,
          .dec_deg = place.dec_rad * kDegPerRad,
          .sigma_deg = std::sqrt(estimate.covariance_rad2.trace()) * kDegPerRad,
          .rpm = estimate.spin_rate_rad_s * kRpmPerRad_s,
          .sigma_rpm = estimate.spin_rate_sigma_rad_s * kRpmPerRad_s,
          .utc = format_utc(estimate.t)};
}

}  // namespace

std::string to_text(const RunSummary& summary) {
  std::string text = fmt::format("{}  run {}\n", summary.spacecraft_id, summary.run_id);
  text += fmt::format("  edges        {} received, {} accepted\n", summary.edges_received,
                      summary.edges_accepted);
  for (const auto& [test, count] : summary.edges_rejected) {
    text += fmt::format("               {} rejected: {}\n", count, test);
  }
  text += fmt::format("  bad input    {}\n", summary.input_rejected);
  text += fmt::format("  revolutions  {}\n", summary.revolutions);
  text += fmt::format("  fixes        {}, {} accepted\n", summary.fixes, summary.fixes_accepted);
  if (!summary.mean) {
    return text + "  spin axis    not determined\n";
  }
  const Readable mean = readable(*summary.mean);
  text += fmt::format(
      "  spin axis    right ascension {:.4f} deg, declination {:.4f} deg (ICRF), sigma {:.4f} "
      "deg\n",
      mean.ra_deg, mean.dec_deg, mean.sigma_deg);
  text += fmt::format("  spin rate    {:.6f} rpm, sigma {:.6f} rpm\n", mean.rpm, mean.sigma_rpm);
  text += fmt::format("  at           {}  (mean: {})\n", mean.utc, summary.mean->status);
  return text;
}

nlohmann::json to_json(const RunSummary& summary) {
  nlohmann::json json{{"run_id", summary.run_id},
                      {"spacecraft", summary.spacecraft_id},
                      {"edges_received", summary.edges_received},
                      {"edges_accepted", summary.edges_accepted},
                      {"edges_rejected", nlohmann::json::object()},
                      {"input_rejected", summary.input_rejected},
                      {"revolutions", summary.revolutions},
                      {"fixes", summary.fixes},
                      {"fixes_accepted", summary.fixes_accepted},
                      {"mean", nullptr}};
  for (const auto& [test, count] : summary.edges_rejected) {
    json["edges_rejected"][std::string{test}] = count;
  }
  if (summary.mean) {
    const Readable mean = readable(*summary.mean);
    json["mean"] = {{"t_tai_ns", tai_ns(summary.mean->t)},
                    {"utc", mean.utc},
                    {"ra_deg", mean.ra_deg},
                    {"dec_deg", mean.dec_deg},
                    {"sigma_deg", mean.sigma_deg},
                    {"spin_rate_rpm", mean.rpm},
                    {"sigma_rpm", mean.sigma_rpm},
                    {"status", summary.mean->status}};
  }
  return json;
}

std::string report(const std::vector<RunSummary>& summaries, const std::filesystem::path& db,
                   bool json) {
  if (json) {
    nlohmann::json object{{"db", db.string()}, {"runs", nlohmann::json::array()}};
    for (const RunSummary& summary : summaries) {
      object["runs"].push_back(to_json(summary));
    }
    return object.dump() + "\n";
  }
  std::string text;
  for (const RunSummary& summary : summaries) {
    text += to_text(summary);
  }
  return text + fmt::format("archive: {}\n", db.string());
}

}  // namespace spindrift
