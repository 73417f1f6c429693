#include "services/reports/svg.h"

#include <fmt/format.h>

namespace spindrift::plot {
namespace {

std::string escaped(std::string_view text) {
  std::string safe;
  for (const char c : text) {
    switch (c) {
      case '&':
        safe += "&amp;";
        break;
      case '<':
        safe += "&lt;";
        break;
      case '>':
        safe += "&gt;";
        break;
      case '"':
        safe += "&quot;";
        break;
      default:
        // XML allows no other control characters, escaped or not.
        safe += static_cast<unsigned char>(c) < ' ' && c != '\n' && c != '\t' ? '?' : c;
    }
  }
  return safe;
}

std::string attributes(const Stroke& stroke) {
  std::string text =
      fmt::format(R"(stroke="{}" stroke-width="{:.4g}")", stroke.colour, stroke.width);
  if (!stroke.dashes.empty()) {
    text += fmt::format(R"( stroke-dasharray="{}")", stroke.dashes);
  }
  return text;
}

std::string listed(std::span<const Point> points) {
  std::string text;
  for (const Point& point : points) {
    text += fmt::format("{:.1f},{:.1f} ", point.x, point.y);
  }
  return text;
}

std::string_view name_of(Anchor anchor) {
  switch (anchor) {
    case Anchor::Start:
      return "start";
    case Anchor::Middle:
      return "middle";
    case Anchor::End:
      return "end";
  }
  return {};
}

}  // namespace

void Svg::line(const Point& from, const Point& to, const Stroke& stroke) {
  body_ += fmt::format("<line x1=\"{:.1f}\" y1=\"{:.1f}\" x2=\"{:.1f}\" y2=\"{:.1f}\" {}/>\n",
                       from.x, from.y, to.x, to.y, attributes(stroke));
}

void Svg::polyline(std::span<const Point> points, const Stroke& stroke) {
  body_ += fmt::format("<polyline points=\"{}\" fill=\"none\" stroke-linejoin=\"round\" {}/>\n",
                       listed(points), attributes(stroke));
}

void Svg::area(std::span<const Point> outline, std::string_view fill) {
  body_ += fmt::format("<polygon points=\"{}\" fill=\"{}\" fill-opacity=\"0.25\"/>\n",
                       listed(outline), fill);
}

void Svg::dot(const Point& centre, double radius, std::string_view colour) {
  body_ += fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"{:.1f}\" fill=\"{}\"/>\n", centre.x,
                       centre.y, radius, colour);
}

void Svg::box(const Box& box, std::string_view fill) {
  body_ += fmt::format(
      "<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.1f}\" fill=\"{}\"/>\n",
      box.left, box.top, box.right - box.left, box.bottom - box.top, fill);
}

void Svg::text(const Point& at, std::string_view text, const TextStyle& style) {
  const std::string turned =
      style.upwards ? fmt::format(" transform=\"rotate(-90 {:.1f} {:.1f})\"", at.x, at.y) : "";
  body_ += fmt::format(
      "<text x=\"{:.1f}\" y=\"{:.1f}\" font-size=\"{:.4g}\" fill=\"{}\" text-anchor=\"{}\"{}{}>"
      "{}</text>\n",
      at.x, at.y, style.size, style.colour, name_of(style.anchor),
      style.bold ? " font-weight=\"bold\"" : "", turned, escaped(text));
}

std::string Svg::document(double width, double height, std::string_view title) const {
  return fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0:.0f}\" height=\"{1:.0f}\" "
      "viewBox=\"0 0 {0:.0f} {1:.0f}\" font-family=\"DejaVu Sans, Helvetica, Arial, sans-serif\">\n"
      "<title>{2}</title>\n"
      "<style>text {{ paint-order: stroke; stroke: #ffffff; stroke-width: 3px; }}</style>\n"
      "<rect width=\"100%\" height=\"100%\" fill=\"#ffffff\"/>\n{3}</svg>\n",
      width, height, escaped(title), body_);
}

}  // namespace spindrift::plot
