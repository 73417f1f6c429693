/// @file
/// A page of scalable vector graphics: shapes and text in pixels, x to the right, y down.
///
/// A document is complete in itself, without script, font or link, and prints at any size. PNG was
/// rejected, because it needs a rasteriser and fonts. In all plots names stand beside their curves,
/// not in a legend.

#pragma once

#include <span>
#include <string>
#include <string_view>

namespace spindrift::plot {

struct Point {
  double x;
  double y;
};

struct Box {
  double left;
  double top;
  double right;
  double bottom;
};

struct Stroke {
  std::string_view colour;  ///< Colour as "#rrggbb".
  double width = 1.0;
  std::string_view dashes = {};  ///< Dashes, e.g. "4 3": four pixels on, three off; empty: solid.
};

enum class Anchor { Start, Middle, End };

struct TextStyle {
  std::string_view colour = "#333333";
  double size = 12.0;
  Anchor anchor = Anchor::Start;
  bool bold = false;
  bool upwards = false;  ///< Text runs upwards.
};

inline constexpr double kPageWidth = 1180.0;  ///< Width of every page, px.

class Svg {
 public:
  void line(const Point& from, const Point& to, const Stroke& stroke);
  void polyline(std::span<const Point> points, const Stroke& stroke);
  /// Fills an area half-transparently.
  void area(std::span<const Point> outline, std::string_view fill);
  void dot(const Point& centre, double radius, std::string_view colour);
  void box(const Box& box, std::string_view fill);
  /// @param at Left end (middle, right end, by the anchor) of the base line.
  void text(const Point& at, std::string_view text, const TextStyle& style);

  /// Returns the whole document with the given size.
  /// @param title Title for programs that do not show the picture; any text.
  std::string document(double width, double height, std::string_view title) const;

 private:
  std::string body_;
};

}  // namespace spindrift::plot
