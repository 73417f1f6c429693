/// @file
/// A pass of the attitude estimator with the sensors that a test selects.

#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <initializer_list>
#include <random>
#include <vector>

#include "pipelines/frames/angle.h"
#include "pipelines/frames/rotation_vector.h"
#include "pipelines/three_axis/attitude_estimator.h"
#include "tests/support/matchers.h"
#include "tests/support/of_kind.h"
#include "tests/support/turning_body.h"

namespace spindrift::testing {

inline const Eigen::Vector3d kNone = Eigen::Vector3d::Zero();
/// Rotation in ICRF of the fixes of a tracker that is turned.
inline const Eigen::Vector3d kTurned_rad{0.05, -0.05, 0.05};

/// Simulates a pass of two minutes with the sensors that a test selects.
class EstimatedAttitude : public ::testing::Test {
 protected:
  using enum SampleKind;
  using Vector3d = Eigen::Vector3d;

  static constexpr double kLong_s = 120.0;
  static constexpr double kDirection_rad = 0.5 * kRadPerDeg;  // The sun sensor's noise.

  template <class Sample>
  void push(const Sample& sample) {
    estimator_.push(sample, products_);
  }
  void gyro(double t_s) { push(sensors_.gyro(t_s)); }
  /// @param off_rad Rotation of the fix in ICRF.
  void star(double t_s, const Vector3d& off_rad = kNone) {
    StarFix fix = sensors_.star(t_s);
    fix.q_icrf_sensor = quaternion_by(off_rad) * fix.q_icrf_sensor;
    push(fix);
  }
  void see(double t_s, SampleKind kind, const Vector3d& body) {
    push(SeenDirection{
        .t = at_s(t_s),
        .kind = kind,
        .direction = {.body = body, .ref = ref_icrf(kind), .sigma_rad = kDirection_rad}});
  }
  /// @param turned Rotation in ICRF of the body that sees the direction.
  void direction(double t_s, SampleKind kind,
                 const Eigen::Quaterniond& turned = Eigen::Quaterniond::Identity()) {
    see(t_s, kind, sensors_.direction(t_s, turned.conjugate() * ref_icrf(kind), kDirection_rad));
  }
  void sun(double t_s) { direction(t_s, Sun); }
  void field(double t_s) { direction(t_s, Magnetometer); }

  /// Pushes the gyro at 10 Hz from 0.1 s after `from_s` on and calls `at_second` at whole seconds
  /// after it.
  void run(double from_s, double to_s, const std::function<void(double)>& at_second) {
    for (int i = static_cast<int>(std::lround(from_s * 10.0)) + 1; i <= std::lround(to_s * 10.0);
         ++i) {
      gyro(0.1 * i);
      if (i % 10 == 0) {
        at_second(0.1 * i);
      }
    }
  }

  /// Gives a sample of each of these sensors once a second.
  void run(double from_s, double to_s, std::initializer_list<SampleKind> at_second,
           const Vector3d& star_off_rad = kNone) {
    run(from_s, to_s, [&](double t_s) {
      for (const SampleKind kind : at_second) {
        kind == Star ? star(t_s, star_off_rad) : direction(t_s, kind);
      }
    });
  }
  void begin(const Vector3d& star_off_rad = kNone) {
    gyro(0.0);
    star(0.0, star_off_rad);
  }
  /// Begins with a star fix, and has one a second.
  void track_stars(double to_s) {
    begin();
    run(0.0, to_s, {Star});
  }

  const Vector3d& ref_icrf(SampleKind kind) const { return kind == Sun ? sun_icrf_ : field_icrf_; }
  std::vector<AttitudeEstimate> estimates() const { return of_kind<AttitudeEstimate>(products_); }
  AttitudeEstimate last() const { return estimates().back(); }
  Quality quality() const { return last().assessment.quality; }
  bool says(ReasonCode code) const { return has(last().assessment, code); }
  std::vector<Quality> qualities() const {
    std::vector<Quality> qualities;
    for (const AttitudeEstimate& row : estimates()) {
      qualities.push_back(row.assessment.quality);
    }
    return qualities;
  }
  double seconds_of(const AttitudeEstimate& estimate) const {
    return seconds_between(at_s(0.0), estimate.t);
  }
  double error_deg(const AttitudeEstimate& estimate) const {
    const double t_s = std::round(seconds_of(estimate) * 1e3) * 1e-3;
    return degrees(error_rad(estimate.q_icrf_body, body_.q_icrf_body(t_s)).norm());
  }
  double error_deg() const { return error_deg(last()); }
  double sigma_deg() const { return degrees(last().sigma_rad()); }
  auto rejected(SampleKind kind, Rejection by) const {
    return std::ranges::count_if(
        of_kind<RejectedSample>(products_),
        [&](const RejectedSample& one) { return one.kind == kind && one.rejected_by == by; });
  }
  const SensorHealth& health(SampleKind kind) const {
    return estimator_.sensors().at(index_of(kind));
  }

  std::mt19937_64 rng_{81};
  ThreeAxisConfig config_ = usual_three_axis();
  TurningBody body_ = TurningBody::smooth(rng_, kLong_s, 2.0 * kRadPerDeg);
  Sensors sensors_{body_, config_, rng_};
  Vector3d sun_icrf_ = Vector3d{0.3, -0.8, 0.5}.normalized();
  Vector3d field_icrf_ = Vector3d{0.9, 0.4, 0.1}.normalized();
  AttitudeEstimator estimator_{config_};
  AttitudeEstimator::Products products_;
};

}  // namespace spindrift::testing
