#include "services/base/assessment_words.h"

#include <algorithm>
#include <array>
#include <string_view>
#include <variant>
#include <vector>

#include "pipelines/observation/sensor_contradiction.h"
#include "services/base/decimals.h"
#include "services/base/filled.h"

namespace spindrift {
namespace {

using enum ReasonCode;
constexpr std::array<Pattern<ReasonCode>, kReasonCodes> kReasonPatterns{{
    {Fixes, "{count} fix{es}"},
    {FewFixes, "fewer than {needed}"},
    {BeamsNearLimb, "plain average: beams too near the limb"},
    {LeastSquaresOff, "plain average: least squares {deg:.2g} deg off"},
    {FixesScatter, "fixes scatter {factor:.1f} x their noise"},
    {FewSettled, "{open_percent:.0f} % of such graze or are ambiguous"},
    {Since, "since {since_tai_ns}"},
    {AwaitingFix, "awaiting a fix"},
    {ModelOff, "model off {deg:.2g} deg: {key}"},
    {Noise, "noise x {factor:.1f}"},
    {CopiesInNoise, "copies within the noise"},
    {Revolutions, "{count} revolution{s}"},
    {EdgesGated, "{count} edge{s} gated"},
    {ChannelGated, "most {channel} edges gated"},
    {ManyGated, "many edges gated"},
    {StartUnconfirmed, "not confirmed by fixes yet"},
    {PoorLeverage, "poor leverage"},
    {PriorRefuted, "prior refuted"},
    {RestartedGated, "restart: edges gated"},
    {RestartedByFixes, "restarted by fixes"},
    {OtherAxis, "or ra {ra_deg:.{decimals}f} dec {dec_deg:.{decimals}f} deg"},
    {MoreAxes, "or {count} more"},
    {FixesNearTangent, "or another axis: all fixes graze the limb"},
    {NothingSettled, "no fix has settled it"},
    {Edges, "{count} edge{s}"},
    {Outliers, "{count} outlier{s}"},
    {Changed, "since {since_tai_ns}, where attitude or rate changed"},
    {MostBeforeChange, "{edges} edges before that are left out: most of the pass"},
    {NoAxisBeforeChange, "no one axis fits the edges before that"},
    {Nutation, "nutation {deg:.3g} deg, period {period_s:.3f} s"},
    {OtherNutationPeriod, "or period {period_s:.3f} s"},
    {Coning, "coning {deg:.{decimals}f} +/- {sigma_deg:.{decimals}f} deg"},
    {ConingOrMisplaced, "or a misplaced sensor (coning in [spin.batch] decides)"},
    {NoConing, "no coning above {detectable_deg:.2g} deg"},
    {Bias, "{bias} {value:+.{decimals}f} +/- {sigma:.{decimals}f} {unit}"},
    {BiasFarOff, "more than {prior_sigmas:.0f} times its prior"},
    {BiasOpen, "{bias} not determined"},
    {BiasAtBound, "{bias} runs to its bound"},
    {BiasWanted, "residuals ask for {bias}"},
    {NoGyro, "no gyro since {since_tai_ns}: {why}"},
    {GyroUnit, "gyro rates {factor:.3g} times those of the star fixes"},
    {SensorGated, "many {sensor} samples gated"},
    {SensorNoise, "{sensor} noise x {factor:.1f}"},
    {AlignmentOff, "model off {sigmas:.1f} sigma: {key}"},
    {Contradicted, "{sensor} wrong"},
    {OrbitSteps, "orbit steps by {km:.3f} km, {m_s:.2f} m/s at {t_tai_ns}"},
    {Withheld, "the last answer: {column} of {table} is not finite since"},
    {ComputingFailed, "the last answer: computing failed: {what}"},
    {SunVectors, "{count} sun vector{s}"},
    {SunOutliers, "{count} sun outlier{s}"},
    {SunVectorsShadowed, "{count} sun vector{s} in the Earth's shadow"},
    {ShadowUnknown, "{count} sun vector{s} outside the orbit"},
    {StarFixes, "{count} star fix{es}"},
    {StarFixesGated, "{count} star fix{es} gated"},
    {StarFixesContradict, "star fixes contradict each other"},
    {GyroGaps, "{count} gyro gap{s}, up to {longest_s:.1f} s"},
    {GyroSaturated, "{count} gyro sample{s} saturated"},
    {GyroFrozen, "{count} gyro sample{s} frozen"},
    {GyroOutliers, "{count} gyro outlier{s}"},
    {ConstantRate, "constant rate before T2"},
    {GyroBiasOpen, "gyro bias open by {sigma_deg_s:.2g} deg/s"},
    {GyroBiasOpenBySun,
     "gyro bias open by {sigma_deg_s:.2g} deg/s, {off_sun_deg:.0f} deg off the Sun line"},
    {GyroBiasFarOff, "gyro bias more than {prior_sigmas:.0f} times its prior"},
    {AttitudeOpen, "attitude open by {deg:.0f} deg"},
}};
static_assert(are_by_code(kReasonPatterns));

/// Returns the decimals for `decimals` of a pattern, from the sigma among the reason's values.
NamedValue decimals_of(const Reason& reason) {
  constexpr std::int64_t kWithoutSigma = 2;
  for (const auto& [name, value] : reason.values) {
    const auto* const number = std::get_if<double>(&value);
    if (number != nullptr && name.starts_with("sigma")) {
      return {"decimals", std::int64_t{decimals_for(*number, kWithoutSigma)}};
    }
  }
  return {"decimals", kWithoutSigma};
}

/// Returns the pattern of the reason; without a culprit no sensor is called wrong.
std::string_view pattern_of(const Reason& reason) {
  const bool has_no_culprit =
      reason.code == Contradicted &&
      std::any_of(reason.values.begin(), reason.values.end(), [](const NamedValue& value) {
        return value == NamedValue{"sensor", std::string{kUnknownCulprit}};
      });
  return has_no_culprit ? "sensors differ" : pattern_of(kReasonPatterns, reason.code);
}

/// Returns the plural endings `s` and `es` of a pattern, empty for a `count` of one.
std::vector<NamedValue> endings_of(const Reason& reason) {
  for (const auto& [name, value] : reason.values) {
    const auto* const count = std::get_if<std::int64_t>(&value);
    if (name == "count" && count != nullptr && *count != 1) {
      return {{"s", "s"}, {"es", "es"}};
    }
  }
  return {{"s", ""}, {"es", ""}};
}

std::string words_of(const Reason& reason) {
  constexpr int kWholeSeconds = 0;
  std::vector<NamedValue> values = endings_of(reason);
  values.insert(values.end(), reason.values.begin(), reason.values.end());
  values.push_back(decimals_of(reason));
  return filled(pattern_of(reason), values, kWholeSeconds);
}

}  // namespace

std::string sentence_of(const Assessment& assessment) {
  std::string sentence{name_of(assessment.quality)};
  for (const Reason& reason : assessment.reasons) {
    sentence += ", " + words_of(reason);
  }
  return sentence;
}

}  // namespace spindrift
