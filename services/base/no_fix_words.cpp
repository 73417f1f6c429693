#include "services/base/no_fix_words.h"

#include <array>

#include "services/base/filled.h"

namespace spindrift {
namespace {

using enum NoFixCode;
constexpr std::array<Pattern<NoFixCode>, kNoFixCodes> kNoFixPatterns{{
    {BothChordsAlone, "both chords without a sun pulse: a cone about the Earth only"},
    {SunAngleAlone, "a sun angle without a chord: a cone about the Sun only"},
    {OneChordAlone, "a chord alone: one or two cones about the Earth only"},
    {NothingMeasured, "no measurement that an axis could be found from"},
    {SunEarthInLine,
     "Sun and Earth stand {sun_earth_deg:.3f} deg apart: the axis needs between 3 and 177 deg"},
    {ChordTooWide,
     "chord {chord_deg:.4f} deg is wider than the Earth's disc of half-angle {disc_deg:.4f} deg "
     "allows at mounting angle {mount_angle_deg:.4f} deg"},
    {NoEarthAngle, "no earth angle in (0, 180) deg gives the measured chord"},
    {OneChordContradicts,
     "the measured sun angle, chord and dihedral contradict each other: no earth angle in "
     "(0, 180) deg fits them"},
    {ConesApart,
     "the cones of {sun_angle_deg:.4f} deg about the Sun and {earth_angle_deg:.4f} deg about the "
     "Earth do not meet, which stand {sun_earth_deg:.4f} deg apart"},
    {NoSunAngle, "no sun angle in (0, 180) deg fits the measured earth angle and dihedral"},
    {NoSunAngleOfSlit2,
     "no sun angle that sun slit 2 can see fits the measured earth angle and azimuth"},
    {LostInNoise,
     "the solution is lost in the noise of its edges: it exists only within one sigma of them, or "
     "no measurement fixes one of its directions"},
}};
static_assert(are_by_code(kNoFixPatterns));

}  // namespace

std::string sentence_of(const WhyNoFix& why) {
  return filled(pattern_of(kNoFixPatterns, why.code), why.values, 0);
}

}  // namespace spindrift
