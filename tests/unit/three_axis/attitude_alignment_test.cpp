/// What errors of the mission file do to an attitude is in its covariance.

#include <Eigen/Dense>
#include <random>

#include "pipelines/frames/angle.h"
#include "pipelines/frames/rotation_vector.h"
#include "pipelines/three_axis/three_axis_pass.h"
#include "tests/support/matchers.h"
#include "tests/support/misaligned_pass.h"
#include "tests/support/of_kind.h"

namespace spindrift::testing::attitude_alignment_test {

using Eigen::Matrix3d;
using Eigen::Vector3d;

const AlignmentErrors kExact = AlignmentErrors::Zero();
constexpr MisalignedScene kStar{
    .star = true, .sun = false, .field = false, .most_rad_s = 0.03, .duration_s = 60};
constexpr MisalignedScene kStarAndSun{
    .star = true, .sun = true, .field = false, .most_rad_s = 0.01, .duration_s = 200};
constexpr MisalignedScene kSunAndField{
    .star = false, .sun = true, .field = true, .most_rad_s = 0.03, .duration_s = 60};

MisalignedPass flown(const MisalignedScene& scene, const AlignmentErrors& errors,
                     const AlignmentErrors& alignment) {
  std::mt19937_64 rng{4620};
  return fly(scene, errors, alignment, rng);
}

Eigen::Matrix<double, 6, 1> difference(const Mekf& from, const Mekf& to) {
  Eigen::Matrix<double, 6, 1> difference;
  difference << error_rad(from.q_icrf_body(), to.q_icrf_body()),
      to.bias_rad_s() - from.bias_rad_s();
  return difference;
}

/// Expects what each error adds to the covariance to be the square of the change that it makes, but
/// for a hundredth of the noise.
void expect_changes_in_covariance(const MisalignedScene& scene) {
  const AlignmentErrors sigmas = default_alignment();
  const MisalignedPass exact = flown(scene, kExact, kExact);
  const Mekf& filter = exact.estimator.filter().value();
  for (int i = 0; i < kFilterErrors; ++i) {
    AlignmentErrors error = kExact;
    error[i] = 0.1 * sigmas[i];
    const MisalignedPass off = flown(scene, error, kExact);
    const MisalignedPass told = flown(scene, kExact, error);
    const Eigen::Matrix<double, 6, 1> change = difference(*off.estimator.filter(), filter);
    const Mekf::Covariance added = told.estimator.filter()->covariance() - filter.covariance();
    const Mekf::Covariance expected = change * change.transpose();
    const auto expect_same = [&](int block) {
      const Matrix3d of_change = expected.block<3, 3>(block, block);
      const Matrix3d of_noise = filter.covariance().block<3, 3>(block, block);
      EXPECT_LE((added.block<3, 3>(block, block) - of_change).norm(),
                0.02 * of_change.norm() + 1e-4 * of_noise.norm())
          << kAttitudeAlignmentNames.at(static_cast<std::size_t>(i)).name << " " << block;
    };
    expect_same(0);
    expect_same(3);
  }
}

TEST(AttitudeAlignment, OfStarFixesTheCovarianceHasWhatEachErrorChanges) {
  expect_changes_in_covariance(kStar);
}

TEST(AttitudeAlignment, OfSunAndFieldTheCovarianceHasWhatEachErrorChanges) {
  expect_changes_in_covariance(kSunAndField);
}

/// A body that turns takes the error of its attitude along between two fixes; one at rest does not.
TEST(AttitudeAlignment, OfAStarTrackerAloneItsMountingIsAddedAsItIs) {
  std::mt19937_64 rng{4621};
  Matrix3d root;
  root << 1.0, 0.5, -0.2, 0.0, 0.0, 0.0, 0.3, -0.4, 2.0;
  const Matrix3d mounting_rad2 = 1e-8 * root.transpose() * root;
  ThreeAxisConfig config = usual_three_axis();
  const ThreeAxisConfig exact = config;
  config.alignment.block<3, 3>(StarTrackerError, StarTrackerError) = mounting_rad2;
  const TurningBody body = TurningBody::smooth(rng, 31.0, 0.0);
  Sensors sensors{body, config, rng};
  AttitudeEstimator told{config};
  AttitudeEstimator untold{exact};
  AttitudeEstimator::Products products;
  for (int i = 0; i <= 120; ++i) {
    const GyroSample gyro = sensors.gyro(0.25 * i);
    told.push(gyro, products);
    untold.push(gyro, products);
    if (i % 4 == 0) {
      const StarFix fix = sensors.star(0.25 * i);
      told.push(fix, products);
      untold.push(fix, products);
    }
  }
  const Matrix3d noise_rad2 = untold.filter()->attitude_covariance_rad2();
  EXPECT_EQ(told.filter()->attitude_noise_rad2(), noise_rad2);
  EXPECT_LT((told.filter()->attitude_covariance_rad2() - noise_rad2 - mounting_rad2).norm(),
            1e-3 * mounting_rad2.norm());
  EXPECT_EQ(told.filter()->q_icrf_body().coeffs(), untold.filter()->q_icrf_body().coeffs());
}

TEST(AttitudeAlignment, NoiseSigmaIsThatOfAnExactFile) {
  const AlignmentErrors stated = default_alignment();
  const AttitudeEstimate told = flown(kStar, kExact, stated).rows.back().estimate;
  const AttitudeEstimate exact = flown(kStar, kExact, kExact).rows.back().estimate;
  EXPECT_DOUBLE_EQ(exact.noise_sigma_rad, exact.sigma_rad());
  EXPECT_DOUBLE_EQ(told.noise_sigma_rad, exact.sigma_rad());
  EXPECT_GT(told.sigma_rad(), std::sqrt(3.0) * 0.01 * kRadPerDeg);
}

std::string key_of(const AttitudeEstimate& estimate) {
  for (const Reason& reason : estimate.assessment.reasons) {
    if (reason.code == ReasonCode::AlignmentOff) {
      return std::get<std::string>(reason.values.front().value);
    }
  }
  return {};
}

TEST(AttitudeAlignment, AConstantDifferenceIsDoubtedWhereItIsBeyondWhatIsStated) {
  for (const double deg : {0.4, 3.0}) {
    AlignmentErrors error = kExact;
    error.segment<3>(SunSensorError).setConstant(deg / std::sqrt(3.0) * kRadPerDeg);
    const MisalignedPass pass = flown(kStarAndSun, error, default_alignment());
    const AttitudeEstimate& last = pass.rows.back().estimate;
    EXPECT_EQ(last.assessment.quality, deg < 1.0 ? Quality::Ok : Quality::Doubtful) << deg;
    EXPECT_EQ(key_of(last), deg < 1.0 ? "" : "three_axis.alignment.sun_sensor_deg") << deg;
    EXPECT_LT(pass.rows.back().sigmas(), 3.0);
  }
}

TEST(AttitudeAlignment, AGyroScaleIsDoubtedWhereItIsBeyondWhatIsStated) {
  for (const double scale : {0.002, 0.02}) {
    AlignmentErrors error = kExact;
    error.segment<3>(GyroScaleError).setConstant(scale);
    const MisalignedPass pass = flown(kStarAndSun, error, default_alignment());
    const AttitudeEstimate& last = pass.rows.back().estimate;
    EXPECT_EQ(last.assessment.quality, scale < 0.01 ? Quality::Ok : Quality::Doubtful) << scale;
    EXPECT_EQ(key_of(last), scale < 0.01 ? "" : "three_axis.alignment.gyro_scale") << scale;
    for (const JudgedAttitude& row : pass.rows) {
      EXPECT_TRUE(!row.is_ok() || row.sigmas() < 4.0) << row.t_s;
    }
  }
}

/// A star tracker alone has no residual of its mounting; it is in the sigma.
TEST(AttitudeAlignment, AMisplacedStarTrackerAloneIsInTheSigma) {
  AlignmentErrors error = kExact;
  error[StarTrackerError] = 0.05 * kRadPerDeg;
  for (const JudgedAttitude& row : flown(kStar, error, default_alignment()).rows) {
    EXPECT_NEAR(row.sigmas(), 0.05 / (std::sqrt(3.0) * 0.01), 1.2) << row.t_s;
  }
}

/// The noise of the gyro is in the measured turn and moves the attitude as a scale error would.
TEST(AttitudeAlignment, TheNoiseOfAGyroOnASteadyBodyIsNoErrorOfItsScale) {
  std::mt19937_64 rng{4623};
  ThreeAxisConfig config = usual_three_axis();
  config.gyro->noise_rad_s = 0.01 * kRadPerDeg;
  config.alignment = default_alignment().cwiseAbs2().asDiagonal();
  const TurningBody body{any_attitude(rng), 1001.0, [](double) {
                           return Vector3d{0.001, -0.0005, 0.0};
                         }};
  Sensors sensors{body, config, rng};
  AttitudeEstimator estimator{config};
  AttitudeEstimator::Products products;
  for (int i = 0; i <= 4000; ++i) {
    estimator.push(sensors.gyro(0.25 * i), products);
    if (i % 4 == 0) {
      estimator.push(sensors.star(0.25 * i), products);
    }
  }
  for (const AttitudeEstimate& row : of_kind<AttitudeEstimate>(products)) {
    ASSERT_FALSE(has(row.assessment, ReasonCode::AlignmentOff)) << key_of(row);
  }
  const AlignmentEvidence& evidence = estimator.filter()->evidence();
  const Vector3d scale = evidence.score().segment<3>(GyroScaleError);
  const Matrix3d information = evidence.information().block<3, 3>(GyroScaleError, GyroScaleError);
  EXPECT_LT(scale.dot(information.ldlt().solve(scale)), 25.0);
}

TEST(AttitudeAlignment, APassSaysWhatItKnowsOfTheErrorsByName) {
  std::mt19937_64 rng{4622};
  AlignmentErrors error = kExact;
  error[SunSensorError + 1] = 0.5 * kRadPerDeg;
  const ThreeAxisConfig config = usual_three_axis();
  const TurningBody body{any_attitude(rng), 301.0, [](double) {
                           return Vector3d{0.02, 0.01, -0.01};
                         }};
  MisalignedSensors sensors{body, config, error, rng};
  ThreeAxisPass pass{config, std::nullopt};
  EXPECT_TRUE(pass.normal_equations().n.isZero());
  const Vector3d sun = ApparentSun{}.direction_icrf(
      at_s(0.0), {.position_icrf_km = Vector3d::Zero(), .velocity_icrf_km_s = Vector3d::Zero()});
  for (int i = 0; i <= 3000; ++i) {
    pass.push(sensors.gyro(0.1 * i));
    if (i % 10 == 0) {
      pass.push(sensors.star(0.1 * i));
      pass.push(SunDirection{at_s(0.1 * i), sensors.sun(0.1 * i, sun)});
    }
  }
  pass.finish();
  const NormalEquations equations = pass.normal_equations();
  ASSERT_EQ(equations.names.size(), 17U);
  EXPECT_EQ(equations.names[4], "sun_sensor_y_deg");
  EXPECT_EQ(equations.names[6], "gyro_scale_x");
  EXPECT_EQ(equations.names[16], "sun_sensor_time_tag_s");
  EXPECT_TRUE(equations.b0.isZero());
  // All but the mounting of the sun sensor is known.
  const Matrix3d covariance_deg2 = equations.n.block<3, 3>(3, 3).inverse();
  const Vector3d off_deg = covariance_deg2 * equations.g.segment<3>(3) - Vector3d{0.0, 0.5, 0.0};
  EXPECT_LT(off_deg.dot(covariance_deg2.inverse() * off_deg), 16.0);
  EXPECT_LT(std::sqrt(covariance_deg2(1, 1)), 0.1);
}

}  // namespace spindrift::testing::attitude_alignment_test
