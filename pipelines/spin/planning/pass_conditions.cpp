#include "pipelines/spin/planning/pass_conditions.h"

#include <fmt/format.h>

#include <cstddef>
#include <string_view>

#include "pipelines/spin/measurement/measurement.h"

namespace spindrift {
namespace {

std::string_view name_of(Side side) { return side == Side::North ? "north" : "south"; }

std::string beam_in_words(Side side, BeamView view) {
  switch (view) {
    case BeamView::NoSensor:
      return {};
    case BeamView::Misses:
      return fmt::format("{} beam misses the Earth", name_of(side));
    case BeamView::NearTangent:
      return fmt::format("{} beam only grazes the Earth: no edge to rely on", name_of(side));
    case BeamView::Crosses:
      return fmt::format("{} beam sees the Earth", name_of(side));
    case BeamView::Inside:
      return fmt::format("{} beam stays on the Earth all the turn: no edge", name_of(side));
  }
  return {};
}

std::string delta_in_words(const SpinGeometry& limits, Side side, double delta) {
  switch (class_of(limits, delta)) {
    case DeltaClass::Usable:
      return {};
    case DeltaClass::TwoRoots:
      return fmt::format("|Delta| < {} ({}): a fix by its chord alone has two roots to tell apart",
                         limits.determinant_usable, name_of(side));
    case DeltaClass::Ambiguous:
      return fmt::format("|Delta| <= {} ({}): a fix by its chord alone is ambiguous",
                         limits.determinant_ambiguous, name_of(side));
  }
  return {};
}

std::string sun_in_words(const PassGeometry& geometry) {
  const Revolution& turn = geometry.expected.revolution;
  if (geometry.sun_hidden) {
    return "the Earth hides the Sun: no sun pulses";
  }
  if (!turn.edge(PulseChannel::Sun1)) {
    return "the Sun stands too near the spin axis for either slit";
  }
  return turn.edge(PulseChannel::Sun2) ? "" : "slit 2 cannot see the Sun";
}

std::string_view cone_in_words(int geometry_case) {
  switch (geometry_case) {
    case 8:
      return "both chords without the Sun give a cone about the Earth";
    case 9:
      return "the sun angle alone gives a cone about the Sun";
    case 10:
      return "a chord alone gives cones about the Earth";
    default:
      return "nothing that tells of the axis";
  }
}

std::string fix_in_words(const PassGeometry& geometry) {
  const FixGeometry& fix = geometry.fix;
  if (fix.geometry_case < 1 || fix.geometry_case > 7) {
    return fmt::format("no fix (case {}): {}", fix.geometry_case, cone_in_words(fix.geometry_case));
  }
  if (geometry.in_line) {
    return fmt::format("no fix (case {}): Sun and Earth in line", fix.geometry_case);
  }
  if (fix.axes == 0) {
    return fmt::format("no fix (case {}): the noise leaves the axis open", fix.geometry_case);
  }
  return fmt::format(
      "fix by case {}: {}", fix.geometry_case,
      fix.told_apart ? "one axis" : "several axes, for a prior or time to tell apart");
}

}  // namespace

std::vector<std::string> conditions_of(const SpinConfig& config, const PassGeometry& geometry) {
  std::vector<std::string> conditions;
  const auto note = [&conditions](std::string words) {
    if (!words.empty()) {
      conditions.push_back(std::move(words));
    }
  };
  note(fix_in_words(geometry));
  note(sun_in_words(geometry));
  note(geometry.in_line ? "Sun and Earth in line, within 3 deg" : "");
  for (const Side side : kSides) {
    const BeamGeometry& beam = geometry.beams.at(index_of(side));
    note(beam_in_words(side, beam.view));
    if (beam.delta) {
      note(delta_in_words(config.geometry, side, *beam.delta));
    }
  }
  for (const ColocatedChannels& channels : geometry.expected.meeting) {
    note(fmt::format("interference: {} and {} meet", spindrift::name_of(channels.one),
                     spindrift::name_of(channels.other)));
  }
  return conditions;
}

}  // namespace spindrift
