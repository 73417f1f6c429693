/// @file
/// A page of panels one above the other over a common time axis in UTC.

#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "pipelines/time/tai_time.h"
#include "services/reports/scale.h"
#include "services/reports/svg.h"

namespace spindrift::plot {

struct Curve {
  std::string name;  ///< Name beside the curve; empty: none.
  std::string_view colour;
  std::vector<std::optional<double>> values;  ///< Value at each time of the page; empty: a gap.
  std::string_view dashes = {};               ///< Dashes as in Stroke.
  /// Half-widths of a band about the curve at each time of the page; empty: there is no band.
  std::vector<double> half_widths = {};
};

/// Returns a curve with `value(each)` at each of `all`, which stand for the times of the page.
template <class All, class Value>
Curve curve_of(std::string name, std::string_view colour, const All& all, const Value& value) {
  Curve curve{.name = std::move(name), .colour = colour, .values = {}};
  for (const auto& each : all) {
    curve.values.push_back(value(each));
  }
  return curve;
}

struct Range {
  double low;
  double high;
};
/// Returns the range of all values; its lower end is at most `low`, its upper end at least `high`.
Range range_of(const std::vector<Curve>& curves, double low, double high);

/// An instant that is shown in all panels.
struct Mark {
  TaiTime t;
  std::string name;
};

/// State of a bar from one time of the page to the next.
struct State {
  std::string_view colour;  ///< Colour; empty: nothing is drawn.
  std::string label = {};   ///< Label, written where there is room.
  friend bool operator==(const State&, const State&) = default;
};

struct Bar {
  std::string name;
  std::vector<State> states;
};

class TimePage {
 public:
  /// @param times Times in order, at least two.
  /// @param marks Marks in order, within the times.
  TimePage(std::string title, std::string_view subtitle, std::vector<TaiTime> times,
           std::vector<Mark> marks = {});

  void panel(double height, const ValueAxis& axis, const std::vector<Curve>& curves,
             const std::vector<Limit>& limits = {});
  void bars(std::string_view title, const std::vector<Bar>& bars);

  /// Returns the document, with the times and the legend of the bars below the panels.
  std::string document(const std::vector<State>& legend);

 private:
  double x_of(TaiTime t) const;
  void frame(std::string_view title, double height);
  void draw_marks();
  void draw_band(const Curve& curve, const Scale& y);
  void draw_curve(const Curve& curve, const Scale& y);
  void name_curves(const std::vector<Curve>& curves, const Scale& y);
  void draw_bar(const Bar& bar, double top);
  void draw_times();
  void draw_legend(const std::vector<State>& legend);

  std::string title_;
  std::vector<TaiTime> times_;
  std::vector<Mark> marks_;
  Svg svg_;
  Scale x_;
  double tick_step_s_;
  std::vector<TaiTime> ticks_;
  double top_;           ///< Top of the next panel, px.
  double bottom_ = 0.0;  ///< Bottom of the last panel, px.
};

}  // namespace spindrift::plot
