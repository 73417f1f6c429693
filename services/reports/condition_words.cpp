#include "services/reports/condition_words.h"

#include <array>

#include "services/base/filled.h"

namespace spindrift {
namespace {

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

}  // namespace

std::string sentence_of(const PassCondition& condition) {
  return filled(pattern_of(kConditionPatterns, condition.code), condition.values, 0);
}

}  // namespace spindrift
