#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string_view>
#include <utility>

#include "pipelines/core/shown.h"
#include "services/reports/colours.h"
#include "services/reports/time_page.h"
#include "services/simulation/comparison_report.h"

namespace spindrift {
namespace {

using plot::Curve;
using plot::curve_of;
using plot::TimePage;

constexpr int kTicks = 5;

/// Samples of a channel between two instants of the page.
struct Bin {
  ComparedValue last;
  double most_sigmas;  ///< Largest residual in sigma, with its sign.
};
using Bins = std::vector<std::optional<Bin>>;

struct Grid {
  TaiTime from;
  double step_s;
  std::size_t count;

  std::size_t place(TaiTime t) const {
    const double at = std::max(0.0, seconds_between(from, t) / step_s);
    return std::min(static_cast<std::size_t>(at), count - 1);
  }
  std::vector<TaiTime> times() const {
    std::vector<TaiTime> all;
    for (std::size_t i = 0; i < count; ++i) {
      all.push_back(shifted(from, step_s * static_cast<double>(i)));
    }
    return all;
  }
};

/// Makes a grid that is no finer than the channel with the fewest samples can fill.
Grid grid_of(const ComparisonReport& report, const std::vector<ComparedSample>& samples) {
  constexpr std::int64_t kLeast = 100;
  constexpr std::int64_t kMost = 1000;
  std::int64_t count = kMost;
  for (const ChannelComparison& compared : report.channels) {
    const std::int64_t has = compared.residuals.count();
    count = has > 0 ? std::clamp(has, kLeast, count) : count;
  }
  const auto [first, last] = std::minmax_element(
      samples.begin(), samples.end(),
      [](const ComparedSample& a, const ComparedSample& b) { return a.t < b.t; });
  // A pass of one sample needs a width, too.
  const double span_s = std::max(1.0, seconds_between(first->t, last->t));
  return {.from = first->t,
          .step_s = span_s / static_cast<double>(count - 1),
          .count = static_cast<std::size_t>(count)};
}

std::vector<Bins> bins_of(const ComparisonReport& report,
                          const std::vector<ComparedSample>& samples, const Grid& grid) {
  std::vector<Bins> all(report.channels.size(), Bins(grid.count));
  for (const ComparedSample& sample : samples) {
    if (!sample.value) {
      continue;
    }
    std::optional<Bin>& bin = all.at(sample.channel).at(grid.place(sample.t));
    const double sigmas = sample.value->normalised();
    const bool is_most = !bin || std::abs(sigmas) > std::abs(bin->most_sigmas);
    bin = Bin{.last = *sample.value, .most_sigmas = is_most ? sigmas : bin->most_sigmas};
  }
  return all;
}

/// Returns a curve of `value(bin)`, with gaps where bins are empty.
template <class Value>
Curve curve_of_bins(const std::string& name, std::string_view colour, const Bins& bins,
                    const Value& value) {
  return curve_of(name, colour, bins, [&](const std::optional<Bin>& bin) {
    return bin ? std::optional<double>{value(*bin)} : std::nullopt;
  });
}

std::vector<double> values_of(const std::vector<Curve>& curves) {
  std::vector<double> values;
  for (const Curve& curve : curves) {
    for (const auto& value : curve.values) {
      if (value) {
        values.push_back(*value);
      }
    }
  }
  std::sort(values.begin(), values.end());
  return values;
}

/// Returns an axis that covers the whole model, and flight but for its furthest hundredth at each
/// end: a spurious edge must not hide the others.
plot::ValueAxis axis_of(std::string title, const std::vector<Curve>& flight,
                        const std::vector<Curve>& model, double least_width) {
  const std::vector<double> of_flight = values_of(flight);
  const std::vector<double> of_model = values_of(model);
  const std::size_t cut = of_flight.size() / 100;
  const double low = std::min(of_model.front(), of_flight.at(cut));
  const double high = std::max(of_model.back(), of_flight.at(of_flight.size() - 1 - cut));
  const double room = 0.08 * (high - low) + 0.5 * std::max(0.0, least_width - (high - low));
  return plot::linear_axis(std::move(title), low - room, high + room, kTicks);
}

/// Consecutive channels with values that one sensor gives.
struct Group {
  std::size_t first;
  std::size_t end;
};

std::vector<Group> groups_of(const ComparisonReport& report) {
  std::vector<Group> groups;
  bool is_open = false;
  for (std::size_t i = 0; i < report.channels.size(); ++i) {
    const bool has_values = report.channels[i].residuals.count() > 0;
    if (has_values && is_open) {
      groups.back().end = i + 1;
    } else if (has_values) {
      groups.push_back({.first = i, .end = i + 1});
    }
    is_open = has_values;
  }
  return groups;
}

std::string names_of(const ComparisonReport& report, const Group& group) {
  std::string names;
  for (std::size_t i = group.first; i < group.end; ++i) {
    names += (names.empty() ? "" : ", ") + report.channels[i].channel.name;
  }
  return names;
}

std::string_view colour_of(const Group& group, std::size_t channel) {
  return plot::kCurves.at((channel - group.first) % plot::kCurves.size());
}

/// Adds a panel of the values of channels whose model is not zero by definition.
void add_values(TimePage& page, const ComparisonReport& report, const Group& group,
                const std::vector<Bins>& bins) {
  constexpr double kHeight = 130.0;
  std::vector<Curve> flight;
  std::vector<Curve> model;
  double width = 0.0;
  bool is_relative = true;
  for (std::size_t i = group.first; i < group.end; ++i) {
    flight.push_back(curve_of_bins(report.channels[i].channel.name, colour_of(group, i), bins[i],
                                   [](const Bin& bin) { return bin.last.flight; }));
    model.push_back(curve_of_bins(i == group.first ? "model" : "", plot::kInk, bins[i],
                                  [](const Bin& bin) { return bin.last.model; }));
    model.back().dashes = "3 5";
    for (const auto& bin : bins[i]) {
      width = bin ? std::max(width, 2.0 * report.band_sigmas * bin->last.sigma) : width;
      is_relative = is_relative && (!bin || bin->last.model == 0.0);
    }
  }
  if (is_relative) {
    return;
  }
  const plot::ValueAxis axis =
      axis_of(fmt::format("{}, {}: flight, and the model", names_of(report, group),
                          report.channels[group.first].channel.unit),
              flight, model, width);
  flight.insert(flight.end(), model.begin(), model.end());
  page.panel(kHeight, axis, flight);
}

void add_residuals(TimePage& page, const ComparisonReport& report, const Group& group,
                   const std::vector<Bins>& bins) {
  constexpr double kHeight = 130.0;
  const double band = report.band_sigmas;
  std::vector<Curve> curves;
  double most = 0.0;
  for (std::size_t i = group.first; i < group.end; ++i) {
    curves.push_back(curve_of_bins(report.channels[i].channel.name, colour_of(group, i), bins[i],
                                   [](const Bin& bin) { return bin.most_sigmas; }));
    for (const auto& bin : bins[i]) {
      most = bin ? std::max(most, std::abs(bin->most_sigmas)) : most;
    }
  }
  const double high = std::clamp(1.1 * most, 1.4 * band, 4.0 * band);
  page.panel(
      kHeight,
      plot::linear_axis(fmt::format("{}: flight minus model, in sigma{}", names_of(report, group),
                                    most > high ? " (what is beyond stands at the end)" : ""),
                        -high, high, kTicks),
      curves,
      {{.name = "band", .colour = plot::kGrey, .value = band},
       {.name = "", .colour = plot::kGrey, .value = -band}});
}

std::vector<plot::Mark> marks_of(const ComparisonReport& report) {
  std::vector<plot::Mark> marks;
  for (const ChannelComparison& compared : report.channels) {
    if (compared.departure) {
      marks.push_back({compared.departure->since, compared.channel.name});
    }
  }
  std::stable_sort(marks.begin(), marks.end(),
                   [](const plot::Mark& a, const plot::Mark& b) { return a.t < b.t; });
  return marks;
}

}  // namespace

std::string plot_of(const ComparisonReport& report, const std::vector<ComparedSample>& samples) {
  const Grid grid = grid_of(report, samples);
  const std::vector<Bins> bins = bins_of(report, samples, grid);
  TimePage page{report.spacecraft_id + ": flight against the ground model",
                "model: " + shown(report.model.filename().string()) +
                    "; dotted lines: since when a channel is away",
                grid.times(), marks_of(report)};
  for (const Group& group : groups_of(report)) {
    add_values(page, report, group, bins);
    add_residuals(page, report, group, bins);
  }
  return page.document({});
}

}  // namespace spindrift
