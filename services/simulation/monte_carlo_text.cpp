#include "services/simulation/monte_carlo_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "services/base/counted.h"
#include "services/reports/colours.h"
#include "services/reports/xy_panel.h"
#include "services/simulation/statistics.h"

namespace spindrift {
namespace {

nlohmann::ordered_json json_of(const MeasureStatistics& of) {
  nlohmann::ordered_json json = {{"runs", of.count}};
  if (const auto& spread = of.spread) {
    json.update({{"mean", spread->mean},
                 {"rms", spread->rms},
                 {"least", spread->least},
                 {"median", spread->median},
                 {"most_of_95", spread->most_of_95},
                 {"most", spread->most}});
  }
  return json;
}

/// Draws a histogram whose number of bars suits any distribution: twice the root of the runs.
plot::XyPanel histogram(const std::string& name, const std::vector<double>& values) {
  constexpr double kMostBars = 30.0;
  const auto [least, most] = std::minmax_element(values.begin(), values.end());
  const double bars = std::clamp(std::ceil(2.0 * std::sqrt(values.size())), 5.0, kMostBars);
  // All values may be equal.
  const double low = *least;
  const double high = std::max(*most, low + std::max(1e-12, 1e-9 * std::abs(low)));
  const double width = (high - low) / bars;
  std::vector<double> counts(static_cast<std::size_t>(bars));
  for (const double value : values) {
    counts.at(static_cast<std::size_t>(std::min((value - low) / width, bars - 1.0)))++;
  }
  const double highest = 1.1 * *std::max_element(counts.begin(), counts.end());
  plot::XyPanel panel{.title = name,
                      .x = plot::linear_axis("", low, high, 4),
                      .y = plot::linear_axis("runs", 0.0, highest, 4)};
  for (std::size_t i = 0; i < counts.size(); ++i) {
    const double left = low + width * static_cast<double>(i);
    panel.bars.push_back({.left = left, .top = counts[i], .right = left + width, .bottom = 0.0});
  }
  return panel;
}

}  // namespace

std::string runs_csv(const MonteCarloResult& result) {
  std::string text = "run,seed";
  for (const Measure& measure : result.runs.front().measures) {
    text += ',' + measure.name;
  }
  for (const RunResult& run : result.runs) {
    text += fmt::format("\n{},{}", run.run, run.seed);
    for (const Measure& measure : run.measures) {
      text += measure.value ? fmt::format(",{}", *measure.value) : std::string{","};
    }
  }
  return text + '\n';
}

std::string statistics_text(const MonteCarloResult& result) {
  std::string text = fmt::format("{}: {}\n\n{:<28}{:>6}{:>12}{:>12}{:>12}{:>12}{:>12}\n",
                                 result.spacecraft_id, counted(result.runs.size(), "runs"), "",
                                 "runs", "mean", "rms", "median", "95 %", "most");
  for (const MeasureStatistics& of : statistics_of(result)) {
    text += fmt::format("{:<28}{:>6}", of.name, of.count);
    if (const auto& spread = of.spread) {
      for (const double number :
           {spread->mean, spread->rms, spread->median, spread->most_of_95, spread->most}) {
        text += fmt::format("{:>12.5g}", number);
      }
    }
    text += '\n';
  }
  return text;
}

nlohmann::ordered_json statistics_json(const MonteCarloResult& result) {
  nlohmann::ordered_json runs = nlohmann::ordered_json::array();
  for (const RunResult& run : result.runs) {
    nlohmann::ordered_json one = {{"run", run.run}, {"seed", run.seed}};
    for (const Measure& measure : run.measures) {
      one[measure.name] = measure.value ? nlohmann::ordered_json(*measure.value) : nullptr;
    }
    runs.push_back(std::move(one));
  }
  nlohmann::ordered_json statistics = nlohmann::ordered_json::object();
  for (const MeasureStatistics& of : statistics_of(result)) {
    statistics[of.name] = json_of(of);
  }
  return {{"spacecraft", result.spacecraft_id},
          {"runs", std::move(runs)},
          {"statistics", std::move(statistics)}};
}

std::string histograms(const MonteCarloResult& result) {
  constexpr double kLeft = 70.0;
  constexpr double kFirstHistogram = 90.0;
  constexpr double kHistogram = 230.0;
  constexpr double kColumn = 380.0;
  constexpr std::size_t kColumns = 3;
  plot::Svg svg;
  const std::string title =
      fmt::format("{}: {}", result.spacecraft_id, counted(result.runs.size(), "runs"));
  svg.text({kLeft, 28.0}, title, {.colour = plot::kInk, .size = 17.0, .bold = true});
  std::size_t place = 0;
  for (std::size_t i = 0; i < result.runs.front().measures.size(); ++i) {
    const std::vector<double> values = values_of(result, i);
    if (values.empty()) {
      continue;
    }
    const std::size_t row = place / kColumns;
    const double left = kLeft + kColumn * static_cast<double>(place % kColumns);
    const double top = kFirstHistogram + kHistogram * static_cast<double>(row);
    draw(histogram(result.runs.front().measures[i].name, values),
         {.left = left, .top = top, .right = left + 300.0, .bottom = top + 150.0}, svg);
    ++place;
  }
  const std::size_t rows = (place + kColumns - 1) / kColumns;
  return svg.document(plot::kPageWidth, kFirstHistogram + kHistogram * static_cast<double>(rows),
                      title);
}

}  // namespace spindrift
