#include "services/base/notice_words.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <string_view>
#include <variant>
#include <vector>

#include "services/base/filled.h"

namespace spindrift {
namespace {

/// A notice with its name, by which programs know it, and its sentence pattern.
struct NoticePattern {
  NoticeCode code;
  std::string_view name;
  std::string_view text;
};

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

using enum NoticeCode;
constexpr std::array<NoticePattern, kNoticeCodes> kNoticePatterns{{
    {LateEdges, "late_edges",
     "pulses arrive after their time was processed: they are stored and left out"},
    {EdgesOutOfTime, "edges_out_of_time",
     "pulses stamped far from the times of all others are left out: a sender's clock is wrong"},
    {InterferenceBegins, "interference_begins",
     "{t_tai_ns}: {one} and {other} come too near to each other (spin.screening.interference_s "
     "= {interference_s}): as long as they do, their edges are left out"},
    {Interfered, "interfered",
     "{one} and {other} were too near to each other in {revolutions} revolutions from "
     "{first_tai_ns} to {last_tai_ns}: their edges there are left out"},
    {CopiesBegin, "copies_begin",
     "{t_tai_ns}: the edges of {channel} come several times (are two receivers heard?): the "
     "earliest of a revolution counts, the others are left out as 'copy'"},
    {Copied, "copied",
     "{edges} edges of {channels} are copies, on average {apart_s:.3g} s from the edge of their "
     "revolution that counts: they are left out as 'copy'; look for a second receiver"},
    {CountUncertain, "count_uncertain",
     "after a silence the count of revolutions is uncertain by about {turns:.1f}, from "
     "revolution {revolution} on"},
    {NoPeriod, "no_period",
     "no spin period was found in the edges, of rates from {slowest_rpm} to {fastest_rpm} rpm: "
     "no revolution, and no axis"},
    {TimesOnGrid, "times_on_grid",
     "{t_tai_ns}: the times of the edges lie on a grid of {grid_s:g} s: the steps of a counter on "
     "board, or cut on the way, where nanoseconds are to be kept. What that leaves open of each is "
     "in "
     "every sigma, as an error that does not average out"},
    {EdgesLeftOut, "edges_left_out",
     "{percent:.0f} % of all edges do not fit and are left out, most as '{most}': the count of "
     "revolutions, and what is made of the others, may be wrong"},
    {SilentChannels, "silent_channels", "no edge at all came from {channels}"},
    {ChannelsWithoutSensor, "channels_without_sensor",
     "the mission describes no sensor for {channels}: their edges are left out; a beam needs "
     "[spin.ir.north] or [spin.ir.south]"},
    {OutsideOrbit, "outside_orbit",
     "{t_tai_ns}: the orbit of the mission file does not cover the revolution that begins here: "
     "revolutions outside it give no axis"},
    {RangeImpossible, "range_impossible",
     "{t_tai_ns}: the orbit of the mission file lies below the infrared horizon or beyond a "
     "million km: such revolutions give no axis"},
    {OrbitStepsInPass, "orbit_steps_in_pass",
     "{t_tai_ns}: the orbit steps by {km:.3f} km and {m_s:.2f} m/s within the pass: segments of "
     "the "
     "OEM do not meet, or its states do not follow from each other. Ask whoever made the orbit; "
     "was "
     "it a manoeuvre, mark it"},
    {MuchOutsideOrbit, "much_outside_orbit",
     "orbit: {revolutions} revolutions outside it gave no axis, the last at {t_tai_ns}"},
    {NoFix, "no_fix", "revolution {revolution} is the first that gives no fix: {why}"},
    {NoAxis, "no_axis", "no axis: {revolutions} revolutions gave no fix, the last: {why}"},
    {DispersionSettles, "dispersion_settles",
     "{t_tai_ns}: the dispersion settles on the axis near ra {ra_deg:.2f} dec {dec_deg:.2f} "
     "deg: over {fixes:.0f} fixes its candidates stay where they are and the others drift, "
     "ratio of the scatters {scatter_ratio:.1f} (F-test)"},
    {LikelihoodSettles, "likelihood_settles",
     "{t_tai_ns}: the dispersion settles on the axis near ra {ra_deg:.2f} dec {dec_deg:.2f} "
     "deg: over {fixes:.0f} fixes its candidates stay where they are and the others drift, "
     "ratio of the scatters {scatter_ratio:.1f} (likelihood ratio e^{log_likelihood_ratio:.0f})"},
    {RevolutionsContradict, "revolutions_contradict",
     "the measurements of most revolutions contradict each other: no fix is accepted, as "
     "others may agree by accident; check the mission's mounting angles, azimuths and orbit"},
    {FixContradictsItself, "fix_contradicts_itself",
     "measurements contradict each other, their fixes are not accepted: the length of the axis "
     "or the size of the Earth's disc comes out wrong; check the mission's mounting angles, "
     "azimuths and orbit"},
    {HealthyBeamSilent, "healthy_beam_silent",
     "the {beam} beam, said to be healthy, is silent where the axis says it must see the "
     "Earth: such fixes are not accepted; if the beam has failed, say healthy = false"},
    {PriorContradicted, "prior_contradicted",
     "{t_tai_ns}: the edges contradict the prior of the {prior_from}: the axis is another one, the "
     "mean begins anew"},
    {RootFarFromAll, "root_far_from_all",
     "{t_tai_ns}: no candidate lies within {limit_deg:.0f} deg of the chosen axis: the nearest is "
     "ra {ra_deg:.2f} dec {dec_deg:.2f} deg, {deg:.1f} deg away; the choice waits for one"},
    {RootChosen, "root_chosen",
     "{t_tai_ns}: the candidate ra {ra_deg:.2f} dec {dec_deg:.2f} deg is taken, {deg:.1f} deg from "
     "the chosen axis"},
    {BatchLeavesOut, "batch_leaves_out", "{t_tai_ns}: batch leaves out {edges} edges by {action}"},
    {ChannelIncluded, "channel_included", "{t_tai_ns}: {channel} is used again from here on"},
    {ChannelNotLeftOut, "channel_not_left_out",
     "{t_tai_ns}: {channel} is not left out here: nothing changes"},
    {LimitsSet, "limits_set", "{t_tai_ns}: {key} is held to {limits} from here on"},
    {PriorFar, "prior_far",
     "{t_tai_ns}: the axis is {deg:.1f} deg from the prior of the {prior_from}, "
     "{sigmas:.0f} times the sigma of both: the edges decide without it"},
    {AxisMoved, "axis_moved",
     "{t_tai_ns}: the axis is {deg:.2f} deg from the mean so far: it has moved, or the mean "
     "was wrong; the mean begins anew"},
    {MeanNeverBegan, "mean_never_began",
     "the estimator 'mean' never began: of {fixes} fixes, {near_tangent} are near-tangent (their "
     "candidates "
     "come together within the noise), {ambiguous} are ambiguous, {not_accepted} are not "
     "accepted"},
    {SequentialNeverBegan, "sequential_never_began",
     "the estimator 'sequential' never began: its fixes leave the axis, or a candidate for it, "
     "uncertain by more than 3 deg"},
    {LittleLeverage, "little_leverage",
     "poor leverage: errors of {error_deg:.2f} deg in mounting or limb move the axis by "
     "{moved_deg:.1f} deg; sigma has those that [spin.alignment] states and the "
     "edges show"},
    {NotFinite, "not_finite",
     "results are withheld: {column} of {table} is not a finite number. The samples are stored; "
     "look for a value in the mission file that no instrument has"},
    {AmbiguousNoPrior, "ambiguous_no_prior",
     "the axis is ambiguous to the end{missing}: a prior in the mission file, or an "
     "operator, would choose among the candidates"},
    {AmbiguousNearTangent, "ambiguous_near_tangent",
     "the axis is ambiguous to the end{missing}: nearly all fixes are near-tangent: the true axis "
     "may be "
     "missing among their candidates, so that no prior would settle it"},
    {AmbiguousPriorNoHelp, "ambiguous_prior_no_help",
     "the axis is ambiguous to the end{missing}: nearly all fixes are near-tangent: the true axis "
     "may be "
     "missing among their candidates, so that the prior of the {prior_from} does not "
     "settle it"},
    {AmbiguousAgainstPrior, "ambiguous_against_prior",
     "the axis is ambiguous to the end{missing}: the edges contradict the prior of the "
     "{prior_from}"},
    {AmbiguousFarFromPrior, "ambiguous_far_from_prior",
     "the axis is ambiguous to the end{missing}: the prior of the {prior_from} does "
     "not settle it: no candidate is within three sigmas of it"},
    {AmbiguousNearPrior, "ambiguous_near_prior",
     "the axis is ambiguous to the end{missing}: the prior of the {prior_from} does "
     "not settle it: within its sigma of {prior_sigma_deg:g} deg, several candidates are "
     "equally near to it"},
    {AmbiguousPriorNotBorne, "ambiguous_prior_not_borne",
     "the axis is ambiguous to the end{missing}: the edges do not bear out the candidate that "
     "the prior of the {prior_from} chooses"},
    {LateSamples, "late_samples",
     "samples arrive after their time was processed: they are stored and left out"},
    {SamplesOutOfTime, "samples_out_of_time",
     "samples stamped far from the times of all others are left out: a sender's clock is wrong"},
    {FieldWithoutOrbit, "field_without_orbit",
     "{t_tai_ns}: no orbit says where the spacecraft is: samples of the magnetometer are left out; "
     "it takes [orbit] or orbit states"},
    {OutsideFieldModel, "outside_field_model",
     "{t_tai_ns}: the model of the Earth's field does not reach here (it ends with its years, and "
     "at the core): samples of the magnetometer are left out; get a newer program"},
    {AttitudeNeverBegan, "attitude_never_began",
     "no attitude: {star} star fixes, {sun} sun vectors, {magnetometer} fields and {gyro} gyro "
     "samples do not anchor one; it takes a star fix, or two directions that agree and are not in "
     "line within 5 s, without a gyro within 1 s"},
    {MostLeftOut, "most_left_out",
     "{percent:.0f} % of the {sensor} samples so far are left out as '{rejected_by}': "
     "{what_to_do}"},
}};
static_assert(are_by_code(kNoticePatterns));

/// Advice by the test that left samples out (schemas/tables.sql), with the limit that they failed.
struct WhatToDo {
  std::string_view rejected_by;
  std::string_view text;
};
constexpr std::array kWhatToDo = {
    WhatToDo{"late",
             "they arrive after their time has been processed, a second behind the others; look at "
             "their sender and its link"},
    WhatToDo{"out_of_time",
             "they are a minute and more from the times of all others; set their sender's clock"},
    WhatToDo{"contradicted",
             "they came with other values, too; name in [sources] prefer whose values count"},
    WhatToDo{"no_sensor", "describe the sensor under [three_axis] in the mission file"},
    WhatToDo{"saturated",
             "the last has {rate_deg_s:.4g} deg/s, and range_deg_s = {range_deg_s:.4g}; correct "
             "that, or send the rates in rad/s"},
    WhatToDo{"frozen", "they repeat their numbers; look at the sensor and at who sends it"},
    WhatToDo{"outlier",
             "they are far from their neighbours; look for bad values, or raise noise_deg_s"},
    WhatToDo{"shadow", "the orbit has the Earth before the Sun; look at the orbit's times"},
    WhatToDo{"no_orbit", "no orbit reaches them; it takes [orbit] or good orbit states"},
    WhatToDo{"no_field", "the model of the field does not reach them; get a newer program"},
    WhatToDo{"unit",
             "turns between star fixes are those of the rates in another unit; send them in rad/s"},
    WhatToDo{"innovation",
             "the last is {sigmas:.1f} sigmas off the attitude, of {most_sigmas:.1f} allowed; look "
             "at its mounting, its noise and its unit, and at those of the gyro"},
};

std::string_view what_to_do(std::string_view rejected_by) {
  const auto* const found =
      std::find_if(kWhatToDo.begin(), kWhatToDo.end(),
                   [&](const WhatToDo& what) { return what.rejected_by == rejected_by; });
  return found == kWhatToDo.end() ? "look at rejected_sample" : found->text;
}

/// Explains why fixes of a geometry case leave several candidates.
std::string_view what_is_missing(std::int64_t geometry_case) {
  switch (geometry_case) {
    case 4:
      return ", for want of good sun2 edges";
    case 5:
    case 6:
      return ", for want of good sun edges and of one beam's chords";
    case 7:
      return ", for want of good sun1 edges";
    default:
      return "";
  }
}

}  // namespace

std::string_view name_of(NoticeCode code) {
  return kNoticePatterns.at(static_cast<std::size_t>(code)).name;
}

std::string sentence_of(const WhyNoFix& why) {
  return filled(pattern_of(kNoFixPatterns, why.code), why.values, 0);
}

nlohmann::json values_of(const Notice& notice) {
  nlohmann::json values = nlohmann::json::object();
  const auto put = [&values](const std::vector<NamedValue>& named) {
    for (const NamedValue& one : named) {
      std::visit([&](const auto& is) { values[one.name] = is; }, one.value);
    }
  };
  put(notice.values);
  if (notice.why) {
    put(notice.why->values);
  }
  return values;
}

std::string sentence_of(const Notice& notice) {
  constexpr int kMilliseconds = 3;
  std::vector<NamedValue> values = notice.values;
  if (notice.why) {
    values.push_back({"why", sentence_of(*notice.why)});
  }
  const auto of_case = std::find_if(values.begin(), values.end(), [](const NamedValue& value) {
    return value.name == "geometry_case";
  });
  if (of_case != values.end()) {
    const auto geometry_case = std::get<std::int64_t>(of_case->value);
    values.push_back({"missing", std::string{what_is_missing(geometry_case)}});
  }
  if (notice.code == NoticeCode::MostLeftOut) {
    const auto rejected_by =
        std::find_if(values.begin(), values.end(),
                     [](const NamedValue& value) { return value.name == "rejected_by"; });
    const std::string_view pattern = what_to_do(std::get<std::string>(rejected_by->value));
    values.push_back({"what_to_do", filled(pattern, values, kMilliseconds)});
  }
  return filled(pattern_of(kNoticePatterns, notice.code), values, kMilliseconds);
}

}  // namespace spindrift
