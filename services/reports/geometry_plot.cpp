#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>
#include <string_view>
#include <vector>

#include "pipelines/spin/measurement/measurement.h"
#include "pipelines/spin/sensor_model/geometry.h"
#include "services/base/degrees.h"
#include "services/reports/colours.h"
#include "services/reports/planned_pass.h"
#include "services/reports/time_page.h"

namespace spindrift {
namespace {

using plot::Bar;
using plot::Curve;
using plot::curve_of;
using plot::State;
using plot::TimePage;

constexpr std::string_view kSun = plot::kOrange;
constexpr std::string_view kEarth = plot::kGreen;
constexpr std::string_view kNorth = plot::kBlue;
constexpr std::string_view kSouth = plot::kVermilion;
constexpr std::string_view kSeen = "#8fd0b5";
constexpr std::string_view kHalf = "#f5d58a";
constexpr std::string_view kSpoilt = "#e58f7b";
constexpr std::string_view kNothing = "#eeeeee";

std::optional<double> deg(const std::optional<double>& angle_rad) {
  return angle_rad ? std::optional{*angle_rad * kDegPerRad} : std::nullopt;
}

void add_angles(TimePage& page, const PlannedPass& pass) {
  const auto angle = [&](const char* name, std::string_view colour, const auto& value) {
    return curve_of(name, colour, pass.plan.steps, value);
  };
  std::vector<Curve> curves = {
      angle("sun angle", kSun, [](const auto& s) { return deg(s.geometry.angles.sun_angle_rad); }),
      angle("earth angle", kEarth,
            [](const auto& s) { return deg(s.geometry.angles.earth_angle_rad); }),
      angle("Sun to Earth", plot::kGrey,
            [](const auto& s) { return deg(s.geometry.sun_earth_rad); }),
      angle("disc half-angle", plot::kGrey,
            [](const auto& s) { return deg(s.geometry.disc_rad); })};
  curves.back().dashes = "2 3";
  page.panel(170.0,
             {.title = "Angles, deg",
              .is_logarithmic = false,
              .low = 0.0,
              .high = 180.0,
              .ticks = {0.0, 30.0, 60.0, 90.0, 120.0, 150.0, 180.0}},
             curves);
}

std::vector<Curve> of_both_beams(
    const PlannedPass& pass,
    const std::function<std::optional<double>(const BeamGeometry&)>& value) {
  std::vector<Curve> curves;
  for (const Side side : kSides) {
    if (sensor_of(pass.config, side)) {
      curves.push_back(curve_of(
          side == Side::North ? "north" : "south", side == Side::North ? kNorth : kSouth,
          pass.plan.steps,
          [&](const PassStep& step) { return value(step.geometry.beams.at(index_of(side))); }));
    }
  }
  return curves;
}

void add_chords(TimePage& page, const PlannedPass& pass) {
  const std::vector<Curve> curves =
      of_both_beams(pass, [](const BeamGeometry& beam) { return deg(beam.chord_rad); });
  const double high = 1.05 * range_of(curves, 0.0, 1.0).high;
  page.panel(130.0, plot::linear_axis("Chord across the Earth, deg", 0.0, high, 5), curves);
}

void add_delta(TimePage& page, const PlannedPass& pass) {
  const SpinGeometry& limits = pass.config.geometry;
  page.panel(130.0, plot::logarithmic_axis("|Delta|, of a fix by one chord", 1e-3, 1.0),
             of_both_beams(pass,
                           [](const BeamGeometry& beam) {
                             return beam.delta ? std::optional{std::abs(*beam.delta)}
                                               : std::nullopt;
                           }),
             {{.name = fmt::format("usable from {}", limits.determinant_usable),
               .colour = plot::kGrey,
               .value = limits.determinant_usable},
              {.name = fmt::format("ambiguous up to {}", limits.determinant_ambiguous),
               .colour = plot::kGrey,
               .value = limits.determinant_ambiguous}});
}

void add_sigma(TimePage& page, const PlannedPass& pass) {
  const std::vector<Curve> curves = {
      curve_of("fix of one turn", plot::kGrey, pass.plan.steps,
               [](const PassStep& step) { return deg(step.geometry.fix.sigma_rad); }),
      curve_of("all edges so far", kNorth, pass.plan.steps,
               [](const PassStep& step) { return deg(step.sigma_rad); }),
      curve_of("noise alone", kEarth, pass.plan.steps,
               [](const PassStep& step) { return deg(step.noise_sigma_rad); })};
  const auto [least, most] = range_of(curves, 0.1, 1.0);
  const double low = std::pow(10.0, std::floor(std::log10(least)));
  const double high = std::pow(10.0, std::ceil(std::log10(most)));
  page.panel(180.0,
             plot::logarithmic_axis("Sigma of the axis to expect (both directions together), deg",
                                    low, high),
             curves);
}

State state_of(const PassGeometry& geometry, PulseChannel channel) {
  const Revolution& turn = geometry.expected.revolution;
  if (!turn.edge(channel)) {
    return {.colour = kNothing};
  }
  return {.colour = turn.good_edge(channel) ? kSeen : kSpoilt};
}

State state_of(const PassGeometry& geometry, Side side) {
  const BeamSight view = geometry.beams.at(index_of(side)).view;
  if (view == BeamSight::NearTangent) {
    return {.colour = kHalf};
  }
  const State in = state_of(geometry, kInChannels.at(index_of(side)));
  const State out = state_of(geometry, kOutChannels.at(index_of(side)));
  return in.colour == kSpoilt ? in : out;
}

State fix_state(const PassGeometry& geometry) {
  const FixGeometry& fix = geometry.fix;
  State state{.colour = kNothing, .label = fmt::format("case {}", fix.geometry_case)};
  if (fix.axes > 0) {
    state.colour = fix.told_apart ? kSeen : kHalf;
  } else if (in_line(geometry.sun_earth_rad)) {
    state.label = "Sun, Earth in line";
  }
  return state;
}

Bar bar_of(const PlannedPass& pass, std::string name,
           const std::function<State(const PassGeometry&)>& state) {
  Bar bar{.name = std::move(name), .states = {}};
  for (const PassStep& step : pass.plan.steps) {
    bar.states.push_back(state(step.geometry));
  }
  return bar;
}

void add_bars(TimePage& page, const PlannedPass& pass) {
  page.bars(
      "What each sensor sees, and the fix of one turn",
      {bar_of(pass, "sun slit 1", [](const auto& g) { return state_of(g, PulseChannel::Sun1); }),
       bar_of(pass, "sun slit 2", [](const auto& g) { return state_of(g, PulseChannel::Sun2); }),
       bar_of(pass, "north beam", [](const auto& g) { return state_of(g, Side::North); }),
       bar_of(pass, "south beam", [](const auto& g) { return state_of(g, Side::South); }),
       bar_of(pass, "fix", fix_state)});
}

}  // namespace

std::string plot_of(const PlannedPass& pass) {
  std::vector<TaiTime> times;
  for (const PassStep& step : pass.plan.steps) {
    times.push_back(step.geometry.t);
  }
  TimePage page{fmt::format("{}: geometry of the pass", pass.spacecraft_id), title_of(pass),
                std::move(times)};
  add_angles(page, pass);
  add_chords(page, pass);
  add_delta(page, pass);
  add_sigma(page, pass);
  add_bars(page, pass);
  return page.document({{.colour = kSeen, .label = "seen; one axis"},
                        {.colour = kHalf, .label = "grazes the limb; several axes"},
                        {.colour = kSpoilt, .label = "spoilt by interference"},
                        {.colour = kNothing, .label = "not seen; no fix"}});
}

}  // namespace spindrift
