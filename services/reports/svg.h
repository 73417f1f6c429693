/// @file
/// A page of scalable vector graphics: shapes and text in pixels, x to the right, y down.

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
  std::string_view colour;  ///< "#rrggbb"
  double width = 1.0;
  std::string_view dashes = {};  ///< "4 3": four pixels, three without; empty: no gaps.
};

enum class Anchor { Start, Middle, End };

struct TextStyle {
  std::string_view colour = "#333333";
  double size = 12.0;
  Anchor anchor = Anchor::Start;
  bool bold = false;
  bool upwards = false;  ///< Read from below.
};

inline constexpr double kPageWidth = 1180.0;  ///< Of every page, px.

class Svg {
 public:
  void line(const Point& from, const Point& to, const Stroke& stroke);
  void polyline(std::span<const Point> points, const Stroke& stroke);
  /// Filled, so that what is below shows through.
  void area(std::span<const Point> outline, std::string_view fill);
  void dot(const Point& centre, double radius, std::string_view colour);
  void box(const Box& box, std::string_view fill);
  /// @param at Left end (middle, right end) of its base line.
  /// @param text Any.
  void text(const Point& at, std::string_view text, const TextStyle& style);

  /// The whole document, so large.
  /// @param title What programs say that do not show it; any text.
  std::string document(double width, double height, std::string_view title) const;

 private:
  std::string body_;
};

}  // namespace spindrift::plot
