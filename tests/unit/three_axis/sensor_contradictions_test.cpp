/// Sensors that contradict each other, and the one that is named.

#include "pipelines/three_axis/sensor_contradictions.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

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
/// Errors that change their sign as the body turns to and fro need not be
/// named.
constexpr double kSometime_s = 1e9;
constexpr auto kAll = {SampleKind::Gyro, SampleKind::Star, SampleKind::Sun,
                       SampleKind::Magnetometer};

/// What is wrong with what a sensor says, from `kBegins_s` on.
struct Fault {
  const char* name;
  SampleKind culprit;
  double within_s;
  std::function<Vector3d(const Vector3d&)> says;  ///< Of what a sensor but the tracker measures.
  double late_s = 0.0;
  double most_rad_s = 0.02;  ///< Largest rate of the body about each axis.
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

std::function<Vector3d(const Vector3d&)> noisy(double sigma) {
  return [rng = std::mt19937_64{9}, sigma](const Vector3d& seen) mutable -> Vector3d {
    return seen + normal_vector(rng, sigma);
  };
}
Vector3d of_another_place(const Vector3d& field) { return 0.9 * turned_by(15.0)(field); }

struct Found {
  std::vector<std::string> names = {};  ///< Of the culprits, in the order of naming.
  std::vector<std::string> with = {};   ///< What contradicts the last one.
  std::optional<double> after_s = {};   ///< From the fault to the first name but `unknown`.
  double worst_ok = 0.0;                ///< Error of OK rows in sigma, but for the 1.5 s that
                                        ///< the fault needs to show.
};

std::string text_of(const Found& found) {
  return fmt::format("{} after {:.1f} s, worst OK {:.1f} sigma", fmt::join(found.names, ", "),
                     found.after_s.value_or(-1.0), found.worst_ok);
}

Found fly(const std::vector<SampleKind>& sensors_on_board, const Fault& fault, unsigned seed,
          int long_s = kLong_s) {
  std::mt19937_64 rng{seed};
  ThreeAxisConfig config = usual_three_axis();
  config.magnetometer = Magnetometer{.noise_nt = 100.0};
  config.alignment = default_alignment().cwiseAbs2().asDiagonal();
  const auto has = [&](SampleKind kind) {
    return std::ranges::find(sensors_on_board, kind) != sensors_on_board.end();
  };
  const TurningBody body = TurningBody::smooth(rng, long_s + 1.0, fault.most_rad_s);
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
      const Vector3d model_nt = said(SampleKind::OrbitState, ref_nt(t_s));
      const double seen_s = when_s(SampleKind::Magnetometer);
      const Vector3d seen_nt =
          said(SampleKind::Magnetometer, sensors.field_nt(seen_s, ref_nt(seen_s)));
      estimator.push(SeenDirection{.t = at_s(t_s),
                                   .kind = SampleKind::Magnetometer,
                                   .direction = {seen_nt, model_nt, noise_nt / model_nt.norm()},
                                   .stronger = (seen_nt.norm() - model_nt.norm()) / noise_nt},
                     products);
    }
  }
  estimator.settle(products);
  Found found;
  for (const AttitudeEstimate& row : of_kind<AttitudeEstimate>(products)) {
    const double t_s = seconds_between(at_s(0.0), row.t);
    if (row.assessment.quality == Quality::Ok && std::abs(t_s - kBegins_s - 0.75) > 0.75) {
      found.worst_ok =
          std::max(found.worst_ok,
                   error_rad(row.q_icrf_body, body.q_icrf_body(t_s)).norm() / row.sigma_rad());
    }
    if (!row.contradiction) {
      continue;
    }
    const std::string name = culprit_name_of(*row.contradiction);
    found.with = opponents_of(*row.contradiction);
    if (found.names.empty() || found.names.back() != name) {
      found.names.push_back(name);
    }
    if (name != "unknown" && !found.after_s) {
      found.after_s = t_s - kBegins_s;
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
      {"star turned by 2 deg", Star, 60.0, tracker_turned(2.0)},
      {"star turned by 10 deg", Star, 10.0, tracker_turned(10.0)},
      {"star turned by 40 deg", Star, 10.0, tracker_turned(40.0)},
      {"star of the opposite mounting", Star, 10.0, tracker_turned(180.0)},
      {"star late by a second", Star, kSometime_s, as_it_is, 1.0, 0.06},
      {"sun turned by 6 deg", Sun, 10.0, turned_by(6.0)},
      {"sun of the wrong sign", Sun, 10.0, of_wrong_sign},
      {"sun of a wrong y", Sun, 40.0, of_wrong_y},
      {"sun of swapped axes", Sun, 10.0, of_swapped_axes},
      {"sun late by a second", Sun, kSometime_s, as_it_is, 1.0, 0.06},
      {"field turned by 10 deg", kField, 10.0, turned_by(10.0)},
      {"field of the wrong sign", kField, 10.0, of_wrong_sign},
      {"field of a wrong y", kField, 40.0, of_wrong_y},
      {"field of swapped axes", kField, 10.0, of_swapped_axes},
      {"field in microtesla", kField, 10.0, times(1e-3)},
      {"field biased by 5000 nT", kField, 60.0, plus({3000.0, 3000.0, -3000.0})},
      {"field late by a second", kField, kSometime_s, as_it_is, 1.0, 0.06},
      {"orbit of another place", OrbitState, 60.0, of_another_place, 0.0, 0.06},
      {"gyro of a wrong y", Gyro, kSometime_s, of_wrong_y},
      {"gyro of the wrong sign", Gyro, kSometime_s, of_wrong_sign},
      {"gyro of swapped axes", Gyro, kSometime_s, of_swapped_axes},
      {"gyro in deg/s", Gyro, 10.0, times(kDegPerRad)},
      {"gyro noisy", Gyro, 30.0, noisy(0.5 * kRadPerDeg)},
      {"gyro turned by 30 deg", Gyro, kSometime_s, turned_by(30.0)},
      {"gyro biased by 0.3 deg/s", Gyro, kSometime_s,
       plus(0.3 * kRadPerDeg * Vector3d{0.6, -0.48, 0.64})},
      {"gyro late by a second", Gyro, kSometime_s, as_it_is, 1.0, 0.06},
  };
  return kFaults;
}

TEST(SensorContradictions, NameTheSensorThatIsWrong) {
  for (const Fault& fault : faults()) {
    for (unsigned seed = 1; seed <= 2; ++seed) {
      const Found found = fly(kAll, fault, seed);
      const std::string text = fmt::format("{}, seed {}: {}", fault.name, seed, text_of(found));
      EXPECT_LE(found.after_s.value_or(1e9), fault.within_s) << text;
      EXPECT_THAT(found.names,
                  Each(::testing::AnyOf("unknown", sensor_name_of(source_of(fault.culprit)))))
          << text;
      EXPECT_LT(found.worst_ok, 5.0) << text;
    }
  }
}

TEST(SensorContradictions, NameBothWhereNothingTellsWhichIsWrong) {
  using enum SampleKind;
  const auto expect_both = [](const std::vector<SampleKind>& on_board, const Fault& fault) {
    const Found found = fly(on_board, fault, 7);
    EXPECT_THAT(found.names, ElementsAre("unknown")) << fault.name;
    EXPECT_THAT(found.with,
                ElementsAre(std::string{name_of(on_board[0])}, std::string{name_of(on_board[1])}))
        << fault.name;
  };
  expect_both({Star, Gyro}, {"gyro of the wrong sign", Gyro, 0.0, of_wrong_sign});
  expect_both({Star, Sun}, {"sun turned", Sun, 0.0, turned_by(10.0)});
  expect_both({Star, Sun, Gyro}, {"sun turned", Sun, 0.0, turned_by(10.0)});
}

TEST(SensorContradictions, AreNoneWhereErrorsAreAsStated) {
  using enum SampleKind;
  for (unsigned seed = 1; seed <= 200; ++seed) {
    const Fault none{"none", OrbitState, 0.0, as_it_is, 0.0, seed % 2 == 0 ? 0.03 : 0.003};
    const Found found = fly(kAll, none, 1000 + seed, 60);
    EXPECT_THAT(found.names, IsEmpty()) << seed << " " << text_of(found);
  }
}

}  // namespace spindrift::testing::sensor_contradictions_test
