#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string_view>
#include <utility>
#include <vector>

#include "services/base/degrees.h"
#include "services/reports/colours.h"
#include "services/reports/xy_panel.h"
#include "services/simulation/flight_plot.h"

namespace spindrift {
namespace {

using plot::Point;
using plot::Series;
using plot::ValueAxis;

constexpr std::string_view kDesigned = plot::kBlue;
constexpr std::string_view kFlown = plot::kVermilion;
constexpr double kFirstRow = 118.0;
constexpr double kRow = 290.0;
constexpr double kPanelHeight = 200.0;
constexpr int kPoints = 300;

double decibel(double gain) { return 20.0 * std::log10(gain); }

/// Returns the range of a decade and a half on both sides of the crossover.
std::pair<double, double> frequencies_rad_s(const ChannelMargins& channel) {
  const double middle = channel.designed_margins.crossover_rad_s;
  const double span = std::pow(10.0, 1.5);
  return {middle / span, middle * span};
}

std::vector<BodePoint> bode_of(const ChannelLoop& loop, std::pair<double, double> range_rad_s) {
  double high = range_rad_s.second;
  if (loop.sampling) {
    high = std::min(high, 0.999 * std::numbers::pi / loop.sampling->period_s);
  }
  return bode(loop, range_rad_s.first, high, kPoints);
}

Series series_of(const std::vector<BodePoint>& points, std::string_view colour,
                 double (*value)(const BodePoint&)) {
  Series series{.points = {}, .colour = colour};
  for (const BodePoint& point : points) {
    series.points.push_back({point.frequency_rad_s, value(point)});
  }
  return series;
}

double gain_db(const BodePoint& point) { return decibel(point.gain); }
double phase_deg(const BodePoint& point) { return kDegPerRad * point.phase_rad; }

ValueAxis phase_axis() {
  return {.title = "phase, deg",
          .is_logarithmic = false,
          .low = -240.0,
          .high = -60.0,
          .ticks = {-240.0, -210.0, -180.0, -150.0, -120.0, -90.0, -60.0}};
}

std::string margins_text(const LoopMargins& margins) {
  return fmt::format(
      "phase margin {:.1f} deg, gain margin {}", kDegPerRad * margins.phase_rad,
      margins.gain ? fmt::format("{:.1f} dB", decibel(*margins.gain)) : std::string{"infinite"});
}

plot::XyPanel bode_panel(const ChannelMargins& channel, std::string title, std::string note,
                         ValueAxis y, plot::Limit limit, double (*value)(const BodePoint&)) {
  const auto range_rad_s = frequencies_rad_s(channel);
  const double low = y.low;
  plot::XyPanel panel{
      .title = std::move(title),
      .note = std::move(note),
      .x = plot::logarithmic_axis("frequency, rad/s", range_rad_s.first, range_rad_s.second),
      .y = std::move(y),
      .series = {series_of(bode_of(channel.designed, range_rad_s), kDesigned, value),
                 series_of(bode_of(channel.flown, range_rad_s), kFlown, value)},
      .across = {std::move(limit)}};
  // Dashed, because the second curve mostly covers the first.
  panel.series.back().dashes = "7 5";
  // Points below the panel would be drawn along its lower end.
  for (Series& series : panel.series) {
    std::erase_if(series.points, [low](const Point& point) { return point.y < low; });
  }
  return panel;
}

/// Returns a pole in the s plane: ln z / T for a sampled loop.
std::complex<double> in_s(std::complex<double> pole, const ChannelLoop& loop) {
  return loop.sampling ? std::log(pole) / loop.sampling->period_s : pole;
}

Series locus_of(const ChannelLoop& loop, const std::vector<double>& factors,
                std::string_view colour, double dot_px) {
  Series series{.points = {}, .colour = colour, .dashes = {}, .dot_px = dot_px};
  for (const LocusPoint& point : root_locus(loop, factors)) {
    for (const std::complex<double> pole : point.poles) {
      // A pole of the delay lies at 0 in the z plane, which is infinitely far away in the s plane.
      if (std::abs(pole) > 1e-9 || !loop.sampling) {
        const std::complex<double> s = in_s(pole, loop);
        series.points.push_back({s.real(), s.imag()});
      }
    }
  }
  return series;
}

plot::XyPanel locus_panel(const ChannelMargins& channel) {
  std::vector<double> factors;
  constexpr int kFactors = 200;
  constexpr double kLeast = 0.02;
  constexpr double kMost = 4.0;
  for (int i = 0; i <= kFactors; ++i) {
    factors.push_back(kLeast * std::pow(kMost / kLeast, static_cast<double>(i) / kFactors));
  }
  // Gain factors that stand for a fifth more, the designed, and a fifth less inertia.
  const std::vector<double> bodies = {1.0 / 1.2, 1.0, 1.0 / 0.8};
  const double size = 2.5 * std::abs(closed_loop_poles(channel.designed, 1.0).front());
  plot::XyPanel panel{
      .title = "Root locus",
      .note = fmt::format("gain by {} to {}; black: inertia 120, 100, 80 %", kLeast, kMost),
      .x = plot::linear_axis("real part, 1/s", -1.6 * size, 0.4 * size, 5),
      .y = plot::linear_axis("imaginary part, rad/s", -size, size, 5),
      .series = {locus_of(channel.designed, factors, kDesigned, 2.4),
                 locus_of(channel.flown, factors, kFlown, 1.0),
                 locus_of(channel.flown, bodies, plot::kInk, 3.0)}};
  panel.series.push_back(
      {.points = {{0.0, -size}, {0.0, size}}, .colour = "#999999", .dashes = "5 4"});
  for (Series& series : panel.series) {
    std::erase_if(series.points, [&](const Point& point) {
      return point.x < panel.x.low || point.x > panel.x.high || std::abs(point.y) > size;
    });
  }
  return panel;
}

plot::Box box_of(int row, int column) {
  constexpr double kLeft = 70.0;
  constexpr double kColumn = 380.0;
  constexpr double kPanelWidth = 300.0;
  const double left = kLeft + kColumn * column;
  const double top = kFirstRow + kRow * row;
  return {.left = left, .top = top, .right = left + kPanelWidth, .bottom = top + kPanelHeight};
}

std::string_view channel_name(int row) {
  constexpr std::array<std::string_view, 3> kNames = {"X, roll", "Y, pitch", "Z, yaw"};
  return kNames.at(static_cast<std::size_t>(row));
}

}  // namespace

std::string loop_plot(const std::string& spacecraft_id,
                      const std::array<ChannelMargins, 3>& channels) {
  plot::Svg svg;
  const std::string title = spacecraft_id + ": the loop about each axis";
  const LoopSampling& sampling = *channels.front().flown.sampling;
  svg.text({70.0, 28.0}, title, {.colour = plot::kInk, .size = 17.0, .bold = true});
  svg.text({70.0, 50.0}, "blue: as designed", {.colour = kDesigned});
  svg.text({320.0, 50.0},
           fmt::format("orange: as it is flown, every {:.4g} s, {} periods late", sampling.period_s,
                       sampling.periods_late),
           {.colour = kFlown});
  for (int row = 0; row < 3; ++row) {
    const ChannelMargins& channel = channels.at(static_cast<std::size_t>(row));
    draw(
        bode_panel(channel, fmt::format("{}: gain", channel_name(row)),
                   "designed: " + margins_text(channel.designed_margins),
                   plot::linear_axis("gain, dB", -40.0, 60.0, 5), {"", plot::kFaint, 0.0}, gain_db),
        box_of(row, 0), svg);
    draw(bode_panel(channel, "Phase", "flown: " + margins_text(channel.flown_margins), phase_axis(),
                    {"", plot::kFaint, -180.0}, phase_deg),
         box_of(row, 1), svg);
    draw(locus_panel(channel), box_of(row, 2), svg);
  }
  return svg.document(plot::kPageWidth, kFirstRow + 3.0 * kRow, title);
}

}  // namespace spindrift
