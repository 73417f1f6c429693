#include "pipelines/three_axis/sensor_contradictions.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "pipelines/frames/angle.h"
#include "pipelines/frames/celestial.h"
#include "pipelines/frames/rotation_vector.h"
#include "pipelines/frames/shortest_turn.h"
#include "pipelines/time/time_span.h"

namespace spindrift {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
constexpr auto kOrbit = SampleKind::OrbitState;
constexpr auto kGyro = SampleKind::Gyro;
constexpr auto kStar = SampleKind::Star;
constexpr auto kSun = SampleKind::Sun;
constexpr auto kField = SampleKind::Magnetometer;

// Longest arc between two star fixes, and between two directions, along which
// one interpolates.
constexpr double kLongestArc_s = 10.0;
constexpr double kLongestTurn_rad = 0.5;
// Directions are coarse: the turn of the Sun is compared with the gyro over
// this long.
constexpr double kSunTurn_s = 2.0;
// Below this sine of the angle between Sun and field, noise moves the axis
// across them.
constexpr double kLeastSine = 0.2;
// Number of sigma by which a third sensor would contradict the accused one, and
// the most that it does as a share of them.
constexpr double kVouched = 6.0;
constexpr double kVouchedShare = 0.25;
// Noise over the stated one from which it contradicts what the mission file
// says of the gyro.
constexpr double kScatter = 10.0;
// A body that has not turned enough for so long will not tell magnetometer and
// orbit apart.
constexpr double kUnturned_s = 30.0;
// So long after a contradiction has begun, other pairs may not show it yet.
constexpr double kUnsettled_s = 4.0;

double squared(double value) { return value * value; }

TurnPerPairError with(const TurnPerError& per_error) {
  TurnPerPairError all = TurnPerPairError::Zero();
  all.leftCols<kFilterErrors>() = per_error;
  return all;
}

/// Returns the small turn from the attitude in which the direction is
/// `expected_body` to the one in which it is `seen_body`.
Vector3d turn_between(const Vector3d& seen_body, const Vector3d& expected_body) {
  return rotation_vector_of(shortest_turn(seen_body, expected_body));
}

/// Returns the information of a direction on the turns across it.
Matrix3d across(const Vector3d& body, double variance_rad2) {
  return information_of({.body = body, .ref = {}, .sigma_rad = std::sqrt(variance_rad2)});
}

}  // namespace

SensorContradictions::SensorContradictions(const ThreeAxisConfig& config)
    : pairs_{{{kStar, kGyro},
              {kSun, kGyro},
              {kStar, kSun},
              {kStar, kField},
              {kSun, kField},
              {kField, kOrbit}}} {
  prior_.topLeftCorner<kFilterErrors, kFilterErrors>() =
      config.alignment.topLeftCorner<kFilterErrors, kFilterErrors>();
  if (config.gyro) {
    prior_.block<3, 3>(GyroBiasError, GyroBiasError) =
        squared(config.gyro->bias_sigma_rad_s) * Matrix3d::Identity();
    stated_noise_rad_s_ = config.gyro->noise_rad_s;
  }
}

void SensorContradictions::turn(const RateSpan& span, double turn_rad2) {
  const Vector3d turn_rad = turned_rad(span, Vector3d::Zero());
  const double change_rad_s = (span.to_rad_s - span.from_rad_s).norm();
  carried_.q_start_body = (carried_.q_start_body * quaternion_by(turn_rad)).normalized();
  carried_.rate_rad_s = span.to_rad_s;
  carried_.turned_rad += turn_rad.norm();
  carried_.noise_rad2 += turn_rad2;
  carried_.change_rad_s += change_rad_s;
  carried_.bend_rad += change_rad_s * span.dt_s / 12.0;
}

void SensorContradictions::note_scatter(TaiTime t, double noise_rad_s) {
  gyro_noise_rad_s_ = noise_rad_s;
  if (is_noisy() || (found_ && found_->culprit == SampleSource::Gyro)) {
    decide(t);
  }
}

void SensorContradictions::add(TaiTime t, const ObservedAttitude& seen) {
  const Fix fix{.t = t, .seen = seen, .carried = carried_};
  const std::optional<Fix> from = std::exchange(fix_, fix);
  const double length_s = from ? elapsed_s(from->t, t) : 0.0;
  if (length_s <= 0.0 || length_s > kLongestArc_s) {
    star_rate_rad_s_.reset();
    return;
  }
  compare_star_and_gyro(*from, fix);
  const Vector3d turned_rad =
      rotation_vector_of(from->seen.q_icrf_body.conjugate() * seen.q_icrf_body);
  const Vector3d rate_rad_s = turned_rad / length_s;
  const std::optional<Vector3d> before_rad_s = std::exchange(star_rate_rad_s_, rate_rad_s);
  if (before_rad_s) {
    const Arc arc{.from = *from,
                  .length_s = length_s,
                  .turned_rad = turned_rad,
                  .change_rad_s = (rate_rad_s - *before_rad_s).norm()};
    for (const auto& direction : {sun_, field_}) {
      if (direction && direction->seen.t >= from->t) {
        compare_star(arc, direction->seen);
      }
    }
  }
  decide(t);
}

void SensorContradictions::add(const SeenDirection& seen) {
  const Direction now{.seen = seen, .carried = carried_};
  if (seen.kind == kField) {
    // The noise includes the field of crust and currents, which does not
    // average out.
    prior_.block<3, 3>(FieldModelError, FieldModelError) =
        squared(seen.direction.sigma_rad) * Matrix3d::Identity();
    field_ = now;
    compare_strength(seen);
  } else {
    if (!sun_begin_ || sun_begin_->carried.losses != carried_.losses) {
      sun_begin_ = now;
    } else if (elapsed_s(sun_begin_->seen.t, seen.t) >= kSunTurn_s) {
      compare_with_gyro(*std::exchange(sun_begin_, now), now);
    }
    if (const auto from = std::exchange(sun_, now); from) {
      compare_with_field(*from, now);
    }
  }
  decide(seen.t);
}

void SensorContradictions::compare_star_and_gyro(const Fix& from, const Fix& to) {
  if (from.carried.losses != to.carried.losses || to.carried.turned_rad == 0.0) {
    return;
  }
  const double length_s = elapsed_s(from.t, to.t);
  const Eigen::Quaterniond by_gyro =
      from.carried.q_start_body.conjugate() * to.carried.q_start_body;
  const Eigen::Quaterniond by_star = from.seen.q_icrf_body.conjugate() * to.seen.q_icrf_body;
  const Vector3d gyro_rad = rotation_vector_of(by_gyro);
  const Matrix3d back = by_gyro.conjugate().toRotationMatrix();
  const double variance_rad2 = squared(from.seen.sigma_rad) + squared(to.seen.sigma_rad) +
                               to.carried.noise_rad2 - from.carried.noise_rad2 +
                               squared(to.carried.bend_rad - from.carried.bend_rad);
  PairComparison compared{.turn_rad = rotation_vector_of(by_gyro.conjugate() * by_star) / length_s,
                          .information = squared(length_s) / variance_rad2 * Matrix3d::Identity(),
                          .freedom = 3,
                          .per_error = with(star_per_error(to.carried.rate_rad_s) -
                                            turned(star_per_error(from.carried.rate_rad_s),
                                                   gyro_rad, back, right_jacobian(gyro_rad))) /
                                       length_s};
  compared.per_error.middleCols<3>(GyroBiasError).setIdentity();
  add(to.t, kStar, kGyro, compared);
}

/// Interpolates the attitude at the direction. A rate that changes between the
/// fixes moves it.
void SensorContradictions::compare_star(const Arc& arc, const SeenDirection& seen) {
  const double part = elapsed_s(arc.from.t, seen.t) / arc.length_s;
  const double gyro_rad = carried_.turned_rad - arc.from.carried.turned_rad;
  if (std::max(arc.turned_rad.norm(), gyro_rad) > kLongestTurn_rad) {
    return;
  }
  const Eigen::Quaterniond q_icrf_body =
      arc.from.seen.q_icrf_body * quaternion_by(part * arc.turned_rad);
  const double bend_rad = arc.change_rad_s * arc.length_s * part * (1.0 - part);
  const Vector3d rate_rad_s = arc.turned_rad / arc.length_s;
  const double variance_rad2 =
      squared(arc.from.seen.sigma_rad) + squared(seen.direction.sigma_rad) + squared(bend_rad);
  if (seen.kind == kField) {
    departure_.add(seen.t, q_icrf_body,
                   seen.direction.body - q_icrf_body.conjugate() * seen.direction.ref,
                   seen.direction.sigma_rad * seen.direction.ref.norm());
  }
  add(seen.t, kStar, seen.kind,
      {.turn_rad = turn_between(seen.direction.body, q_icrf_body.conjugate() * seen.direction.ref),
       .information = across(seen.direction.body, variance_rad2),
       .freedom = 2,
       .per_error = direction_errors(seen, rate_rad_s) - with(star_per_error(rate_rad_s))});
}

void SensorContradictions::compare_with_gyro(const Direction& from, const Direction& to) {
  const double length_s = elapsed_s(from.seen.t, to.seen.t);
  const Eigen::Quaterniond by_gyro =
      from.carried.q_start_body.conjugate() * to.carried.q_start_body;
  if (length_s > kLongestArc_s || to.carried.turned_rad == from.carried.turned_rad) {
    return;
  }
  const Vector3d gyro_rad = rotation_vector_of(by_gyro);
  const Matrix3d back = by_gyro.conjugate().toRotationMatrix();
  const double variance_rad2 = squared(from.seen.direction.sigma_rad) +
                               squared(to.seen.direction.sigma_rad) + to.carried.noise_rad2 -
                               from.carried.noise_rad2 +
                               squared(to.carried.bend_rad - from.carried.bend_rad);
  const TurnPerError at_begin =
      direction_errors(from.seen, from.carried.rate_rad_s).leftCols<kFilterErrors>();
  PairComparison compared{
      .turn_rad =
          turn_between(to.seen.direction.body, by_gyro.conjugate() * from.seen.direction.body) /
          length_s,
      .information = squared(length_s) * across(to.seen.direction.body, variance_rad2),
      .freedom = 2,
      .per_error = (direction_errors(to.seen, to.carried.rate_rad_s) -
                    with(turned(at_begin, gyro_rad, back, right_jacobian(gyro_rad)))) /
                   length_s};
  compared.per_error.middleCols<3>(GyroBiasError).setIdentity();
  add(to.seen.t, kSun, kGyro, compared);
}

/// Interpolates the direction to the Sun at the last field. Only the angle
/// between the two counts.
void SensorContradictions::compare_with_field(const Direction& from, const Direction& to) {
  const double length_s = elapsed_s(from.seen.t, to.seen.t);
  if (!field_ || field_->seen.t < from.seen.t || length_s <= 0.0 || length_s > kLongestArc_s) {
    return;
  }
  const SeenDirection& field = field_->seen;
  const double part = elapsed_s(from.seen.t, field.t) / length_s;
  const Vector3d first = from.seen.direction.body.normalized();
  const Vector3d last = to.seen.direction.body.normalized();
  const double turned_rad =
      std::max(angle_between_rad(first, last), to.carried.turned_rad - from.carried.turned_rad);
  const Vector3d sun = ((1.0 - part) * first + part * last).normalized();
  const Vector3d normal = sun.cross(field.direction.body.normalized());
  if (turned_rad > kLongestTurn_rad || normal.norm() < kLeastSine) {
    return;
  }
  const Vector3d axis = normal.normalized();
  const double bend_rad =
      part * (1.0 - part) *
      (turned_rad * turned_rad + length_s * (to.carried.change_rad_s - from.carried.change_rad_s));
  const double variance_rad2 =
      squared(to.seen.direction.sigma_rad) + squared(field.direction.sigma_rad) + squared(bend_rad);
  SeenDirection between = to.seen;
  between.direction.body = sun;
  const double wider_rad = angle_between_rad(sun, field.direction.body) -
                           angle_between_rad(to.seen.direction.ref, field.direction.ref);
  add(field.t, kSun, kField,
      {.turn_rad = wider_rad * axis,
       .information = axis * axis.transpose() / variance_rad2,
       .freedom = 1,
       .per_error = direction_errors(between, carried_.rate_rad_s) -
                    direction_errors(field, carried_.rate_rad_s)});
}

/// The strength takes the place of a turn about the first axis.
void SensorContradictions::compare_strength(const SeenDirection& field) {
  if (!field.stronger) {
    return;
  }
  const double sigma = field.direction.sigma_rad;
  const Vector3d along = field.direction.body.normalized();
  PairComparison compared{.turn_rad = *field.stronger * sigma * Vector3d::UnitX(),
                          .information = Vector3d{1.0, 0.0, 0.0}.asDiagonal(),
                          .freedom = 1,
                          .per_error = TurnPerPairError::Zero()};
  compared.information /= squared(sigma);
  compared.per_error.row(0).segment<3>(MagnetometerBiasError) = along / field.direction.ref.norm();
  compared.per_error.row(0).segment<3>(FieldModelError) = along;
  add(field.t, kField, kOrbit, compared);
}

TurnPerPairError SensorContradictions::direction_errors(const SeenDirection& seen,
                                                        const Vector3d& rate_rad_s) const {
  const Vector3d along = seen.direction.body.normalized();
  TurnPerPairError per_error =
      with(direction_per_error(seen.kind, seen.direction.ref.norm() * along, rate_rad_s));
  if (seen.kind == kField) {
    per_error.middleCols<3>(FieldModelError) = -cross_matrix(along);
  }
  return per_error;
}

void SensorContradictions::add(TaiTime t, SampleKind one, SampleKind other,
                               const PairComparison& compared) {
  const auto pair = std::find_if(pairs_.begin(), pairs_.end(),
                                 [&](const Pair& is) { return is.has(one) && is.has(other); });
  pair->test.add(t, compared, prior_);
}

void SensorContradictions::decide(TaiTime t) {
  found_ = contradiction_at(t);
  has_found_ = has_found_ || found_;
}

std::optional<SensorContradiction> SensorContradictions::contradiction_at(TaiTime t) {
  const auto worst =
      std::max_element(pairs_.begin(), pairs_.end(), [&](const Pair& a, const Pair& b) {
        const auto weight = [&](const Pair& pair) {
          return pair.test.contradicts(t) ? pair.test.sigmas() : 0.0;
        };
        return weight(a) < weight(b);
      });
  if (!worst->test.contradicts(t)) {
    departure_ = {};
    return scatter(t);
  }
  std::optional<SampleKind> culprit = culprit_of(*worst, t);
  if (!culprit && found_ && found_->culprit && worst->has(kind_of(*found_->culprit))) {
    culprit = kind_of(*found_->culprit);
  }
  SensorContradiction now{.culprit = {},
                          .with = {},
                          .off = {"angle_deg", degrees(worst->test.turn_rad().norm())},
                          .sigmas = worst->test.sigmas(),
                          .since = found_ ? found_->since : t};
  if (culprit) {
    now.culprit = source_of(*culprit);
    for (const Pair& pair : pairs_) {
      if (pair.has(*culprit) && pair.test.contradicts(t)) {
        now.with.push_back(source_of(pair.other(*culprit)));
      }
    }
  } else {
    now.with = {source_of(worst->first), source_of(worst->second)};
  }
  return now;
}

double SensorContradictions::most_sigmas_without(SampleKind kind, TaiTime t) const {
  double most = 0.0;
  for (const Pair& pair : pairs_) {
    if (!pair.has(kind) && pair.test.is_tested(t)) {
      most = std::max(most, pair.test.sigmas());
    }
  }
  return most;
}

/// A third sensor vouches for a sensor if the two agree and would contradict
/// each other if that sensor were as far off as it is accused to be. A wrong
/// rate adds up to a turn. Any direction of the field that agrees vouches for
/// the orbit.
bool SensorContradictions::is_vouched_for(SampleKind kind, const Pair& accused, TaiTime t) const {
  const bool by_rate = accused.has(kGyro);
  const bool by_strength = accused.has(kOrbit);
  return std::any_of(pairs_.begin(), pairs_.end(), [&](const Pair& pair) {
    if (!pair.test.agrees(t) || pair.has(kOrbit)) {
      return false;
    }
    if (by_strength) {
      return kind == kOrbit && pair.has(kField);
    }
    if (!pair.has(kind) || pair.has(accused.other(kind)) || (pair.has(kGyro) && !by_rate)) {
      return false;
    }
    const double rate_to_turn = by_rate && !pair.has(kGyro) ? accused.test.lasting_s() : 1.0;
    const double expected =
        pair.test.sigmas_if(rate_to_turn * accused.test.lasting_turn_rad(),
                            accused.test.weight(prior_) / squared(rate_to_turn), prior_);
    return expected >= kVouched && pair.test.sigmas() <= kVouchedShare * expected;
  });
}

bool SensorContradictions::is_noisy() const {
  return gyro_noise_rad_s_ > kScatter * stated_noise_rad_s_;
}

std::optional<SensorContradiction> SensorContradictions::scatter(TaiTime t) const {
  if (!is_noisy()) {
    return std::nullopt;
  }
  return SensorContradiction{.culprit = source_of(kGyro),
                             .with = {source_of(kGyro)},
                             .off = {"angle_deg", degrees(gyro_noise_rad_s_)},
                             .sigmas = gyro_noise_rad_s_ / stated_noise_rad_s_,
                             .since = found_ ? found_->since : t};
}

/// A magnetometer that is turned measures the right strength.
std::optional<SampleKind> SensorContradictions::field_or_orbit(TaiTime t) const {
  const auto strength =
      std::find_if(pairs_.begin(), pairs_.end(), [](const Pair& pair) { return pair.has(kOrbit); });
  if (!strength->test.is_tested(t) || strength->test.agrees(t)) {
    return kField;
  }
  switch (departure_.whose()) {
    case FieldDeparture::Of::Magnetometer:
      return kField;
    case FieldDeparture::Of::Orbit:
      return kOrbit;
    case FieldDeparture::Of::Unknown:
      break;
  }
  if (found_ && found_->culprit == source_of(kOrbit)) {
    return kOrbit;
  }
  return found_ && elapsed_s(found_->since, t) >= kUnturned_s ? std::optional{kField}
                                                              : std::nullopt;
}

std::optional<SampleKind> SensorContradictions::culprit_of(const Pair& worst, TaiTime t) const {
  if (gyro_unit_is_wrong_ && worst.has(kGyro)) {
    return kGyro;
  }
  for (const double limit : {SensorPair::kAgrees, SensorPair::kContradicts}) {
    const bool first = most_sigmas_without(worst.first, t) <= limit;
    const bool second = most_sigmas_without(worst.second, t) <= limit;
    if (first != second) {
      const SampleKind culprit = first ? worst.first : worst.second;
      return culprit == kField ? field_or_orbit(t) : culprit;
    }
    if (first) {
      break;
    }
  }
  if (!found_ || elapsed_s(found_->since, t) < kUnsettled_s) {
    return std::nullopt;
  }
  const bool first = is_vouched_for(worst.first, worst, t);
  const bool second = is_vouched_for(worst.second, worst, t);
  if (first == second) {
    return std::nullopt;
  }
  return first ? worst.second : worst.first;
}

}  // namespace spindrift
