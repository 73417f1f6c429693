#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>

#include "pipelines/frames/angle.h"
#include "services/field_tables/study_report.h"
#include "services/reports/colours.h"
#include "services/reports/xy_panel.h"

namespace spindrift {
namespace {

using plot::Box;
using plot::Point;
using plot::Series;
using plot::XyPanel;

constexpr double kHeight = 560.0;
constexpr Box kWhole{.left = 90.0, .top = 60.0, .right = 1150.0, .bottom = 500.0};
constexpr std::array kOfAxis{plot::kBlue, plot::kGreen, plot::kVermilion};
constexpr std::array kOfKind{plot::kBlue, plot::kOrange, plot::kGreen};

std::string page_of(const XyPanel& panel) {
  plot::Svg svg;
  draw(panel, kWhole, svg);
  return svg.document(plot::kPageWidth, kHeight, panel.title);
}

struct Range {
  double low;
  double high;
};

Range range_of(const std::vector<Series>& series) {
  Range range{.low = 1e300, .high = -1e300};
  for (const Series& one : series) {
    for (const Point& point : one.points) {
      range = {.low = std::min(range.low, point.y), .high = std::max(range.high, point.y)};
    }
  }
  return range;
}

plot::ValueAxis decades_of(std::string title, const std::vector<Series>& series) {
  const auto [low, high] = range_of(series);
  return plot::logarithmic_axis(std::move(title), std::pow(10.0, std::floor(std::log10(low))),
                                std::pow(10.0, std::ceil(std::log10(high))));
}

plot::ValueAxis anomaly_axis() {
  return {.title = "true anomaly behind the first, deg",
          .is_logarithmic = false,
          .low = 0.0,
          .high = 360.0,
          .ticks = {0.0, 60.0, 120.0, 180.0, 240.0, 300.0, 360.0}};
}

plot::ValueAxis points_axis() { return plot::linear_axis("points", 0.0, kStudiedPoints.back(), 8); }

/// Returns a curve for each kind of table over its points.
std::vector<Series> by_points(const FieldStudy& study,
                              const std::function<double(const StudiedTable&)>& value) {
  std::vector<Series> series;
  for (const TableKind kind : kTableKinds) {
    Series one{.points = {},
               .colour = kOfKind.at(static_cast<std::size_t>(kind)),
               .dashes = kind == TableKind::Curvature ? "10 6" : ""};
    for (const StudiedTable& table : study.tables) {
      if (table.kind == kind) {
        one.points.push_back({static_cast<double>(table.points), value(table)});
      }
    }
    series.push_back(std::move(one));
  }
  return series;
}

constexpr const char* kKindColours = "uniform blue, curvature orange, Chebyshev green";
constexpr const char* kAxisColours = "x blue, y green, z red";

/// Like figure 4, with what a length costs.
std::string length_plot(const FieldStudy& study) {
  auto series = by_points(study, [](const StudiedTable& is) { return is.errors.mean_nt.sum(); });
  auto axis = decades_of("nT", series);
  return page_of({.title = "Length of a table and its mean error, sum of the axes",
                  .note = fmt::format("{}; 12 bytes a point, 16 by curvature", kKindColours),
                  .x = points_axis(),
                  .y = std::move(axis),
                  .series = std::move(series)});
}

/// Like figure 6.
std::string knots_plot(const FieldStudy& study) {
  std::vector<Series> series;
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    Series line{.points = {}, .colour = kOfAxis.at(static_cast<std::size_t>(axis))};
    for (const StudyPlace& place : study.places) {
      line.points.push_back({degrees(place.behind_first_rad), 1e-3 * place.field_orbit_nt[axis]});
    }
    Series dots{.points = {}, .colour = line.colour, .dot_px = 2.5};
    for (const double knot_rad : study.knots_rad) {
      const double at = knot_rad / kTurn_rad * static_cast<double>(study.places.size() - 1);
      const auto i = std::min(static_cast<std::size_t>(std::lround(at)), study.places.size() - 1);
      dots.points.push_back({degrees(knot_rad), line.points[i].y});
    }
    series.push_back(std::move(line));
    series.push_back(std::move(dots));
  }
  const auto [low, high] = range_of(series);
  const double room = 0.05 * (high - low);
  return page_of(
      {.title = fmt::format("Field in the orbit frame and {} knots by curvature", kChosenPoints),
       .note = kAxisColours,
       .x = anomaly_axis(),
       .y = plot::linear_axis("uT", low - room, high + room, 8),
       .series = std::move(series)});
}

/// Like figure 7.
std::string weight_plot(const FieldStudy& study) {
  Series error{.points = {}, .colour = plot::kOrange};
  for (const StudiedWeight& is : study.weights) {
    error.points.push_back({is.weight, is.mean_error_nt});
  }
  const auto [low, high] = range_of({error});
  const double least = std::min(low, study.uniform_error_nt);
  const double most = std::max(high, study.uniform_error_nt);
  return page_of(
      {.title =
           fmt::format("Mean error of {} points by the weight K of equal steps", kChosenPoints),
       .x = plot::logarithmic_axis("K", 0.01, 100.0),
       .y = plot::linear_axis("nT", 0.95 * least, 1.02 * most, 8),
       .series = {std::move(error)},
       .across = {
           {.name = "equal steps", .colour = plot::kBlue, .value = study.uniform_error_nt}}});
}

/// Like figure 9, all angles together.
std::string armse_plot(const FieldStudy& study) {
  auto series =
      by_points(study, [](const StudiedTable& is) { return degrees(is.armse_rad.norm()); });
  auto axis = decades_of("deg", series);
  return page_of({.title = "What a table moves the attitude by: ARMSE, all angles together",
                  .note = kKindColours,
                  .x = points_axis(),
                  .y = std::move(axis),
                  .series = std::move(series)});
}

/// Like figure 10.
std::string attitude_plot(const FieldStudy& study) {
  std::vector<Series> series;
  for (Eigen::Index angle = 0; angle < 3; ++angle) {
    Series with_table{.points = {}, .colour = kOfAxis.at(static_cast<std::size_t>(angle))};
    Series by_table{.points = {}, .colour = plot::kInk};
    for (const StudiedAttitude& at : study.attitudes) {
      const double deg = degrees(at.behind_first_rad);
      with_table.points.push_back({deg, degrees(at.with_table_rad[angle])});
      by_table.points.push_back(
          {deg, degrees(at.with_table_rad[angle] - at.with_field_rad[angle])});
    }
    series.push_back(std::move(with_table));
    series.push_back(std::move(by_table));
  }
  const auto [low, high] = range_of(series);
  const double most = 1.1 * std::max(-low, high);
  return page_of({.title = fmt::format("Attitude from Sun and field with {} points by curvature",
                                       kChosenPoints),
                  .note = "phi blue, theta green, psi red; the table's own share black",
                  .x = anomaly_axis(),
                  .y = plot::linear_axis("error, deg", -most, most, 8),
                  .series = std::move(series)});
}

}  // namespace

std::vector<StudyPlot> plots_of(const FieldStudy& study) {
  return {{.name = "length.svg", .svg = length_plot(study)},
          {.name = "knots.svg", .svg = knots_plot(study)},
          {.name = "weight.svg", .svg = weight_plot(study)},
          {.name = "armse.svg", .svg = armse_plot(study)},
          {.name = "attitude.svg", .svg = attitude_plot(study)}};
}

}  // namespace spindrift
