/// @file
/// What is said of an answer beside its numbers: whether to act on it, and why. Codes with values;
/// the sentences for people are made of them in services/words.

#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace spindrift {

/// Whether to act on an answer.
enum class Quality {
  Converging,  ///< Nothing speaks against it, but it is too young to be checked by its own data.
  Ok,
  Ambiguous,  ///< Another answer fits as well, or nothing has settled this one.
  Doubtful,   ///< The data contradict it, the noise or the model; or there is too little of them.
  Lost,       ///< It is no longer, or never was, the true one.
};
inline constexpr int kQualities = 5;
std::string_view name_of(Quality quality);

/// Whether nothing speaks against the answer, checked or not.
constexpr bool is_unopposed(Quality quality) {
  return quality == Quality::Ok || quality == Quality::Converging;
}

struct NamedValue {
  /// A number or a name; of several things of a kind, their names.
  using Value = std::variant<std::int64_t, double, std::string, std::vector<std::string>>;

  std::string name;  ///< Ends in the unit.
  Value value;

  bool operator==(const NamedValue&) const = default;
};

/// Something to be said, and what it is about.
template <class Code>
struct Coded {
  Code code;
  std::vector<NamedValue> values = {};

  bool operator==(const Coded&) const = default;
};

/// Why an answer has its quality, and what it rests on. schemas/status.md says of each what it
/// means.
enum class ReasonCode {
  Fixes,                ///< count
  FewFixes,             ///< needed
  BeamsNearLimb,        ///< -
  LeastSquaresOff,      ///< deg
  FixesScatter,         ///< factor
  FewSettled,           ///< open_percent
  Since,                ///< since_tai_ns
  AwaitingFix,          ///< -
  ModelOff,             ///< deg
  Noise,                ///< factor
  CopiesInNoise,        ///< -
  Revolutions,          ///< count
  EdgesGated,           ///< count
  ChannelGated,         ///< channel
  ManyGated,            ///< -
  StartUnconfirmed,     ///< -
  PoorLeverage,         ///< -
  PriorRefuted,         ///< -
  RestartedGated,       ///< -
  RestartedByFixes,     ///< -
  OtherAxis,            ///< ra_deg, dec_deg
  MoreAxes,             ///< count
  FixesNearTangent,     ///< -
  NothingSettled,       ///< -
  Edges,                ///< count
  Outliers,             ///< count
  Changed,              ///< since_tai_ns
  MostBeforeChange,     ///< edges
  NoAxisBeforeChange,   ///< -
  Nutation,             ///< deg, period_s
  OtherNutationPeriod,  ///< period_s
  Coning,               ///< deg, sigma_deg
  ConingOrMisplaced,    ///< -
  NoConing,             ///< detectable_deg
  Bias,                 ///< bias, value, sigma, unit
  BiasFarOff,           ///< bias, prior_sigmas
  BiasOpen,             ///< bias
  BiasAtBound,          ///< bias
  BiasWanted,           ///< bias
  NoGyro,               ///< why, since_tai_ns
  GyroUnit,             ///< factor
  SensorGated,          ///< sensor
  SensorNoise,          ///< sensor, factor
  OrbitSteps,           ///< t_tai_ns, km, m_s
  Withheld,             ///< table, column
  ComputingFailed,      ///< what
  // Of a reconstruction.
  SunVectors,           ///< count
  SunOutliers,          ///< count
  SunVectorsShadowed,   ///< count
  ShadowUnknown,        ///< count
  StarFixes,            ///< count
  StarFixesGated,       ///< count
  StarFixesContradict,  ///< -
  GyroGaps,             ///< count, longest_s
  GyroSaturated,        ///< count
  GyroFrozen,           ///< count
  GyroOutliers,         ///< count
  ConstantRate,         ///< -
  GyroBiasOpen,         ///< sigma_deg_s
  GyroBiasOpenBySun,    ///< sigma_deg_s, off_sun_deg
  GyroBiasFarOff,       ///< prior_sigmas
  AttitudeOpen,         ///< deg
};
inline constexpr int kReasonCodes = static_cast<int>(ReasonCode::AttitudeOpen) + 1;
std::string_view name_of(ReasonCode code);

using Reason = Coded<ReasonCode>;

struct Assessment {
  Quality quality;
  std::vector<Reason> reasons = {};

  bool operator==(const Assessment&) const = default;
};

bool has(const Assessment& assessment, ReasonCode code);

/// Adds what speaks against an answer: unopposed before, it is DOUBTFUL now.
void doubt(Assessment& assessment, Reason reason);

}  // namespace spindrift
