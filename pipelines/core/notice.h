/// @file
/// What a person should know of a pass beside its products. Codes with values; the sentences are
/// made of them in services/words.

#pragma once

#include <string_view>

#include "pipelines/core/assessment.h"

namespace spindrift {

enum class NoticeCode {
  LateEdges,               ///< -
  EdgesOutOfTime,          ///< -
  InterferenceBegins,      ///< t_tai_ns, one, other, interference_s
  Interfered,              ///< one, other, revolutions, first_tai_ns, last_tai_ns
  CountUncertain,          ///< turns, revolution
  NoPeriod,                ///< slowest_rpm, fastest_rpm
  EdgesLeftOut,            ///< percent, most
  SilentChannels,          ///< channels
  ChannelsWithoutSensor,   ///< channels
  OutsideOrbit,            ///< why
  MuchOutsideOrbit,        ///< revolutions, why
  NoFix,                   ///< revolution, why
  NoAxis,                  ///< revolutions, why
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
  AttitudeNeverBegan,      ///< gyro, star, sun
};
inline constexpr int kNoticeCodes = static_cast<int>(NoticeCode::AttitudeNeverBegan) + 1;

using Notice = Coded<NoticeCode>;

}  // namespace spindrift
