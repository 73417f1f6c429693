#include "pipelines/three_axis/rescue_advice.h"

#include <optional>
#include <vector>

#include "tests/support/matchers.h"
#include "tests/support/turning_body.h"

namespace spindrift::testing::rescue_advice_test {

const Expected<OrbitState> kNowhere = Unexpected{{ErrorCode::NoCoverage, {}}};
const Eigen::Vector3d kField_nt{0.0, 0.0, 30'000.0};

class RescueAdviceTest : public ::testing::Test {
 protected:
  RescueAdviceTest() {
    config_.magnetometer = Magnetometer{.noise_nt = 100.0};
    config_.nominal = NominalAttitude{.frame = NominalAttitude::Frame::Icrf,
                                      .q_frame_body = Eigen::Quaterniond::Identity()};
  }

  /// Returns what is advised in a second in which the field is so far off and these sensors speak.
  std::optional<Advisory> second(int t_s, double off_deg, const std::vector<SampleKind>& speak) {
    for (const SampleKind kind : speak) {
      sensors_.at(index_of(kind)).last_seen = at_s(t_s);
    }
    const Eigen::Quaterniond off{Eigen::AngleAxisd{off_deg * kRadPerDeg, Eigen::Vector3d::UnitX()}};
    gates_.see_field(at_s(t_s), off * kField_nt, kField_nt, kNowhere, products_);
    return advice_.advise(at_s(t_s), gates_, config_, sensors_);
  }
  AttitudeEstimate estimate(int t_s, Quality quality) const {
    return {.t = at_s(t_s),
            .q_icrf_body = Eigen::Quaterniond::Identity(),
            .rate_body_rad_s = Eigen::Vector3d{0.0, 0.01, 0.0},
            .covariance_rad2 = Eigen::Matrix3d::Identity() * 1e-6,
            .assessment = {.quality = quality}};
  }

  ThreeAxisConfig config_ = usual_three_axis();
  AttitudeGates gates_{NominalAttitude{.frame = NominalAttitude::Frame::Icrf,
                                       .q_frame_body = Eigen::Quaterniond::Identity()}};
  SensorHealths sensors_;
  AttitudeGates::Products products_;
  RescueAdvice advice_;
};

TEST_F(RescueAdviceTest, IsGivenWhenTheBodyIsLostAndWhenItChanges) {
  using enum SampleKind;
  for (int t_s = 0; t_s < 9; ++t_s) {
    EXPECT_FALSE(second(t_s, 20.0, {Gyro, Magnetometer}));
  }
  const auto first = second(9, 20.0, {Gyro, Magnetometer});
  ASSERT_TRUE(first);
  EXPECT_EQ(first->t, at_s(9));
  EXPECT_NEAR(first->off_deg, 20.0, 1e-9);
  EXPECT_FALSE(first->certain);
  EXPECT_FALSE(first->may_control);
  EXPECT_FALSE(first->attitude);
  EXPECT_EQ(first->sensors.at(index_of(Gyro)), SensorVoice::Speaks);
  EXPECT_EQ(first->sensors.at(index_of(Star)), SensorVoice::Never);
  EXPECT_EQ(first->sensors.at(index_of(Magnetometer)), SensorVoice::Speaks);
  EXPECT_FALSE(first->sensors.at(index_of(OrbitState))) << "it is no sensor";

  for (int t_s = 10; t_s < 69; ++t_s) {
    const bool has_gyro = t_s < 15;
    EXPECT_FALSE(
        second(t_s, 25.0, has_gyro ? std::vector{Gyro, Magnetometer} : std::vector{Magnetometer}))
        << t_s;
  }
  const auto later = second(69, 25.0, {Magnetometer});
  ASSERT_TRUE(later) << "a minute has passed";
  EXPECT_NEAR(later->off_deg, 25.0, 1e-9);
  const auto silent = second(76, 25.0, {Magnetometer});
  ASSERT_TRUE(silent);
  EXPECT_EQ(silent->sensors.at(index_of(Gyro)), SensorVoice::Silent);
  sensors_.at(index_of(Magnetometer)).rejected_in_a_row = 10;
  const auto left_out = second(77, 25.0, {Magnetometer});
  ASSERT_TRUE(left_out);
  EXPECT_EQ(left_out->sensors.at(index_of(Magnetometer)), SensorVoice::LeftOut);
}

TEST_F(RescueAdviceTest, HasTheAttitudeThatIsKnownNow) {
  for (int t_s = 0; t_s < 10; ++t_s) {
    second(t_s, 20.0, {});
  }
  advice_.see(estimate(10, Quality::Converging));
  const auto known = second(10, 20.0, {});
  ASSERT_TRUE(known);
  ASSERT_TRUE(known->attitude);
  EXPECT_EQ(known->attitude->t, at_s(10));
  advice_.see(estimate(11, Quality::Lost));
  const auto lost = second(11, 20.0, {});
  ASSERT_TRUE(lost);
  EXPECT_FALSE(lost->attitude);
  advice_.see(estimate(12, Quality::Ok));
  ASSERT_TRUE(second(12, 20.0, {}));
  EXPECT_FALSE(second(70, 20.0, {}));
  const auto old = second(73, 20.0, {});
  ASSERT_TRUE(old);
  EXPECT_FALSE(old->attitude) << "it is older than a minute";
}

TEST_F(RescueAdviceTest, SaysWhenControlMayRestart) {
  std::optional<Advisory> last;
  for (int t_s = 0; t_s <= 601; ++t_s) {
    advice_.see(estimate(t_s, Quality::Ok));
    const auto advisory = second(t_s, 20.0, {});
    EXPECT_TRUE(!advisory || t_s > 600 || !advisory->may_control) << t_s;
    last = advisory ? advisory : last;
    gates_.see({.t = at_s(t_s), .nis = 3.0, .sigma_rad = 0.01, .lead_nats = 60.0}, products_);
  }
  ASSERT_TRUE(last);
  EXPECT_EQ(last->t, at_s(601));
  EXPECT_TRUE(last->may_control);
  // The gate is still open, but what it was open for is too old.
  for (int t_s = 602; t_s <= 700; ++t_s) {
    const auto advisory = second(t_s, 20.0, {});
    last = advisory ? advisory : last;
  }
  EXPECT_FALSE(last->attitude);
  EXPECT_FALSE(last->may_control);
}

TEST_F(RescueAdviceTest, IsSilentWhenTheBodyHasRecovered) {
  for (int t_s = 0; t_s < 10; ++t_s) {
    second(t_s, 20.0, {});
  }
  int given = 0;
  for (int t_s = 10; t_s < 200; ++t_s) {
    given += second(t_s, 0.0, {}) ? 1 : 0;
  }
  EXPECT_EQ(given, 0);
}

}  // namespace spindrift::testing::rescue_advice_test
