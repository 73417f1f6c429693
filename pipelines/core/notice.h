/// @file
/// The notices about a pass for operators; services/base turns them into sentences.

#pragma once

#include <optional>
#include <vector>

#include "pipelines/core/assessment.h"
#include "pipelines/core/no_fix.h"

namespace spindrift {

/// The comments list the values that a notice carries.
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
  OutsideOrbit,            ///< t_tai_ns (start of the revolution)
  RangeImpossible,         ///< t_tai_ns (start of the revolution)
  OrbitStepsInPass,        ///< t_tai_ns, km, m_s
  MuchOutsideOrbit,        ///< revolutions, t_tai_ns; counts the previous two codes
  NoFix,                   ///< revolution; with `why`
  NoAxis,                  ///< revolutions; with `why` of the last one
  DispersionSettles,       ///< t_tai_ns, ra_deg, dec_deg, fixes, scatter_ratio
  LikelihoodSettles,       ///< as DispersionSettles, log_likelihood_ratio
  RevolutionsContradict,   ///< -
  FixContradictsItself,    ///< -
  HealthyBeamSilent,       ///< beam
  PriorContradicted,       ///< t_tai_ns, prior_from
  RootFarFromAll,          ///< t_tai_ns, limit_deg, ra_deg, dec_deg, deg (of the nearest candidate)
  RootChosen,              ///< t_tai_ns, ra_deg, dec_deg, deg (from what was asked for)
  BatchLeavesOut,          ///< t_tai_ns, edges, action
  ChannelIncluded,         ///< t_tai_ns, channel, action_id
  ChannelNotLeftOut,       ///< t_tai_ns, channel, action_id
  LimitsSet,               ///< t_tai_ns, key, limits, action_id
  PriorFar,                ///< t_tai_ns, deg, sigmas, prior_from
  AxisMoved,               ///< t_tai_ns, deg
  MeanNeverBegan,          ///< fixes, near_tangent, ambiguous, not_accepted
  SequentialNeverBegan,    ///< -
  LittleLeverage,          ///< error_deg, moved_deg
  NotFinite,               ///< table, column
  AmbiguousNoPrior,        ///< geometry_case
  AmbiguousNearTangent,    ///< geometry_case
  AmbiguousPriorNoHelp,    ///< geometry_case, prior_from
  AmbiguousAgainstPrior,   ///< geometry_case, prior_from
  AmbiguousFarFromPrior,   ///< geometry_case, prior_from
  AmbiguousNearPrior,      ///< geometry_case, prior_from, prior_sigma_deg
  AmbiguousPriorNotBorne,  ///< geometry_case, prior_from
  LateSamples,             ///< -
  SamplesOutOfTime,        ///< -
  FieldWithoutOrbit,       ///< t_tai_ns
  OutsideFieldModel,       ///< t_tai_ns
  AttitudeNeverBegan,      ///< gyro, star, sun, magnetometer
  MostLeftOut,  ///< sensor, percent, rejected_by; rates or sigmas if the test has numbers
};
inline constexpr int kNoticeCodes = static_cast<int>(NoticeCode::MostLeftOut) + 1;

struct Notice {
  NoticeCode code;
  std::vector<NamedValue> values = {};
  std::optional<WhyNoFix> why = {};  ///< Set for NoFix and NoAxis.

  bool operator==(const Notice&) const = default;
};

}  // namespace spindrift
