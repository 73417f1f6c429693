#include "pipelines/three_axis/error_culprit.h"

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <utility>
#include <vector>

#include "pipelines/frames/angle.h"
#include "pipelines/three_axis/products.h"
#include "pipelines/three_axis/sensor_pair.h"

namespace spindrift {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

// Stated standard deviations are multiplied by this where nothing is to be known of an error.
constexpr double kUnstated = 100.0;
// A field of a low orbit, in which a bias of the magnetometer is told as an angle.
const Vector3d kAnyField_nt{24'000.0, 19'200.0, 25'600.0};

struct Span {
  int first;
  int count;
};

struct KindErrors {
  SampleKind kind;
  std::array<Span, 3> spans;

  int count() const { return spans[0].count + spans[1].count + spans[2].count; }
};

constexpr std::array<KindErrors, 4> kSensors{{
    {SampleKind::Star, {{{StarTrackerError, 3}, {StarTrackerTimeError, 1}, {}}}},
    {SampleKind::Sun, {{{SunSensorError, 3}, {SunSensorTimeError, 1}, {}}}},
    {SampleKind::Magnetometer,
     {{{MagnetometerError, 3}, {MagnetometerBiasError, 3}, {MagnetometerTimeError, 1}}}},
    {SampleKind::Gyro, {{{GyroScaleError, 3}, {GyroAxisError, 6}, {}}}},
}};

/// A sensor that alone may be wrong.
struct Suspect {
  SampleKind kind;
  double sigmas;        ///< By how much its errors explain more than if they were as stated.
  FilterErrors errors;  ///< Its errors then.
};

struct Fit {
  FilterErrors errors;
  FilterAlignment left;
  double explained;
};

Fit fit(const AlignmentEvidence& evidence, const FilterAlignment& prior) {
  const FilterAlignment left =
      (FilterAlignment::Identity() + prior * evidence.information()).partialPivLu().solve(prior);
  const FilterErrors errors = left * evidence.score();
  return {.errors = errors, .left = left, .explained = errors.dot(evidence.score())};
}

std::optional<Suspect> suspected(const KindErrors& sensor, const AlignmentEvidence& evidence,
                                 double explained_as_stated) {
  FilterAlignment prior = evidence.prior();
  for (const auto& [first, count] : sensor.spans) {
    prior.middleRows(first, count) *= kUnstated;
    prior.middleCols(first, count) *= kUnstated;
  }
  const Fit freed = fit(evidence, prior);
  FilterErrors own = FilterErrors::Zero();
  for (const auto& [first, count] : sensor.spans) {
    own.segment(first, count) = freed.errors.segment(first, count);
  }
  if (own.isZero(0.0) || error_beyond(freed.errors - own, prior, freed.left)) {
    return std::nullopt;
  }
  return Suspect{.kind = sensor.kind,
                 .sigmas = sigmas_from(freed.explained - explained_as_stated, sensor.count()),
                 .errors = own};
}

/// Returns the turn by which the errors move what the sensor says, of a gyro in a second.
double angle_deg(const Suspect& suspect, const Vector3d& rate_body_rad_s) {
  const auto turn_deg = [&](const TurnPerError& per_error) {
    return degrees((per_error * suspect.errors).norm());
  };
  if (suspect.kind == SampleKind::Gyro) {
    return turn_deg(
        turned(TurnPerError::Zero(), rate_body_rad_s, Matrix3d::Identity(), Matrix3d::Identity()));
  }
  return turn_deg(suspect.kind == SampleKind::Star
                      ? star_per_error(rate_body_rad_s)
                      : direction_per_error(suspect.kind, kAnyField_nt, rate_body_rad_s));
}

}  // namespace

std::optional<SensorContradiction> contradiction_by_errors(const AlignmentEvidence& evidence,
                                                           const Vector3d& rate_body_rad_s,
                                                           TaiTime since) {
  const double as_stated = fit(evidence, evidence.prior()).explained;
  std::vector<Suspect> suspects;
  std::vector<SampleSource> others;
  for (const KindErrors& sensor : kSensors) {
    if (auto suspect = suspected(sensor, evidence, as_stated)) {
      suspects.push_back(*std::move(suspect));
    } else if (evidence.information()(sensor.spans[0].first, sensor.spans[0].first) > 0.0) {
      others.push_back(source_of(sensor.kind));
    }
  }
  if (suspects.empty() || suspects.size() > 2) {
    return std::nullopt;
  }
  const Suspect& one = suspects.front();
  const Suspect& other = suspects.back();
  const bool is_certain = suspects.size() == 1;
  const double sigmas = std::min(one.sigmas, other.sigmas);
  if (sigmas < SensorPair::kContradicts) {
    return std::nullopt;
  }
  return SensorContradiction{
      .culprit = is_certain ? std::optional{source_of(one.kind)} : std::nullopt,
      .with =
          is_certain ? std::move(others) : std::vector{source_of(one.kind), source_of(other.kind)},
      .off = {"angle_deg", angle_deg(one, rate_body_rad_s)},
      .sigmas = sigmas,
      .since = since};
}

}  // namespace spindrift
