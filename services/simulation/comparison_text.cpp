#include <fmt/format.h>

#include "pipelines/core/shown.h"
#include "pipelines/time/utc.h"
#include "services/base/counted.h"
#include "services/simulation/comparison_report.h"

namespace spindrift {
namespace {

std::string row_of(const ChannelComparison& compared) {
  const ResidualStatistics& residuals = compared.residuals;
  if (residuals.count() == 0) {
    return {};
  }
  return fmt::format("  {:<16}{:>8}  {:>11.4g}{:>11.4g}{:>11.4g}{:>11.4g}  {:<6}{:>10.3f}{:>9}\n",
                     compared.channel.name, residuals.count(), residuals.mean(), residuals.sigma(),
                     residuals.rms(), residuals.most(), compared.channel.unit,
                     residuals.normalised_rms(), compared.outside);
}

std::string departure_text(const ChannelComparison& compared) {
  const Evidence& departure = *compared.departure;
  return departure.sigma ? fmt::format("  {:<16}away since {}: {:.4g} {}, band {:.4g}\n",
                                       compared.channel.name, format_utc(departure.since),
                                       departure.value, departure.unit, departure.limit)
                         : fmt::format("  {:<16}silent since {}, where the model sends\n",
                                       compared.channel.name, format_utc(departure.since));
}

/// Returns the channel that departs first; null where none does.
const ChannelComparison* first_departure(const ComparisonReport& report) {
  const ChannelComparison* first = nullptr;
  for (const ChannelComparison& channel : report.channels) {
    if (channel.departure &&
        (first == nullptr || channel.departure->since < first->departure->since)) {
      first = &channel;
    }
  }
  return first;
}

nlohmann::json json_of(const ChannelComparison& compared) {
  const ResidualStatistics& residuals = compared.residuals;
  nlohmann::json json{{"channel", compared.channel.name},
                      {"unit", compared.channel.unit},
                      {"samples", residuals.count()},
                      {"outside", compared.outside},
                      {"departure", nullptr}};
  for (const auto& [key, value] :
       {std::pair{"mean", residuals.mean()}, std::pair{"sigma", residuals.sigma()},
        std::pair{"rms", residuals.rms()}, std::pair{"most", residuals.most()},
        std::pair{"normalised_rms", residuals.normalised_rms()}}) {
    json[key] = residuals.count() > 0 ? nlohmann::json(value) : nlohmann::json(nullptr);
  }
  if (const auto& departure = compared.departure) {
    json["departure"] = {{"since_tai_ns", tai_ns(departure->since)},
                         {"since_utc", format_utc(departure->since)},
                         {"value", departure->value},
                         {"limit", departure->limit},
                         {"unit", departure->unit}};
  }
  return json;
}

}  // namespace

std::string to_text(const ComparisonReport& report) {
  std::string text = fmt::format(
      "{} against {}\n  model        {} to {}\n  band         {:.4g} sigma of the model's noise; "
      "away is what is outside for most of ten seconds\n\n"
      "  {:<16}{:>8}  {:>11}{:>11}{:>11}{:>11}  {:<6}{:>10}{:>9}\n",
      report.spacecraft_id, shown(report.model.string()), format_utc(report.span.from, 0),
      format_utc(report.span.to, 0), report.band_sigmas, "flight - model", "samples", "mean",
      "sigma", "rms", "most", "unit", "rms/noise", "outside");
  std::string departures;
  for (const ChannelComparison& compared : report.channels) {
    text += row_of(compared);
    departures += compared.departure ? departure_text(compared) : "";
  }
  return text + "\n" + (departures.empty() ? "  no departure\n" : departures);
}

nlohmann::json to_json(const ComparisonReport& report) {
  nlohmann::json channels = nlohmann::json::array();
  for (const ChannelComparison& compared : report.channels) {
    channels.push_back(json_of(compared));
  }
  const ChannelComparison* const first = first_departure(report);
  return {{"spacecraft", report.spacecraft_id},
          {"model", report.model.string()},
          {"from_utc", format_utc(report.span.from)},
          {"to_utc", format_utc(report.span.to)},
          {"band_sigmas", report.band_sigmas},
          {"first_departure",
           first == nullptr ? nlohmann::json(nullptr) : nlohmann::json(first->channel.name)},
          {"channels", std::move(channels)}};
}

}  // namespace spindrift
