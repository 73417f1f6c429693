#include "services/base/advisory_words.h"

#include "tests/support/matchers.h"

namespace spindrift::advisory_words_test {

TEST(AdvisoryWords, SayWhatSpeaksWhatIsKnownAndWhetherControlMayRestart) {
  Advisory advisory{.off_deg = 12.34};
  advisory.sensors.at(index_of(SampleKind::Gyro)) = SensorVoice::Silent;
  advisory.sensors.at(index_of(SampleKind::Star)) = SensorVoice::Never;
  advisory.sensors.at(index_of(SampleKind::Sun)) = SensorVoice::Speaks;
  advisory.sensors.at(index_of(SampleKind::Magnetometer)) = SensorVoice::Speaks;
  EXPECT_EQ(
      sentence_of(advisory),
      "body lost, by the field alone: the field is 12.3 deg off that of the commanded attitude; "
      "sun, magnetometer speak; gyro silent; star never spoke; no attitude known; no control "
      "before the safe "
      "gate opens");
  advisory.certain = true;
  advisory.may_control = true;
  advisory.attitude = AttitudeEstimate{.t = {},
                                       .q_icrf_body = Eigen::Quaterniond::Identity(),
                                       .rate_body_rad_s = {},
                                       .covariance_rad2 = Eigen::Matrix3d::Identity() * 1e-4,
                                       .assessment = {.quality = Quality::Converging}};
  EXPECT_THAT(sentence_of(advisory),
              AllOf(StartsWith("body lost, by field and Sun: "),
                    EndsWith("attitude by mekf, CONVERGING, sigma 0.99 deg; the safe gate is open, "
                             "control may restart")));
}

}  // namespace spindrift::advisory_words_test
