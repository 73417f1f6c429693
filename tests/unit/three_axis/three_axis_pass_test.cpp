#include "pipelines/three_axis/three_axis_pass.h"

#include <random>

#include "pipelines/ephemeris/kepler_orbit.h"
#include "pipelines/frames/angle.h"
#include "pipelines/geomagnetism/main_field.h"
#include "pipelines/observation/innovation_gate.h"
#include "services/mission/igrf.h"
#include "tests/support/assessed.h"
#include "tests/support/matchers.h"
#include "tests/support/of_kind.h"
#include "tests/support/stepped_orbit.h"
#include "tests/support/turning_body.h"

namespace spindrift::testing::three_axis_pass_test {

/// Returns a state on the Sun's side of the Earth or behind it.
TimedOrbitState state_towards(const Eigen::Vector3d& sun_icrf, double side) {
  const Eigen::Vector3d position_km = side * 7000.0 * sun_icrf;
  return {.t = at_s(-10.0),
          .state = {.position_icrf_km = position_km,
                    .velocity_icrf_km_s = 7.5 * position_km.unitOrthogonal()}};
}

class ThreeAxisPassTest : public ::testing::Test {
 protected:
  void add(ThreeAxisOutput output) {
    std::move(output.products.begin(), output.products.end(), std::back_inserter(products_));
    std::move(output.notices.begin(), output.notices.end(), std::back_inserter(notices_));
  }
  void gyro(double from_s, double to_s) {
    for (double t_s = from_s; t_s < to_s; t_s += 0.25) {
      add(pass_.push(sensors_.gyro(t_s)));
    }
  }
  SunDirection sun(double t_s) {
    return {.t = at_s(t_s),
            .sun_body = sensors_.direction(t_s, sun_icrf_, config_.sun_sensor->noise_rad)};
  }
  std::vector<RejectedSample> rejected() const { return of_kind<RejectedSample>(products_); }
  std::vector<Rejection> reasons() const {
    std::vector<Rejection> out;
    for (const RejectedSample& sample : rejected()) {
      out.push_back(sample.rejected_by);
    }
    return out;
  }
  std::size_t estimates() const { return of_kind<AttitudeEstimate>(products_).size(); }
  AttitudeEstimate last() const { return of_kind<AttitudeEstimate>(products_).back(); }

  std::mt19937_64 rng_{91};
  ThreeAxisConfig config_ = usual_three_axis();
  TurningBody body_ = TurningBody::smooth(rng_, 60.0, 0.02);
  Sensors sensors_{body_, config_, rng_};
  Eigen::Vector3d sun_icrf_ = -earth_motion(at_s(0.0)).heliocentric_icrf_km.normalized();
  ThreeAxisPass pass_{config_, std::nullopt};
  std::vector<ThreeAxisProduct> products_;
  std::vector<Notice> notices_;
};

TEST_F(ThreeAxisPassTest, ComputesWhatIsASecondOld) {
  add(pass_.push(sensors_.star(0.0)));
  gyro(0.0, 1.0);
  EXPECT_EQ(estimates(), 0U);
  gyro(1.0, 1.25);
  EXPECT_EQ(estimates(), 1U);
}

TEST_F(ThreeAxisPassTest, StarSunAndGyroMakeAnAttitude) {
  for (int second = 0; second < 40; ++second) {
    add(pass_.push(sensors_.star(second)));
    add(pass_.push(sun(second)));
    gyro(second, second + 1.0);
  }
  add(pass_.finish());
  EXPECT_EQ(last().assessment.quality, Quality::Ok);
  EXPECT_LT(degrees(error_rad(last().q_icrf_body, body_.q_icrf_body(39.75)).norm()), 0.01);
  EXPECT_THAT(rejected(), IsEmpty());
  EXPECT_THAT(notices_, IsEmpty());
  EXPECT_EQ(pass_.sensors().at(index_of(SampleKind::Sun)).accepted, 40);
  EXPECT_EQ(pass_.sensors().at(index_of(SampleKind::Gyro)).last_seen, at_s(39.75));
}

TEST_F(ThreeAxisPassTest, AGyroAtItsRangeIsSaidOnceWithTheRangeOfTheMission) {
  config_.gyro->range_rad_s = 0.01;
  pass_ = ThreeAxisPass{config_, std::nullopt};
  for (int i = 0; i < 60; ++i) {
    add(pass_.push(GyroSample{.t = at_s(0.25 * i), .rate_body_rad_s = {0.0, 0.02, 0.0}}));
  }
  add(pass_.finish());
  ASSERT_FALSE(notices_.empty());
  EXPECT_EQ(notices_.front(), (Notice{NoticeCode::MostLeftOut,
                                      {{"sensor", std::string{"gyro"}},
                                       {"percent", 100.0},
                                       {"rejected_by", std::string{"saturated"}},
                                       {"rate_deg_s", degrees(0.02)},
                                       {"range_deg_s", degrees(0.01)}}}));
}

TEST_F(ThreeAxisPassTest, LateSamplesAreLeftOutAndSaidOnce) {
  gyro(0.0, 10.0);
  add(pass_.push(sensors_.star(5.0)));
  add(pass_.push(sensors_.star(6.0)));
  EXPECT_THAT(reasons(), ElementsAre(Rejection::Late, Rejection::Late));
  EXPECT_EQ(rejected().front().kind, SampleKind::Star);
  EXPECT_THAT(notices_, ElementsAre(Notice{NoticeCode::LateSamples, {}}));
  EXPECT_EQ(pass_.sensors().at(index_of(SampleKind::Star)).rejected, 2);
}

TEST_F(ThreeAxisPassTest, LeavesOutTheSensorThatAnOperatorExcludes) {
  pass_.act(at_s(10.0), ExcludeChannel<SampleKind>{SampleKind::Star});
  pass_.act(at_s(0.0),
            ExcludeSegment<SampleKind>{.from = at_s(5.0), .to = at_s(7.0), .channel = {}});
  for (int second = 0; second < 20; ++second) {
    add(pass_.push(sensors_.star(second)));
    add(pass_.push(sensors_.gyro(second)));
  }
  add(pass_.finish());
  for (const RejectedSample& sample : rejected()) {
    EXPECT_EQ(sample.rejected_by, Rejection::Operator);
    EXPECT_TRUE(sample.t < at_s(7.0) || sample.kind == SampleKind::Star);
  }
  EXPECT_THAT(rejected(), SizeIs(2 + 2 + 10));
}

TEST_F(ThreeAxisPassTest, RepeatedSamplesChangeNothing) {
  ThreeAxisPass once{config_, std::nullopt};
  ThreeAxisPass twice{config_, std::nullopt};
  std::vector<ThreeAxisProduct> from_once;
  std::vector<ThreeAxisProduct> from_twice;
  const auto keep = [](const ThreeAxisOutput& output, std::vector<ThreeAxisProduct>& into) {
    into.insert(into.end(), output.products.begin(), output.products.end());
  };
  for (int i = 0; i < 80; ++i) {
    const GyroSample sample = sensors_.gyro(0.25 * i);
    const StarFix fix = sensors_.star(0.25 * i);
    keep(once.push(fix), from_once);
    keep(once.push(sample), from_once);
    for (int time = 0; time < 2; ++time) {
      keep(twice.push(fix), from_twice);
      keep(twice.push(sample), from_twice);
    }
  }
  keep(once.finish(), from_once);
  keep(twice.finish(), from_twice);
  const auto of_once = of_kind<AttitudeEstimate>(from_once);
  const auto of_twice = of_kind<AttitudeEstimate>(from_twice);
  ASSERT_EQ(of_once.size(), of_twice.size());
  ASSERT_GT(of_once.size(), 70U);
  for (std::size_t i = 0; i < of_once.size(); ++i) {
    EXPECT_EQ(of_once[i].q_icrf_body.coeffs(), of_twice[i].q_icrf_body.coeffs());
  }
}

TEST_F(ThreeAxisPassTest, ASampleOfABadClockIsOutOfTime) {
  gyro(0.0, 10.0);
  StarFix ahead = sensors_.star(10.0);
  ahead.t = at_s(5000.0);
  add(pass_.push(ahead));
  add(pass_.push(sensors_.star(10.0)));
  gyro(10.0, 12.0);
  add(pass_.finish());
  EXPECT_THAT(reasons(), ElementsAre(Rejection::OutOfTime));
  EXPECT_GT(estimates(), 5U);
}

TEST_F(ThreeAxisPassTest, ASensorThatTheMissionLacksIsLeftOut) {
  ThreeAxisConfig blind = config_;
  blind.star_tracker.reset();
  ThreeAxisPass pass{blind, std::nullopt};
  add(pass.push(sensors_.star(0.0)));
  EXPECT_THAT(reasons(), ElementsAre(Rejection::NoSensor));
}

TEST_F(ThreeAxisPassTest, InTheEarthsShadowASunVectorIsLeftOut) {
  add(pass_.push(state_towards(sun_icrf_, -1.0)));
  add(pass_.push(sensors_.star(0.0)));
  gyro(0.0, 2.0);
  add(pass_.push(sun(1.0)));
  gyro(2.0, 6.0);
  add(pass_.finish());
  EXPECT_THAT(reasons(), ElementsAre(Rejection::Shadow));
  EXPECT_EQ(pass_.sensors().at(index_of(SampleKind::OrbitState)).accepted, 1);
}

TEST_F(ThreeAxisPassTest, InSunlightItIsTakenInAndBehindAMissionsOrbitStatesDoNotCount) {
  const auto orbit = KeplerOrbit::through(at_s(-10.0), state_towards(sun_icrf_, 1.0).state);
  ThreeAxisPass pass{config_, Orbit{orbit.value()}};
  add(pass.push(state_towards(sun_icrf_, -1.0)));
  add(pass.push(sensors_.star(0.0)));
  add(pass.push(sun(1.0)));
  add(pass.finish());
  EXPECT_THAT(rejected(), IsEmpty());
  EXPECT_EQ(pass.sensors().at(index_of(SampleKind::Sun)).accepted, 1);
  EXPECT_FALSE(pass.sensors().at(index_of(SampleKind::OrbitState)).last_seen);
}

TEST_F(ThreeAxisPassTest, AStateOnNoOrbitIsLeftOut) {
  TimedOrbitState state = state_towards(sun_icrf_, 1.0);
  state.state.velocity_icrf_km_s *= 2.0;
  add(pass_.push(state));
  gyro(-9.0, 0.0);
  EXPECT_THAT(reasons(), ElementsAre(Rejection::NoOrbit));
}

TEST_F(ThreeAxisPassTest, ASilentStreamIsComputedToItsEnd) {
  add(pass_.push(sensors_.star(0.0)));
  gyro(0.0, 5.0);
  const std::size_t before = estimates();
  add(pass_.fall_silent());
  EXPECT_EQ(estimates(), before + 4);
  EXPECT_EQ(last().t, at_s(4.75));
  add(pass_.push(sensors_.gyro(4.5)));
  EXPECT_THAT(rejected(), IsEmpty());  // The sample is already known.
  add(pass_.push(sensors_.star(4.6)));
  EXPECT_THAT(reasons(), ElementsAre(Rejection::Late));
}

TEST_F(ThreeAxisPassTest, APassWithoutAFixSaysWhatItTakes) {
  gyro(0.0, 5.0);
  add(pass_.push(sun(4.0)));
  add(pass_.finish());
  EXPECT_EQ(estimates(), 0U);
  EXPECT_THAT(notices_, ElementsAre(Notice{NoticeCode::AttitudeNeverBegan,
                                           {{"gyro", std::int64_t{20}},
                                            {"star", std::int64_t{0}},
                                            {"sun", std::int64_t{1}},
                                            {"magnetometer", std::int64_t{0}}}}));
}

/// Has a magnetometer but no star tracker.
class MagnetometerPassTest : public ThreeAxisPassTest {
 protected:
  static constexpr int kSeconds = 55;

  MagnetometerPassTest() {
    config_.star_tracker.reset();
    config_.magnetometer = Magnetometer{.noise_nt = 100.0};
    pass_ = {config_, orbit_, model_};
  }

  MagneticField field(double t_s) {
    const Eigen::Vector3d position_km = orbit_.at(at_s(t_s)).value().position_icrf_km;
    return Sensors{body_, config_, rng_}.field(
        t_s, field_icrf_nt(model_, at_s(t_s), position_km, earth_).value());
  }
  void run() {
    for (int second = 0; second < kSeconds; ++second) {
      add(pass_.push(sun(second)));
      add(pass_.push(field(second)));
      gyro(second, second + 1.0);
    }
    add(pass_.finish());
  }

  Orbit orbit_{KeplerOrbit::through(at_s(-10.0), state_towards(sun_icrf_, 1.0).state).value()};
  MainFieldModel model_ = igrf().value();
  TurningEarth earth_;
};

/// Before and after the step the field is that of different orbits, one of which is wrong.
TEST_F(MagnetometerPassTest, AStepOfTheOrbitBetweenFieldsIsDoubted) {
  OemSegment segment{.usable_from = at_s(-60.0),
                     .usable_to = at_s(120.0),
                     .interpolation = Interpolation::Hermite,
                     .degree = 7,
                     .points = {}};
  for (double t_s = -60.0; t_s <= 120.0; t_s += 10.0) {
    segment.points.push_back({.t = at_s(t_s), .state = orbit_.at(at_s(t_s)).value()});
  }
  for (const double step_s : {30.0, -30.0}) {
    products_.clear();
    notices_.clear();
    pass_ = {config_,
             Orbit{stepped(segment, at_s(step_s), Eigen::Vector3d::Zero(),
                           Eigen::Vector3d{0.0, 0.12, 0.0})},
             model_};
    run();
    EXPECT_EQ(has(notices_, NoticeCode::OrbitStepsInPass), step_s > 0.0);
    EXPECT_EQ(has(last().assessment, ReasonCode::OrbitSteps), step_s > 0.0);
    for (const AttitudeEstimate& estimate : of_kind<AttitudeEstimate>(products_)) {
      EXPECT_FALSE(step_s > 0.0 && estimate.t > at_s(step_s + 2.0) &&
                   is_unopposed(estimate.assessment.quality));
      EXPECT_FALSE(estimate.t < at_s(step_s) && has(estimate.assessment, ReasonCode::OrbitSteps));
    }
  }
}

TEST_F(MagnetometerPassTest, FieldSunAndGyroMakeAnAttitude) {
  run();
  EXPECT_EQ(last().assessment.quality, Quality::Ok);
  EXPECT_LT(degrees(last().sigma_rad()), 0.4);
  EXPECT_LT(error_rad(last().q_icrf_body, body_.q_icrf_body(kSeconds - 0.25)).norm(),
            4.0 * last().sigma_rad());
  EXPECT_THAT(rejected(), IsEmpty());
  EXPECT_THAT(notices_, IsEmpty());
  EXPECT_EQ(pass_.sensors().at(index_of(SampleKind::Magnetometer)).accepted, kSeconds);
}

TEST_F(MagnetometerPassTest, AFieldOfAnotherStrengthIsLeftOutBeforeThereIsAnAttitudeAndBehind) {
  for (int second = 0; second < kSeconds; ++second) {
    add(pass_.push(sun(second)));
    MagneticField sample = field(second);
    sample.field_body_nt *= second < 3 || second == 30 ? 1.05 : 1.0;
    add(pass_.push(sample));
    gyro(second, second + 1.0);
  }
  add(pass_.finish());
  EXPECT_THAT(reasons(), ElementsAreArray(std::vector<Rejection>(4, Rejection::Innovation)));
  for (const RejectedSample& sample : rejected()) {
    EXPECT_EQ(sample.kind, SampleKind::Magnetometer);
    // The error is 5 % of 20,000 to 60,000 nT, over a noise of 100 nT.
    EXPECT_GT(sample.failed.value().value, 50.0);
    EXPECT_EQ(sample.failed->limit, innovation_gate(sample.t == at_s(30.0) ? 3 : 1));
  }
  EXPECT_EQ(last().assessment.quality, Quality::Ok);
}

TEST_F(MagnetometerPassTest, WithoutAnOrbitAFieldIsLeftOutUntilAStateComes) {
  pass_ = {config_, std::nullopt, model_};
  add(pass_.push(field(0.0)));
  add(pass_.push(field(1.0)));
  add(pass_.push(TimedOrbitState{.t = at_s(1.5), .state = orbit_.at(at_s(1.5)).value()}));
  add(pass_.push(field(2.0)));
  add(pass_.finish());
  EXPECT_THAT(reasons(), ElementsAre(Rejection::NoOrbit, Rejection::NoOrbit));
  EXPECT_THAT(notices_, ElementsAre(Field(&Notice::code, NoticeCode::FieldWithoutOrbit),
                                    Field(&Notice::code, NoticeCode::AttitudeNeverBegan)));
  EXPECT_EQ(pass_.sensors().at(index_of(SampleKind::Magnetometer)).accepted, 1);
}

TEST_F(MagnetometerPassTest, BehindTheYearsOfTheModelAFieldIsLeftOut) {
  const auto off = instant_of_year(2030.0) - at_s(0.5);
  MagneticField before = field(0.0);
  MagneticField behind = field(1.0);
  before.t += off;
  behind.t += off;
  add(pass_.push(before));
  add(pass_.push(behind));
  add(pass_.finish());
  EXPECT_THAT(notices_, ::testing::Contains(Notice{NoticeCode::OutsideFieldModel,
                                                   {{"t_tai_ns", tai_ns(behind.t)}}}));
  EXPECT_THAT(reasons(), ::testing::Contains(Rejection::NoField).Times(1));
}

TEST_F(MagnetometerPassTest, AFieldThatTheMissionLacksTheSensorOfIsLeftOut) {
  const MagneticField sample = field(0.0);
  config_.magnetometer.reset();
  pass_ = {config_, orbit_, model_};
  add(pass_.push(sample));
  EXPECT_THAT(reasons(), ElementsAre(Rejection::NoSensor));
}

}  // namespace spindrift::testing::three_axis_pass_test
