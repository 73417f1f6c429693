/// Sensors that contradict each other, and the one that is named.

#include "pipelines/three_axis/sensor_contradictions.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>
#include <string>
#include <vector>

#include "pipelines/frames/angle.h"
#include "pipelines/frames/rotation_vector.h"
#include "pipelines/three_axis/attitude_estimator.h"
#include "tests/support/matchers.h"
#include "tests/support/misaligned_pass.h"
#include "tests/support/of_kind.h"

namespace spindrift::testing::sensor_contradictions_test {

using Eigen::Vector3d;

constexpr double kField_nt = 40'000.0;
constexpr double kBegins_s = 40.0;
constexpr int kLong_s = 100;
constexpr auto kAll = {SampleKind::Gyro, SampleKind::Star, SampleKind::Sun,
                       SampleKind::Magnetometer};

/// What is wrong with what a sensor says, from `kBegins_s` on.
struct Fault {
  const char* name;
  SampleKind culprit;
  double within_s;
  std::function<Vector3d(const Vector3d&)> says;  ///< Of what a sensor but the tracker measures.
  double late_s = 0.0;
};
Vector3d as_it_is(const Vector3d& seen) { return seen; }
std::function<Vector3d(const Vector3d&)> turned_by(double deg) {
  return [=](const Vector3d& seen) -> Vector3d {
    return quaternion_by(deg * kRadPerDeg * Vector3d{0.6, -0.48, 0.64}) * seen;
  };
}
Vector3d of_wrong_sign(const Vector3d& seen) { return -seen; }
Vector3d of_wrong_y(const Vector3d& seen) { return {seen.x(), -seen.y(), seen.z()}; }
Vector3d of_swapped_axes(const Vector3d& seen) { return {seen.y(), seen.x(), seen.z()}; }
std::function<Vector3d(const Vector3d&)> times(double factor) {
  return [=](const Vector3d& seen) -> Vector3d { return factor * seen; };
}
std::function<Vector3d(const Vector3d&)> plus(const Vector3d& bias) {
  return [=](const Vector3d& seen) -> Vector3d { return seen + bias; };
}

struct Found {
  std::optional<double> after_s;
  std::string first;  ///< The culprit named first.
  std::string last;
  int names = 0;  ///< Number of different names.
  bool doubted = false;
  double worst_ok = 0.0;
};

std::string text_of(const Found& found) {
  return fmt::format("{} after {:.1f} s, last {}, names {}, worst OK {:.1f}", found.first,
                     found.after_s.value_or(-1.0), found.last, found.names, found.worst_ok);
}

Found fly(const std::vector<SampleKind>& sensors_on_board, const Fault& fault, unsigned seed,
          double most_rad_s = 0.02, int long_s = kLong_s) {
  std::mt19937_64 rng{seed};
  ThreeAxisConfig config = usual_three_axis();
  config.magnetometer = Magnetometer{.noise_nt = 100.0};
  config.alignment = default_alignment().cwiseAbs2().asDiagonal();
  const auto has = [&](SampleKind kind) {
    return std::ranges::find(sensors_on_board, kind) != sensors_on_board.end();
  };
  const TurningBody body = TurningBody::smooth(rng, long_s + 1.0, most_rad_s);
  MisalignedSensors sensors{body, config, drawn(default_alignment(), rng), rng};
  const Vector3d sun = normal_vector(rng, 1.0).normalized();
  const Vector3d field_axis = normal_vector(rng, 1.0).normalized();
  Vector3d field_nt = kField_nt * normal_vector(rng, 1.0).normalized();
  while (std::abs(field_nt.dot(sun)) > 0.8 * kField_nt) {
    field_nt = kField_nt * normal_vector(rng, 1.0).normalized();
  }
  AttitudeEstimator estimator{config};
  AttitudeEstimator::Products products;
  for (int i = 0; i <= long_s * 10; ++i) {
    const double t_s = 0.1 * i;
    const auto is_wrong = [&](SampleKind kind) {
      return fault.culprit == kind && t_s >= kBegins_s;
    };
    const auto when_s = [&](SampleKind kind) { return is_wrong(kind) ? t_s - fault.late_s : t_s; };
    const auto said = [&](SampleKind kind, const Vector3d& seen) {
      return is_wrong(kind) ? fault.says(seen) : seen;
    };
    if (has(SampleKind::Gyro)) {
      GyroSample gyro = sensors.gyro(when_s(SampleKind::Gyro));
      gyro.t = at_s(t_s);
      gyro.rate_body_rad_s = said(SampleKind::Gyro, gyro.rate_body_rad_s);
      estimator.push(gyro, products);
    }
    if (i % 10 == 0 && has(SampleKind::Star)) {
      StarFix fix = sensors.star(when_s(SampleKind::Star));
      fix.t = at_s(t_s);
      // The columns of the tracker's axes are turned as a direction is.
      if (is_wrong(SampleKind::Star)) {
        const Vector3d turn_rad = fault.says(Vector3d::Zero());
        fix.q_icrf_sensor = fix.q_icrf_sensor * quaternion_by(turn_rad);
      }
      estimator.push(fix, products);
    }
    if (i % 10 == 3 && has(SampleKind::Sun)) {
      const Vector3d seen = said(SampleKind::Sun, sensors.sun(when_s(SampleKind::Sun), sun));
      estimator.push(
          SeenDirection{at_s(t_s), SampleKind::Sun, {seen, sun, config.sun_sensor->noise_rad}},
          products);
    }
    if (i % 10 == 6 && has(SampleKind::Magnetometer)) {
      const double noise_nt = config.magnetometer->noise_nt;
      const auto ref_nt = [&](double at) -> Vector3d {
        return quaternion_by(2.3e-3 * at * field_axis) * field_nt;
      };
      const double seen_s = when_s(SampleKind::Magnetometer);
      const Vector3d seen_nt =
          said(SampleKind::Magnetometer, sensors.field_nt(seen_s, ref_nt(seen_s)));
      estimator.push(SeenDirection{.t = at_s(t_s),
                                   .kind = SampleKind::Magnetometer,
                                   .direction = {seen_nt, ref_nt(t_s), noise_nt / kField_nt},
                                   .stronger = (seen_nt.norm() - kField_nt) / noise_nt},
                     products);
    }
  }
  estimator.settle(products);
  Found found;
  for (const AttitudeEstimate& row : of_kind<AttitudeEstimate>(products)) {
    const double t_s = seconds_between(at_s(0.0), row.t);
    if (row.assessment.quality == Quality::Ok) {
      found.worst_ok = std::max(
          found.worst_ok,
          error_rad(row.q_icrf_body, body.q_icrf_body(t_s)).norm() / row.sigma_rad());
    }
    if (row.contradiction) {
      const std::string name = culprit_name_of(*row.contradiction);
      found.names += name != found.last ? 1 : 0;
      found.last = name;
      if (name != "unknown" && !found.after_s) {
        found.first = name;
        found.after_s = t_s - kBegins_s;
      }
    }
  }
  return found;
}

const std::vector<Fault>& faults() {
  using enum SampleKind;
  constexpr auto kField = SampleKind::Magnetometer;
  const auto tracker_turned = [](double deg) {
    return plus(deg * kRadPerDeg * Vector3d{0.6, -0.48, 0.64});
  };
  static const std::vector<Fault> kFaults{
      {"star turned by 2 deg", Star, 30.0, tracker_turned(2.0)},
      {"star turned by 10 deg", Star, 10.0, tracker_turned(10.0)},
      {"star turned by 40 deg", Star, 10.0, tracker_turned(40.0)},
      {"star of the opposite mounting", Star, 10.0, tracker_turned(180.0)},
      {"star late by a second", Star, 60.0, as_it_is, 1.0},
      {"sun turned by 6 deg", Sun, 10.0, turned_by(6.0)},
      {"sun of the wrong sign", Sun, 10.0, of_wrong_sign},
      {"sun of a wrong y", Sun, 10.0, of_wrong_y},
      {"sun of swapped axes", Sun, 10.0, of_swapped_axes},
      {"sun late by a second", Sun, 60.0, as_it_is, 1.0},
      {"field turned by 10 deg", kField, 10.0, turned_by(10.0)},
      {"field of the wrong sign", kField, 10.0, of_wrong_sign},
      {"field of a wrong y", kField, 10.0, of_wrong_y},
      {"field of swapped axes", kField, 10.0, of_swapped_axes},
      {"field in microtesla", kField, 10.0, times(1e-3)},
      {"field biased by 5000 nT", kField, 60.0, plus({3000.0, 3000.0, -3000.0})},
      {"field late by a second", kField, 60.0, as_it_is, 1.0},
      {"gyro of a wrong y", Gyro, 20.0, of_wrong_y},
      {"gyro of the wrong sign", Gyro, 20.0, of_wrong_sign},
      {"gyro of swapped axes", Gyro, 20.0, of_swapped_axes},
      {"gyro in deg/s", Gyro, 20.0, times(kDegPerRad)},
      {"gyro turned by 10 deg", Gyro, 60.0, turned_by(10.0)},
      {"gyro biased by 0.3 deg/s", Gyro, 20.0, plus(0.3 * kRadPerDeg * Vector3d{0.6, -0.48, 0.64})},
      {"gyro late by a second", Gyro, 60.0, as_it_is, 1.0},
  };
  return kFaults;
}

TEST(SensorContradictions, NameTheSensorThatIsWrong) {
  for (const Fault& fault : faults()) {
    for (unsigned seed = 1; seed <= 5; ++seed) {
      const Found found = fly(kAll, fault, seed);
      fmt::print("{} seed {}: {}\n", fault.name, seed, text_of(found));
    }
  }
}

TEST(SensorContradictions, AreNoneWhereErrorsAreAsStated) {
  using enum SampleKind;
  const Fault none{"none", OrbitState, 0.0, as_it_is};
  for (unsigned seed = 1; seed <= 200; ++seed) {
    const Found found = fly(kAll, none, 1000 + seed, seed % 2 == 0 ? 0.03 : 0.003, 60);
    EXPECT_FALSE(found.names > 0) << seed << " " << text_of(found);
  }
}

}  // namespace spindrift::testing::sensor_contradictions_test
