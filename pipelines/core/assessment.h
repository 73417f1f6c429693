/// @file
/// The assessment of an answer: quality and reasons, as codes with values. services/base turns them
/// into sentences.

#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace spindrift {

enum class Quality {
  Converging,  ///< Nothing contradicts it, but too few of its own data have checked it yet.
  Ok,
  Ambiguous,  ///< Another answer fits equally well, or no evidence has settled this one.
  Doubtful,   ///< The data contradict the answer, the noise or the model, or are too few.
  Lost,       ///< The answer is no longer the true one, or never was.
};
inline constexpr int kQualities = 5;
std::string_view name_of(Quality quality);

/// Returns whether nothing contradicts the answer, be it checked or not.
constexpr bool is_unopposed(Quality quality) {
  return quality == Quality::Ok || quality == Quality::Converging;
}

struct NamedValue {
  /// A number, a name, or the names of several things.
  using Value = std::variant<std::int64_t, double, std::string, std::vector<std::string>>;

  std::string name;  ///< Ends in the unit.
  Value value;

  bool operator==(const NamedValue&) const = default;
};

/// Holds a message code with its values.
template <class Code>
struct Coded {
  Code code;
  std::vector<NamedValue> values = {};

  bool operator==(const Coded&) const = default;
};

/// The reasons for a quality and the basis of an answer; schemas/status.md explains each. The
/// comments list the values that a reason carries.
enum class ReasonCode {
  Fixes,                ///< count
  FewFixes,             ///< needed
  BeamsNearLimb,        ///< -
  LeastSquaresOff,      ///< deg
  FixesScatter,         ///< factor
  FewSettled,           ///< open_percent
  Since,                ///< since_tai_ns
  AwaitingFix,          ///< -
  ModelOff,             ///< deg, key
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
  OtherAxis,            ///< ra_deg, dec_deg, sigma_deg
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
  AlignmentOff,         ///< key, sigmas
  Contradicted,         ///< sensor, with, angle_deg or offset_s, sigmas, since_tai_ns
  OrbitSteps,           ///< t_tai_ns, km, m_s
  Withheld,             ///< table, column
  ComputingFailed,      ///< what
  // Reasons of a reconstruction:
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

/// Adds a reason against an answer, which becomes DOUBTFUL if it was unopposed.
void doubt(Assessment& assessment, Reason reason);

}  // namespace spindrift
