/// @file
/// What a person should know of a pass beside its products. Codes with values; the sentences are
/// made of them in services/words.

#pragma once

#include <optional>
#include <vector>

#include "pipelines/core/assessment.h"
#include "pipelines/core/no_fix.h"

namespace spindrift {

enum class NoticeCode {
  LateEdges,               ///< -
  EdgesOutOfTime,          ///< -
  InterferenceBegins,      ///< t_tai_ns, one, other, interference_s
  Interfered,              ///< one, other, revolutions, first_tai_ns, last_tai_ns
  CopiesBegin,             ///< t_tai_ns, channel
  Copied,                  ///< channels, edges, apart_s
  CountUncertain,          ///< turns, revolution
  NoPeriod,                ///< slowest_rpm, fastest_rpm
  TimesOnGrid,             ///< t_tai_ns, grid_s
  EdgesLeftOut,            ///< percent, most
  SilentChannels,          ///< channels
  ChannelsWithoutSensor,   ///< channels
  OutsideOrbit,            ///< t_tai_ns, of the start of the revolution; likewise the following
  RangeImpossible,         ///< t_tai_ns
  OrbitStepsInPass,        ///< t_tai_ns, km, m_s
  MuchOutsideOrbit,        ///< revolutions, t_tai_ns, either of the two
  NoFix,                   ///< revolution, and why
  NoAxis,                  ///< revolutions, and why the last of them
  DispersionSettles,       ///< t_tai_ns, ra_deg, dec_deg, fixes, scatter_ratio
  LikelihoodSettles,       ///< likewise, log_likelihood_ratio
  RevolutionsContradict,   ///< -
  FixContradictsItself,    ///< -
  HealthyBeamSilent,       ///< beam
  PriorContradicted,       ///< t_tai_ns
  PriorFar,                ///< t_tai_ns, deg, sigmas
  AxisMoved,               ///< t_tai_ns, deg
  MeanNeverBegan,          ///< fixes, near_tangent, ambiguous, not_accepted
  SequentialNeverBegan,    ///< -
  LittleLeverage,          ///< error_deg, moved_deg
  NotFinite,               ///< table, column
  AmbiguousNoPrior,        ///< geometry_case; likewise the following
  AmbiguousNearTangent,    ///< -
  AmbiguousPriorNoHelp,    ///< - , as fixes are near-tangent
  AmbiguousAgainstPrior,   ///< -
  AmbiguousFarFromPrior,   ///< -
  AmbiguousNearPrior,      ///< prior_sigma_deg
  AmbiguousPriorNotBorne,  ///< -
  LateSamples,             ///< -
  SamplesOutOfTime,        ///< -
  FieldWithoutOrbit,       ///< t_tai_ns; likewise the following
  OutsideFieldModel,       ///< -
  AttitudeNeverBegan,      ///< gyro, star, sun, magnetometer
  MostLeftOut,  ///< sensor, percent, rejected_by; of some rate_deg_s and range_deg_s, or sigmas and
                ///< most_sigmas
};
inline constexpr int kNoticeCodes = static_cast<int>(NoticeCode::MostLeftOut) + 1;

struct Notice {
  NoticeCode code;
  std::vector<NamedValue> values = {};
  std::optional<WhyNoFix> why = {};  ///< Of NoFix and NoAxis.

  bool operator==(const Notice&) const = default;
};

}  // namespace spindrift
