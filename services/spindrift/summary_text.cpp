#include "services/spindrift/summary_text.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "pipelines/time/utc.h"
#include "services/units/degrees.h"

namespace spindrift {
namespace {

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
  const auto [ra_deg, dec_deg] = place_deg(estimate.axis_icrf);
  return {.ra_deg = ra_deg,
          .dec_deg = dec_deg,
          .sigma_deg = sigma_deg(estimate.covariance_rad2),
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

std::string to_text(const SpinEstimate& estimate) {
  const Readable shown = readable(estimate);
  return fmt::format("axis RA {:.4f} Dec {:.4f} deg, sigma {:.4f} deg, {:.6f} rpm, {}",
                     shown.ra_deg, shown.dec_deg, shown.sigma_deg, shown.rpm, estimate.status);
}

std::string report(const std::vector<RunSummary>& summaries,
                   const std::map<std::string, std::int64_t>& other_spacecraft,
                   const std::filesystem::path& db, bool json) {
  if (json) {
    nlohmann::json object{{"db", db.string()},
                          {"runs", nlohmann::json::array()},
                          {"other_spacecraft", other_spacecraft}};
    for (const RunSummary& summary : summaries) {
      object["runs"].push_back(to_json(summary));
    }
    return object.dump() + "\n";
  }
  std::string text;
  for (const RunSummary& summary : summaries) {
    text += to_text(summary);
  }
  for (const auto& [spacecraft, samples] : other_spacecraft) {
    text += fmt::format("{}  no mission here: {} edges not stored\n", spacecraft, samples);
  }
  return text + fmt::format("archive: {}\n", db.string());
}

}  // namespace spindrift
