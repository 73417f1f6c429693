#include <fmt/format.h>

#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>
#include <string_view>

#include "pipelines/spin/measurement/measurement.h"
#include "pipelines/time/utc.h"
#include "services/base/decimals.h"
#include "services/base/degrees.h"
#include "services/base/filled.h"
#include "services/reports/planned_pass.h"

namespace spindrift {
namespace {

constexpr std::string_view kEdgeMarks = "12NnSs";  // Marks in the order of PulseChannel.

constexpr std::string_view kLegend =
    "angles and sigma in deg. s-e: between Sun and Earth; rho: half-angle of the Earth's disc;\n"
    "Delta: ? two roots to tell apart, ! ambiguous; edges: sun 1 2, in and out of north N n and\n"
    "south S s, x spoilt by interference; case: * several axes; sigma: both directions together,\n"
    "1 turn: of the fix that one turn gives, all: after all edges so far, noise: the part of it "
    "that\n"
    "would be left if the mission file were exact ([spin.alignment])\n";

using enum PassConditionCode;
constexpr std::array<Pattern<PassConditionCode>, kPassConditionCodes> kConditionPatterns{{
    {OneAxis, "fix by case {geometry_case}: one axis"},
    {SeveralAxes, "fix by case {geometry_case}: several axes, for a prior or time to tell apart"},
    {NoFixInLine, "no fix (case {geometry_case}): Sun and Earth in line"},
    {NoFixNoise, "no fix (case {geometry_case}): the noise leaves the axis open"},
    {NoFixBothChords,
     "no fix (case {geometry_case}): both chords without the Sun give a cone about the Earth"},
    {NoFixSunAngle,
     "no fix (case {geometry_case}): the sun angle alone gives a cone about the Sun"},
    {NoFixOneChord, "no fix (case {geometry_case}): a chord alone gives cones about the Earth"},
    {NoFixNothing, "no fix (case {geometry_case}): nothing that tells of the axis"},
    {SunHidden, "the Earth hides the Sun: no sun pulses"},
    {SunNearAxis, "the Sun stands too near the spin axis for either slit"},
    {SunOutsideSlit2, "slit 2 cannot see the Sun"},
    {InLine, "Sun and Earth in line, within 3 deg"},
    {BeamMisses, "{beam} beam misses the Earth"},
    {BeamNearTangent, "{beam} beam only grazes the Earth: no edge to rely on"},
    {BeamCrosses, "{beam} beam sees the Earth"},
    {BeamInside, "{beam} beam stays on the Earth all the turn: no edge"},
    {ChordTwoRoots,
     "|Delta| < {determinant_usable} ({beam}): a fix by its chord alone has two roots to tell "
     "apart"},
    {ChordAmbiguous,
     "|Delta| <= {determinant_ambiguous} ({beam}): a fix by its chord alone is ambiguous"},
    {ChannelsMeet, "interference: {one} and {other} meet"},
}};
static_assert(are_by_code(kConditionPatterns));

std::string_view name_of(BeamSight view) {
  switch (view) {
    case BeamSight::NoSensor:
      return "none";
    case BeamSight::Misses:
      return "misses";
    case BeamSight::NearTangent:
      return "grazes";
    case BeamSight::Crosses:
      return "crosses";
    case BeamSight::Inside:
      return "inside";
  }
  return {};
}

std::string_view name_of(DeltaClass delta) {
  switch (delta) {
    case DeltaClass::Usable:
      return "usable";
    case DeltaClass::TwoRoots:
      return "two_roots";
    case DeltaClass::Ambiguous:
      return "ambiguous";
  }
  return {};
}

enum class EdgeView { Absent, Interferes, Seen };

EdgeView view_of(const PassGeometry& geometry, PulseChannel channel) {
  const Revolution& turn = geometry.expected.revolution;
  if (!turn.edge(channel)) {
    return EdgeView::Absent;
  }
  return turn.good_edge(channel) ? EdgeView::Seen : EdgeView::Interferes;
}

std::string chord_text(const BeamGeometry& beam) {
  return beam.chord_rad ? fmt::format("{:.2f}", *beam.chord_rad * kDegPerRad)
                        : std::string{beam.view == BeamSight::NoSensor ? "-" : name_of(beam.view)};
}

std::string delta_text(const SpinGeometry& limits, const BeamGeometry& beam) {
  constexpr std::string_view kMarks = " ?!";
  return beam.delta ? fmt::format("{:+.4f}{}", *beam.delta,
                                  kMarks[static_cast<std::size_t>(class_of(limits, *beam.delta))])
                    : "- ";
}

std::string edges_text(const PassGeometry& geometry) {
  std::string text;
  for (std::size_t i = 0; i < kPulseChannels; ++i) {
    switch (view_of(geometry, static_cast<PulseChannel>(i))) {
      case EdgeView::Absent:
        text += '.';
        break;
      case EdgeView::Interferes:
        text += 'x';
        break;
      case EdgeView::Seen:
        text += kEdgeMarks[i];
        break;
    }
  }
  return text;
}

std::string sigma_text(const std::optional<double>& sigma_rad) {
  return sigma_rad ? to_its_digits(*sigma_rad * kDegPerRad, 4) : "-";
}

double minutes(const PlannedPass& pass, TaiTime t) {
  return seconds_between(pass.request.from, t) / 60.0;
}

std::string row(const PlannedPass& pass, const PassStep& step) {
  const PassGeometry& geometry = step.geometry;
  const auto& [north, south] = geometry.beams;
  const SpinGeometry& limits = pass.config.geometry;
  const auto deg = [](double angle_rad) { return angle_rad * kDegPerRad; };
  return fmt::format(
      "{:<20} {:7.1f} {:9.1f} {:7.2f} {:7.2f} {:7.2f} {:6.2f} {:8.2f} {:>7} {:>7} {:>8} {:>8}  {} "
      "{:>4}{} {:>8} {:>8} {:>8}\n",
      format_utc(geometry.t, 0), minutes(pass, geometry.t), geometry.range_km,
      deg(geometry.angles.sun_angle_rad), deg(geometry.angles.earth_angle_rad),
      deg(geometry.sun_earth_rad), deg(geometry.disc_rad), deg(geometry.angles.dihedral_rad),
      chord_text(north), chord_text(south), delta_text(limits, north), delta_text(limits, south),
      edges_text(geometry), geometry.fix.geometry_case,
      geometry.fix.axes > 0 && !geometry.fix.told_apart ? '*' : ' ',
      sigma_text(geometry.fix.sigma_rad), sigma_text(step.sigma_rad),
      sigma_text(step.noise_sigma_rad));
}

std::string event_text(const PlannedPass& pass, const PassEvent& event) {
  const auto utc = [](TaiTime t) { return format_utc(t, 0); };
  return event.from == pass.request.from && event.to == pass.request.to
             ? fmt::format("{:<43} {}\n", "all the time", sentence_of(event.condition))
             : fmt::format("{} to {}  {}\n", utc(event.from), utc(event.to),
                           sentence_of(event.condition));
}

nlohmann::json degrees_or_null(const std::optional<double>& angle_rad) {
  return angle_rad ? nlohmann::json(*angle_rad * kDegPerRad) : nlohmann::json(nullptr);
}

nlohmann::json to_json(const SpinGeometry& limits, const BeamGeometry& beam) {
  return {{"view", name_of(beam.view)},
          {"chord_deg", degrees_or_null(beam.chord_rad)},
          {"delta", beam.delta ? nlohmann::json(*beam.delta) : nlohmann::json(nullptr)},
          {"delta_class", beam.delta ? nlohmann::json(name_of(class_of(limits, *beam.delta)))
                                     : nlohmann::json(nullptr)}};
}

nlohmann::json edges_json(const PassGeometry& geometry) {
  nlohmann::json edges;
  for (std::size_t i = 0; i < kPulseChannels; ++i) {
    constexpr std::array<std::string_view, 3> kViews = {"absent", "interferes", "seen"};
    const auto channel = static_cast<PulseChannel>(i);
    edges[std::string{name_of(channel)}] =
        kViews.at(static_cast<std::size_t>(view_of(geometry, channel)));
  }
  return edges;
}

nlohmann::json to_json(const PlannedPass& pass, const PassStep& step) {
  const PassGeometry& geometry = step.geometry;
  const SpinGeometry& limits = pass.config.geometry;
  return {{"t_tai_ns", tai_ns(geometry.t)},
          {"utc", format_utc(geometry.t)},
          {"minutes", minutes(pass, geometry.t)},
          {"range_km", geometry.range_km},
          {"sun_angle_deg", geometry.angles.sun_angle_rad * kDegPerRad},
          {"earth_angle_deg", geometry.angles.earth_angle_rad * kDegPerRad},
          {"dihedral_deg", geometry.angles.dihedral_rad * kDegPerRad},
          {"sun_earth_deg", geometry.sun_earth_rad * kDegPerRad},
          {"disc_deg", geometry.disc_rad * kDegPerRad},
          {"sun_hidden", geometry.sun_hidden},
          {"in_line", geometry.in_line},
          {"north", to_json(limits, geometry.beams[index_of(Side::North)])},
          {"south", to_json(limits, geometry.beams[index_of(Side::South)])},
          {"edges", edges_json(geometry)},
          {"geometry_case", geometry.fix.geometry_case},
          {"axes", geometry.fix.axes},
          {"told_apart", geometry.fix.told_apart},
          {"fix_sigma_deg", degrees_or_null(geometry.fix.sigma_rad)},
          {"sigma_deg", degrees_or_null(step.sigma_rad)},
          {"noise_sigma_deg", degrees_or_null(step.noise_sigma_rad)}};
}

nlohmann::json to_json(const PassEvent& event) {
  return {{"from_tai_ns", tai_ns(event.from)},
          {"from_utc", format_utc(event.from)},
          {"to_tai_ns", tai_ns(event.to)},
          {"to_utc", format_utc(event.to)},
          {"what", sentence_of(event.condition)}};
}

}  // namespace

std::string sentence_of(const PassCondition& condition) {
  return filled(pattern_of(kConditionPatterns, condition.code), condition.values, 0);
}

std::string title_of(const PlannedPass& pass) {
  const auto [ra_deg, dec_deg] = place_deg(pass.request.axis_icrf);
  return fmt::format("{} to {}, axis RA {:.4f} Dec {:+.4f} deg, {:.6g} rpm{}",
                     format_utc(pass.request.from, 0), format_utc(pass.request.to, 0), ra_deg,
                     dec_deg, pass.request.rate_rad_s * kRpmPerRad_s,
                     pass.rate_assumed ? " (assumed, see --rpm)" : "");
}

std::string to_text(const PlannedPass& pass) {
  std::string text = fmt::format("{}  {}\n", pass.spacecraft_id, title_of(pass));
  text += fmt::format(
      "{:<20} {:>7} {:>9} {:>7} {:>7} {:>7} {:>6} {:>8} {:>7} {:>7} {:>8} {:>8}  {:<6} {:>4}  "
      "{:>8} {:>8} {:>8}\n",
      "UTC", "minutes", "range, km", "sun", "earth", "s-e", "rho", "dihedral", "chord N", "chord S",
      "Delta N ", "Delta S ", "edges", "case", "1 turn", "all", "noise");
  for (const PassStep& step : pass.plan.steps) {
    text += row(pass, step);
  }
  text += kLegend;
  for (const PassEvent& event : pass.plan.events) {
    text += event_text(pass, event);
  }
  return text;
}

nlohmann::json to_json(const PlannedPass& pass) {
  const auto [ra_deg, dec_deg] = place_deg(pass.request.axis_icrf);
  nlohmann::json json{{"spacecraft", pass.spacecraft_id},
                      {"ra_deg", ra_deg},
                      {"dec_deg", dec_deg},
                      {"rate_rpm", pass.request.rate_rad_s * kRpmPerRad_s},
                      {"rate_assumed", pass.rate_assumed},
                      {"from_utc", format_utc(pass.request.from)},
                      {"to_utc", format_utc(pass.request.to)},
                      {"step_s", pass.request.step_s},
                      {"determinant_usable", pass.config.geometry.determinant_usable},
                      {"determinant_ambiguous", pass.config.geometry.determinant_ambiguous},
                      {"steps", nlohmann::json::array()},
                      {"events", nlohmann::json::array()}};
  for (const PassStep& step : pass.plan.steps) {
    json["steps"].push_back(to_json(pass, step));
  }
  for (const PassEvent& event : pass.plan.events) {
    json["events"].push_back(to_json(event));
  }
  return json;
}

}  // namespace spindrift
