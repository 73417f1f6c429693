/// @file
/// Panels one above the other over the same time in UTC.

#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "pipelines/time/tai_time.h"
#include "services/reports/axis.h"
#include "services/reports/scale.h"
#include "services/reports/svg.h"

namespace spindrift::plot {

struct Curve {
  std::string name;  ///< Beside it; empty: none.
  std::string_view colour;
  std::vector<std::optional<double>> values;  ///< One for each time of the page; empty: a gap.
  std::string_view dashes = {};               ///< As of Stroke.
  /// Of a band about the curve, one for each time of the page; empty: there is no band.
  std::vector<double> half_widths = {};
};

/// An instant that is shown in all panels.
struct Mark {
  TaiTime t;
  std::string name;
};

/// One state for each time of the page; it lasts until the next.
struct State {
  std::string_view colour;  ///< Empty: nothing is drawn.
  std::string label = {};   ///< Written where there is room.
  friend bool operator==(const State&, const State&) = default;
};

struct Bar {
  std::string name;
  std::vector<State> states;
};

class TimePage {
 public:
  /// @param times In order, two at least.
  /// @param marks In order, within the times.
  TimePage(std::string title, std::string_view subtitle, std::vector<TaiTime> times,
           std::vector<Mark> marks = {});

  void panel(double height, const ValueAxis& axis, const std::vector<Curve>& curves,
             const std::vector<Limit>& limits = {});
  void bars(std::string_view title, const std::vector<Bar>& bars);

  /// Below the panels the times, and what the colours of the bars mean.
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
  double top_;           ///< Of what comes next.
  double bottom_ = 0.0;  ///< Of the panel drawn last.
};

}  // namespace spindrift::plot
