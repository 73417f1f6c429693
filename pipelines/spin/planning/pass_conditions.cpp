#include "pipelines/spin/planning/pass_conditions.h"

#include <optional>
#include <string>

#include "pipelines/spin/measurement/measurement.h"

namespace spindrift {
namespace {

using enum PassConditionCode;

NamedValue beam_value(Side side) {
  return {"beam", std::string{side == Side::North ? "north" : "south"}};
}

std::optional<PassConditionCode> beam_code(BeamSight view) {
  switch (view) {
    case BeamSight::NoSensor:
      return std::nullopt;
    case BeamSight::Misses:
      return BeamMisses;
    case BeamSight::NearTangent:
      return BeamNearTangent;
    case BeamSight::Crosses:
      return BeamCrosses;
    case BeamSight::Inside:
      return BeamInside;
  }
  return std::nullopt;
}

std::optional<PassCondition> chord_condition(const SpinGeometry& limits, Side side, double delta) {
  switch (class_of(limits, delta)) {
    case DeltaClass::Usable:
      return std::nullopt;
    case DeltaClass::TwoRoots:
      return PassCondition{ChordTwoRoots,
                           {beam_value(side), {"determinant_usable", limits.determinant_usable}}};
    case DeltaClass::Ambiguous:
      return PassCondition{
          ChordAmbiguous,
          {beam_value(side), {"determinant_ambiguous", limits.determinant_ambiguous}}};
  }
  return std::nullopt;
}

std::optional<PassConditionCode> sun_code(const PassGeometry& geometry) {
  const Revolution& turn = geometry.expected.revolution;
  if (geometry.sun_hidden) {
    return SunHidden;
  }
  if (!turn.edge(PulseChannel::Sun1)) {
    return SunNearAxis;
  }
  return turn.edge(PulseChannel::Sun2) ? std::nullopt : std::optional{SunOutsideSlit2};
}

PassConditionCode cone_code(int geometry_case) {
  switch (geometry_case) {
    case 8:
      return NoFixBothChords;
    case 9:
      return NoFixSunAngle;
    case 10:
      return NoFixOneChord;
    default:
      return NoFixNothing;
  }
}

PassConditionCode fix_code(const PassGeometry& geometry) {
  const FixGeometry& fix = geometry.fix;
  if (fix.geometry_case < 1 || fix.geometry_case > 7) {
    return cone_code(fix.geometry_case);
  }
  if (geometry.in_line) {
    return NoFixInLine;
  }
  if (fix.axes == 0) {
    return NoFixNoise;
  }
  return fix.told_apart ? OneAxis : SeveralAxes;
}

}  // namespace

std::vector<PassCondition> conditions_of(const SpinConfig& config, const PassGeometry& geometry) {
  std::vector<PassCondition> conditions{
      {fix_code(geometry), {{"geometry_case", std::int64_t{geometry.fix.geometry_case}}}}};
  if (const auto sun = sun_code(geometry)) {
    conditions.push_back({*sun});
  }
  if (geometry.in_line) {
    conditions.push_back({InLine});
  }
  for (const Side side : kSides) {
    const BeamGeometry& beam = geometry.beams.at(index_of(side));
    if (const auto view = beam_code(beam.view)) {
      conditions.push_back({*view, {beam_value(side)}});
    }
    if (beam.delta) {
      if (auto chord = chord_condition(config.geometry, side, *beam.delta)) {
        conditions.push_back(*std::move(chord));
      }
    }
  }
  for (const ColocatedChannels& channels : geometry.expected.meeting) {
    conditions.push_back({ChannelsMeet,
                          {{"one", std::string{name_of(channels.one)}},
                           {"other", std::string{name_of(channels.other)}}}});
  }
  return conditions;
}

}  // namespace spindrift
