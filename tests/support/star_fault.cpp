#include "tests/support/star_fault.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <variant>

#include "pipelines/frames/angle.h"
#include "pipelines/three_axis/attitude_estimator.h"
#include "tests/support/turning_body.h"

namespace spindrift::testing {
namespace {

using Eigen::Vector3d;

constexpr double kGyro_s = 0.25;
// Noise of 100 nT relative to a field of 40,000 nT.
constexpr double kField_rad = 0.0025;
constexpr double kBeyond = 5.0;

TurningBody body_of(const FaultScene& scene, std::mt19937_64& rng) {
  const TurningBody swaying =
      TurningBody::smooth(rng, scene.duration_s, scene.rate_deg_s * kRadPerDeg);
  const Vector3d slew_rad_s = scene.slew_deg_s * kRadPerDeg * normal_vector(rng, 1.0).normalized();
  return {any_attitude(rng), scene.duration_s,
          [=](double t_s) -> Vector3d { return swaying.rate_rad_s(t_s) + slew_rad_s; }};
}

RowCount counted(const AttitudeEstimator::Products& products, const TurningBody& body,
                 const StarFault& fault) {
  RowCount count;
  for (const ThreeAxisProduct& product : products) {
    const auto* const row = std::get_if<AttitudeEstimate>(&product);
    if (row == nullptr) {
      continue;
    }
    const double t_s = seconds_between(at_s(0.0), row->t);
    const bool is_of_fault = t_s >= fault.from_s && t_s < fault.until_s;
    const bool is_ok = row->assessment.quality == Quality::Ok;
    const double error_sigmas =
        error_rad(row->q_icrf_body, body.q_icrf_body(t_s)).norm() / row->sigma_rad();
    ++count.rows;
    count.rows_of_fault += is_of_fault ? 1 : 0;
    count.lost += row->assessment.quality == Quality::Lost ? 1 : 0;
    if (is_ok) {
      ++count.ok;
      count.ok_of_fault += is_of_fault ? 1 : 0;
      count.ok_beyond += error_sigmas > kBeyond ? 1 : 0;
      count.worst_ok = std::max(count.worst_ok, error_sigmas);
    }
  }
  return count;
}

struct Body {
  const char* name;
  double rate_deg_s;
  double slew_deg_s;
};

struct Beside {
  const char* name;
  bool has_sun;
  bool has_field;
};

struct Fault {
  const char* name;
  double length_s;
  double turned_deg;
};

constexpr double kForGood_s = 1e3;

}  // namespace

RowCount& RowCount::operator+=(const RowCount& more) {
  rows += more.rows;
  ok += more.ok;
  ok_beyond += more.ok_beyond;
  worst_ok = std::max(worst_ok, more.worst_ok);
  rows_of_fault += more.rows_of_fault;
  ok_of_fault += more.ok_of_fault;
  lost += more.lost;
  return *this;
}

RowCount fly(const FaultScene& scene, const StarFault& fault, std::mt19937_64& rng) {
  const ThreeAxisConfig config = usual_three_axis();
  const TurningBody body = body_of(scene, rng);
  Sensors sensors{body, config, rng};
  const Eigen::Quaterniond turned{
      Eigen::AngleAxisd{fault.turned_deg * kRadPerDeg, normal_vector(rng, 1.0).normalized()}};
  const Vector3d sun = normal_vector(rng, 1.0).normalized();
  Vector3d field = normal_vector(rng, 1.0).normalized();
  while (std::abs(field.dot(sun)) > 0.9) {
    field = normal_vector(rng, 1.0).normalized();
  }
  AttitudeEstimator estimator{config};
  AttitudeEstimator::Products products;
  const auto direction = [&](double t_s, SampleKind kind, const Vector3d& ref, double sigma_rad) {
    estimator.push(
        SeenDirection{at_s(t_s), kind, {sensors.direction(t_s, ref, sigma_rad), ref, sigma_rad}},
        products);
  };
  std::optional<StarFix> last;
  for (int i = 0; i < scene.duration_s / kGyro_s; ++i) {
    const double t_s = kGyro_s * i;
    estimator.push(sensors.gyro(t_s), products);
    if (std::fmod(t_s, 1.0) == 0.0) {
      StarFix fix = sensors.star(t_s);
      if (t_s >= fault.from_s && t_s < fault.until_s) {
        const bool is_stuck = fault.turned_deg == 0.0;
        fix.q_icrf_sensor =
            is_stuck ? last.value_or(fix).q_icrf_sensor : turned * fix.q_icrf_sensor;
      }
      last = fix;
      estimator.push(fix, products);
    }
    if (scene.has_sun && std::fmod(t_s, scene.direction_s) == 0.0) {
      direction(t_s, SampleKind::Sun, sun, config.sun_sensor->noise_rad);
    }
    if (scene.has_field &&
        std::fmod(t_s, scene.direction_s) == 0.5 * std::min(1.0, scene.direction_s)) {
      direction(t_s, SampleKind::Magnetometer, field, kField_rad);
    }
  }
  estimator.settle(products);
  return counted(products, body, fault);
}

void expect_honest_rows(int passes_of_each) {
  std::mt19937_64 rng{4300};
  std::uniform_real_distribution<double> from_s{2.0, 80.0};
  for (const Beside& beside :
       {Beside{"gyro alone", false, false}, Beside{"gyro and Sun", true, false},
        Beside{"gyro, Sun and field", true, true}}) {
    for (const Fault& fault :
         {Fault{"stuck for 30 s", 30.0, 0.0}, Fault{"stuck for 90 s", 90.0, 0.0},
          Fault{"5 deg off for 30 s", 30.0, 5.0}, Fault{"5 deg off for good", kForGood_s, 5.0},
          Fault{"40 deg off for good", kForGood_s, 40.0}}) {
      RowCount of_all;
      for (const Body& body :
           {Body{"0.002 deg/s", 0.0005, 0.002}, Body{"up to 0.05 deg/s", 0.05, 0.0},
            Body{"a slew of 0.5 deg/s", 0.05, 0.5}, Body{"a slew of 1 deg/s", 0.05, 1.0}}) {
        SCOPED_TRACE(fmt::format("{}, {}, tracker {}", body.name, beside.name, fault.name));
        RowCount count;
        for (int pass = 0; pass < passes_of_each; ++pass) {
          const double begin_s = from_s(rng);
          count += fly({.rate_deg_s = body.rate_deg_s,
                        .slew_deg_s = body.slew_deg_s,
                        .has_sun = beside.has_sun,
                        .has_field = beside.has_field},
                       {begin_s, begin_s + fault.length_s, fault.turned_deg}, rng);
        }
        EXPECT_EQ(count.ok_beyond, 0) << count.worst_ok;
        of_all += count;
      }
      if (beside.has_sun && beside.has_field) {
        EXPECT_GE(of_all.ok, 0.6 * of_all.rows) << fault.name;
        EXPECT_GE(of_all.ok_of_fault, 0.6 * of_all.rows_of_fault) << fault.name;
        EXPECT_EQ(of_all.lost, 0) << fault.name;
      }
      ::testing::Test::RecordProperty(
          fmt::format("{}, tracker {}", beside.name, fault.name),
          fmt::format("OK {:.0f} %, while it lasts {:.0f} %, at worst {:.2f} sigma",
                      100.0 * of_all.ok / of_all.rows,
                      100.0 * of_all.ok_of_fault / of_all.rows_of_fault, of_all.worst_ok));
    }
  }
}

}  // namespace spindrift::testing
