#include "pipelines/core/assessment.h"

#include <algorithm>
#include <array>
#include <utility>

namespace spindrift {

std::string_view name_of(Quality quality) {
  static constexpr std::array<std::string_view, kQualities> kNames = {
      "CONVERGING", "OK", "AMBIGUOUS", "DOUBTFUL", "LOST"};
  return kNames.at(static_cast<std::size_t>(quality));
}

std::string_view name_of(ReasonCode code) {
  static constexpr std::array<std::string_view, kReasonCodes> kNames = {
      "fixes",
      "few_fixes",
      "beams_near_limb",
      "least_squares_off",
      "fixes_scatter",
      "few_settled",
      "since",
      "awaiting_fix",
      "model_off",
      "noise",
      "copies_in_noise",
      "revolutions",
      "edges_gated",
      "channel_gated",
      "many_gated",
      "start_unconfirmed",
      "poor_leverage",
      "prior_refuted",
      "restarted_gated",
      "restarted_by_fixes",
      "other_axis",
      "more_axes",
      "fixes_near_tangent",
      "nothing_settled",
      "edges",
      "outliers",
      "changed",
      "most_before_change",
      "no_axis_before_change",
      "nutation",
      "other_nutation_period",
      "coning",
      "coning_or_misplaced",
      "no_coning",
      "bias",
      "bias_far_off",
      "bias_open",
      "bias_at_bound",
      "bias_wanted",
      "no_gyro",
      "gyro_unit",
      "sensor_gated",
      "sensor_noise",
      "alignment_off",
      "contradicted",
      "orbit_steps",
      "withheld",
      "computing_failed",
      "sun_vectors",
      "sun_outliers",
      "sun_vectors_shadowed",
      "shadow_unknown",
      "star_fixes",
      "star_fixes_gated",
      "star_fixes_contradict",
      "gyro_gaps",
      "gyro_saturated",
      "gyro_frozen",
      "gyro_outliers",
      "constant_rate",
      "gyro_bias_open",
      "gyro_bias_open_by_sun",
      "gyro_bias_far_off",
      "attitude_open",
  };
  return kNames.at(static_cast<std::size_t>(code));
}

bool has(const Assessment& assessment, ReasonCode code) {
  return std::any_of(assessment.reasons.begin(), assessment.reasons.end(),
                     [code](const Reason& reason) { return reason.code == code; });
}

void doubt(Assessment& assessment, Reason reason) {
  if (is_unopposed(assessment.quality)) {
    assessment.quality = Quality::Doubtful;
  }
  assessment.reasons.push_back(std::move(reason));
}

}  // namespace spindrift
