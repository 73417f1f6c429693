#include "services/reports/time_page.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <utility>

#include "pipelines/time/utc.h"
#include "services/reports/colours.h"

namespace spindrift::plot {
namespace {

constexpr double kLeft = 92.0;
constexpr double kRight = 1010.0;
constexpr double kFirstPanel = 66.0;
constexpr double kPanelTitle = 20.0;
constexpr double kBetweenPanels = 18.0;
constexpr double kLineOfText = 15.0;
constexpr double kLetter = 6.6;      // Approximate width of a letter, px.
constexpr double kNameLetter = 7.4;  // Width of a letter in the name of a curve.
constexpr double kNameGap = 8.0;
constexpr double kBar = 16.0;
constexpr double kBetweenBars = 5.0;
constexpr double kSeam = 0.7;  // Gap between states of the same colour, px.
constexpr int kMostTimes = 9;

int digits_at(std::string_view text, std::size_t begin) {
  int number = 0;
  std::from_chars(text.data() + begin, text.data() + begin + 2, number);
  return number;
}

double second_of_day(TaiTime t) {
  const std::string utc = format_utc(t, 0);
  return 3600.0 * digits_at(utc, 11) + 60.0 * digits_at(utc, 14) + digits_at(utc, 17);
}

std::vector<TaiTime> round_times(TaiTime from, TaiTime to, double step_s) {
  const double second = second_of_day(from);
  TaiTime t = shifted(from, step_s * std::ceil(second / step_s) - second);
  std::vector<TaiTime> times;
  for (; t <= to; t = shifted(t, step_s)) {
    times.push_back(t);
  }
  return times;
}

/// Spreads the base lines of names, from above: at least a line apart and all above `lowest`.
void spread(std::vector<double>& heights, double lowest) {
  double limit = lowest;
  for (std::size_t i = heights.size(); i-- > 0;) {
    heights[i] = std::min(heights[i], limit);
    limit = heights[i] - kLineOfText;
  }
}

}  // namespace

Range range_of(const std::vector<Curve>& curves, double low, double high) {
  Range range{.low = low, .high = high};
  for (const Curve& curve : curves) {
    for (const auto& value : curve.values) {
      range.low = std::min(range.low, value.value_or(low));
      range.high = std::max(range.high, value.value_or(high));
    }
  }
  return range;
}

TimePage::TimePage(std::string title, std::string_view subtitle, std::vector<TaiTime> times,
                   std::vector<Mark> marks)
    : title_{std::move(title)},
      times_{std::move(times)},
      marks_{std::move(marks)},
      x_{Scale::linear(0.0, seconds_between(times_.front(), times_.back()), kLeft, kRight)},
      tick_step_s_{time_step_s(seconds_between(times_.front(), times_.back()) / kMostTimes)},
      ticks_{round_times(times_.front(), times_.back(), tick_step_s_)},
      top_{kFirstPanel} {
  svg_.text({kLeft, 26.0}, title_, {.colour = kInk, .size = 17.0, .bold = true});
  svg_.text({kLeft, 45.0}, subtitle, {.colour = kFaint, .size = 12.0});
}

double TimePage::x_of(TaiTime t) const { return x_.pixel_of(seconds_between(times_.front(), t)); }

void TimePage::frame(std::string_view title, double height) {
  svg_.text({kLeft, top_ + 12.0}, title, {.colour = kInk, .bold = true});
  top_ += kPanelTitle;
  bottom_ = top_ + height;
  for (const TaiTime t : ticks_) {
    svg_.line({x_of(t), top_}, {x_of(t), bottom_}, {.colour = kGrid});
  }
}

void TimePage::panel(double height, const ValueAxis& axis, const std::vector<Curve>& curves,
                     const std::vector<Limit>& limits) {
  frame(axis.title, height);
  const Scale y = axis.scale(bottom_, top_);
  for (const double tick : axis.ticks) {
    const double at = y.pixel_of(tick);
    svg_.line({kLeft, at}, {kRight, at}, {.colour = kGrid});
    svg_.text({kLeft - 7.0, at + 4.0}, fmt::format("{:.6g}", tick),
              {.colour = kFaint, .size = 11.0, .anchor = Anchor::End});
  }
  for (const Limit& limit : limits) {
    const double at = y.pixel_of(limit.value);
    svg_.line({kLeft, at}, {kRight, at}, {.colour = limit.colour, .dashes = "5 4"});
  }
  draw_marks();
  for (const Curve& curve : curves) {
    draw_band(curve, y);
    draw_curve(curve, y);
  }
  for (const Limit& limit : limits) {
    svg_.text({kLeft + 6.0, y.pixel_of(limit.value) - 4.0}, limit.name,
              {.colour = limit.colour, .size = 11.0});
  }
  name_curves(curves, y);
  const std::vector<Point> outline = {
      {kLeft, top_}, {kRight, top_}, {kRight, bottom_}, {kLeft, bottom_}, {kLeft, top_}};
  svg_.polyline(outline, {.colour = kFrame});
  top_ = bottom_ + kBetweenPanels;
}

/// Draws the marks, their names to the right, or below each other where there is no room.
void TimePage::draw_marks() {
  double free_from = kLeft;
  double height = top_ + kLineOfText;
  for (const Mark& mark : marks_) {
    const double at = x_of(mark.t);
    const double width = static_cast<double>(mark.name.size()) * kLetter + 8.0;
    svg_.line({at, top_}, {at, bottom_}, {.colour = kFaint, .dashes = "2 3"});
    height = at < free_from ? height + kLineOfText : top_ + kLineOfText;
    free_from = std::max(free_from, at + width);
    const bool fits = at + width < kRight;
    svg_.text({at + (fits ? 4.0 : -4.0), height}, mark.name,
              {.colour = kInk, .size = 11.0, .anchor = fits ? Anchor::Start : Anchor::End});
  }
}

void TimePage::draw_band(const Curve& curve, const Scale& y) {
  std::vector<Point> above;
  std::vector<Point> below;
  const auto finish_piece = [&] {
    above.insert(above.end(), below.rbegin(), below.rend());
    if (!above.empty()) {
      svg_.area(above, curve.colour);
    }
    above.clear();
    below.clear();
  };
  for (std::size_t i = 0; i < curve.half_widths.size(); ++i) {
    if (const auto& value = curve.values.at(i)) {
      above.push_back({x_of(times_[i]), y.pixel_of(*value + curve.half_widths[i])});
      below.push_back({x_of(times_[i]), y.pixel_of(*value - curve.half_widths[i])});
    } else {
      finish_piece();
    }
  }
  finish_piece();
}

void TimePage::draw_curve(const Curve& curve, const Scale& y) {
  std::vector<Point> piece;
  const auto finish_piece = [&] {
    if (piece.size() > 1) {
      svg_.polyline(piece, {.colour = curve.colour, .width = 2.0, .dashes = curve.dashes});
    } else if (!piece.empty()) {
      svg_.dot(piece.front(), 1.5, curve.colour);
    }
    piece.clear();
  };
  for (std::size_t i = 0; i < times_.size(); ++i) {
    if (curve.values.at(i)) {
      piece.push_back({x_of(times_[i]), y.pixel_of(*curve.values[i])});
    } else {
      finish_piece();
    }
  }
  finish_piece();
}

void TimePage::name_curves(const std::vector<Curve>& curves, const Scale& y) {
  struct Name {
    double height;
    const Curve* curve;
    std::string text;
  };
  std::vector<Name> names;
  for (const Curve& curve : curves) {
    if (curve.name.empty()) {
      continue;
    }
    const auto last = std::find_if(curve.values.rbegin(), curve.values.rend(),
                                   [](const auto& value) { return value.has_value(); });
    const bool none = last == curve.values.rend();
    names.push_back({.height = none ? bottom_ : y.pixel_of(**last) + 4.0,
                     .curve = &curve,
                     .text = curve.name + (none ? ": none" : "")});
  }
  std::stable_sort(names.begin(), names.end(),
                   [](const Name& a, const Name& b) { return a.height < b.height; });
  std::vector<double> heights;
  double limit = top_ + 8.0;
  for (const Name& name : names) {
    heights.push_back(std::max(name.height, limit));
    limit = heights.back() + kLineOfText;
  }
  spread(heights, bottom_);
  for (std::size_t i = 0; i < names.size(); ++i) {
    // A name that is too long for the margin begins within the panel.
    const double end = kRight + kNameGap + kNameLetter * static_cast<double>(names[i].text.size());
    const bool fits = end < kPageWidth;
    svg_.text({fits ? kRight + kNameGap : kPageWidth - kNameGap, heights[i]}, names[i].text,
              {.colour = names[i].curve->colour, .anchor = fits ? Anchor::Start : Anchor::End});
  }
}

void TimePage::bars(std::string_view title, const std::vector<Bar>& bars) {
  frame(title, kBetweenBars + static_cast<double>(bars.size()) * (kBar + kBetweenBars));
  double top = top_ + kBetweenBars;
  for (const Bar& bar : bars) {
    svg_.text({kLeft - 7.0, top + 12.0}, bar.name,
              {.colour = kInk, .size = 11.0, .anchor = Anchor::End});
    draw_bar(bar, top);
    top += kBar + kBetweenBars;
  }
  top_ = bottom_ + kBetweenPanels;
}

void TimePage::draw_bar(const Bar& bar, double top) {
  for (std::size_t first = 0; first + 1 < times_.size();) {
    const State& state = bar.states.at(first);
    std::size_t next = first + 1;
    while (next + 1 < times_.size() && bar.states.at(next) == state) {
      ++next;
    }
    const double left = x_of(times_[first]);
    const double right = x_of(times_[next]);
    if (!state.colour.empty()) {
      svg_.box({.left = left, .top = top, .right = right - kSeam, .bottom = top + kBar},
               state.colour);
    }
    if (!state.label.empty() &&
        static_cast<double>(state.label.size()) * kLetter < right - left - 4.0) {
      svg_.text({0.5 * (left + right), top + 12.0}, state.label,
                {.colour = kInk, .size = 11.0, .anchor = Anchor::Middle});
    }
    first = next;
  }
}

void TimePage::draw_times() {
  const bool seconds = tick_step_s_ < 60.0;
  std::string day;
  for (const TaiTime t : ticks_) {
    const std::string utc = format_utc(t, 0);
    svg_.line({x_of(t), bottom_}, {x_of(t), bottom_ + 5.0}, {.colour = kFrame});
    svg_.text({x_of(t), bottom_ + 19.0}, utc.substr(11, seconds ? 8 : 5),
              {.colour = kInk, .size = 11.0, .anchor = Anchor::Middle});
    if (utc.substr(0, 10) != day) {
      day = utc.substr(0, 10);
      svg_.text({x_of(t), bottom_ + 34.0}, day + " UTC",
                {.colour = kFaint, .size = 11.0, .anchor = Anchor::Middle});
    }
  }
}

void TimePage::draw_legend(const std::vector<State>& legend) {
  double left = kLeft;
  for (const State& entry : legend) {
    svg_.box({.left = left, .top = top_, .right = left + 12.0, .bottom = top_ + 12.0},
             entry.colour);
    svg_.text({left + 18.0, top_ + 10.5}, entry.label, {.colour = kInk, .size = 11.0});
    left += 36.0 + static_cast<double>(entry.label.size()) * kLetter;
  }
}

std::string TimePage::document(const std::vector<State>& legend) {
  draw_times();
  top_ = bottom_ + 48.0;
  draw_legend(legend);
  return svg_.document(kPageWidth, top_ + 28.0, title_);
}

}  // namespace spindrift::plot
