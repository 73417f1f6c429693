#include "services/reports/xy_panel.h"

#include <fmt/format.h>

#include "services/reports/colours.h"

namespace spindrift::plot {
namespace {

constexpr std::string_view kFilled = "#56b4e9";

void draw_axes(const XyPanel& panel, const Box& box, const Scale& x, const Scale& y, Svg& svg) {
  for (const double tick : panel.x.ticks) {
    const double at = x.pixel_of(tick);
    svg.line({at, box.top}, {at, box.bottom}, {.colour = kGrid});
    svg.text({at, box.bottom + 14.0}, fmt::format("{:.6g}", tick),
             {.colour = kFaint, .size = 10.0, .anchor = Anchor::Middle});
  }
  for (const double tick : panel.y.ticks) {
    const double at = y.pixel_of(tick);
    svg.line({box.left, at}, {box.right, at}, {.colour = kGrid});
    svg.text({box.left - 5.0, at + 4.0}, fmt::format("{:.6g}", tick),
             {.colour = kFaint, .size = 10.0, .anchor = Anchor::End});
  }
  svg.text({box.left, box.top - 20.0}, panel.title, {.colour = kInk, .bold = true});
  svg.text({box.left, box.top - 6.0}, panel.note, {.colour = kFaint, .size = 11.0});
  const double middle = 0.5 * (box.left + box.right);
  svg.text({middle, box.bottom + 28.0}, panel.x.title,
           {.colour = kInk, .size = 11.0, .anchor = Anchor::Middle});
  svg.text({box.left - 40.0, 0.5 * (box.top + box.bottom)}, panel.y.title,
           {.colour = kInk, .size = 11.0, .anchor = Anchor::Middle, .upwards = true});
}

void draw_series(const Series& series, const Scale& x, const Scale& y, Svg& svg) {
  std::vector<Point> line;
  for (const Point& point : series.points) {
    const Point at{x.pixel_of(point.x), y.pixel_of(point.y)};
    if (series.dot_px > 0.0) {
      svg.dot(at, series.dot_px, series.colour);
    } else {
      line.push_back(at);
    }
  }
  if (line.size() > 1) {
    svg.polyline(line, {.colour = series.colour, .width = 1.8, .dashes = series.dashes});
  }
}

}  // namespace

void draw(const XyPanel& panel, const Box& box, Svg& svg) {
  const Scale x = panel.x.scale(box.left, box.right);
  const Scale y = panel.y.scale(box.bottom, box.top);
  draw_axes(panel, box, x, y, svg);
  for (const Box& bar : panel.bars) {
    svg.box({.left = x.pixel_of(bar.left) + 0.5,
             .top = y.pixel_of(bar.top),
             .right = x.pixel_of(bar.right) - 0.5,
             .bottom = y.pixel_of(bar.bottom)},
            kFilled);
  }
  for (const Limit& limit : panel.across) {
    const double at = y.pixel_of(limit.value);
    svg.line({box.left, at}, {box.right, at}, {.colour = limit.colour, .dashes = "5 4"});
    svg.text({box.left + 4.0, at - 4.0}, limit.name, {.colour = limit.colour, .size = 10.0});
  }
  for (const Series& series : panel.series) {
    draw_series(series, x, y, svg);
  }
  const std::vector<Point> outline = {{box.left, box.top},
                                      {box.right, box.top},
                                      {box.right, box.bottom},
                                      {box.left, box.bottom},
                                      {box.left, box.top}};
  svg.polyline(outline, {.colour = kFrame});
}

}  // namespace spindrift::plot
