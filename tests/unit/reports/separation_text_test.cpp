#include "services/reports/separation_report.h"
#include "tests/support/made_separation.h"
#include "tests/support/matchers.h"

namespace spindrift::testing::separation_text_test {

/// Returns the text of a report with `batch` alone after a change.
constexpr auto text_after = [](const auto& change) { return to_text(report_after(change)); };

TEST(SeparationText, HasEventsAttitudesBiasLauncherAndQualityOfBothMethods) {
  EXPECT_EQ(to_text(made_report()), R"(LEOSAT  run run-1
  rests on     961 gyro samples (and 2 left out), 223 sun vectors, 1 star fix
  events       T1 separation           2026-03-01T04:00:00.000Z
               T2 attitude control on  2026-03-01T04:01:00.000Z
               T3 sun acquisition      2026-03-01T04:01:18.000Z
               T4 first star fix       2026-03-01T04:05:00.000Z  found in the samples
  ICRF to body                     phi     theta       psi    sigma    bound   deg, Euler 3-1-2
               T1 batch         10.000    20.000    30.000    0.400    0.350
               T1 sequential    10.000    20.000    30.000    0.400        -
               T2 batch         10.000    20.000    36.000    0.400    0.350
               T2 sequential    10.000    20.000    36.000    0.400        -
               T3 batch         10.000    20.000    37.800    0.400    0.350
               T3 sequential    10.000    20.000    37.800    0.400        -
               T4 batch         10.000    20.000    60.000    0.400    0.350
               T4 sequential    10.000    20.000    60.000    0.400        -
  ICRF to body                        x          y          z          w   quaternion
               T1 batch       0.0381346  0.1893079  0.2685358  0.9437144
               T1 sequential  0.0381346  0.1893079  0.2685358  0.9437144
               T2 batch       0.0281747  0.1910442  0.3175580  0.9283670
               T2 sequential  0.0281747  0.1910442  0.3175580  0.9283670
               T3 batch       0.0251704  0.1914632  0.3321010  0.9232644
               T3 sequential  0.0251704  0.1914632  0.3321010  0.9232644
               T4 batch      -0.0121613  0.1927273  0.5036369  0.8420559
               T4 sequential -0.0121613  0.1927273  0.5036369  0.8420559
  orbit frame to body              phi     theta       psi   deg, Euler 3-1-2
               T1 batch          1.000     2.000     3.000
               T1 sequential     1.000     2.000     3.000
               T2 batch          1.000     2.000     3.000
               T2 sequential     1.000     2.000     3.000
               T3 batch        the orbit ends before
               T3 sequential   the orbit ends before
               T4 batch          1.000     2.000     3.000
               T4 sequential     1.000     2.000     3.000
  gyro bias    x +0.00300 +/- 0.00057  y -0.00200 +/- 0.00057  z +0.00400 +/- 0.00057 deg/s
               open along (+0.00, +0.00, +1.00) by 0.009 deg/s, 90 % of what was known beforehand, 2 deg off the Sun line
  launcher     batch: 3.900 deg apart at T1, chi-square 60.00 of 3 degrees of freedom: OUTSIDE 99 %
               sequential: 3.900 deg apart at T1, chi-square 60.00 of 3 degrees of freedom: OUTSIDE 99 %
  batch        OK, 1 star fix
  sequential   OK, 1 star fix
)");
}

TEST(SeparationText, SaysHowTheSunSensorIsTurned) {
  const std::string turned = text_after([](auto& one) {
    one.solution.misalignment =
        SunMisalignment{Eigen::Vector3d{0.01, -0.02, 0.0}, 1e-6 * Eigen::Matrix3d::Identity()};
  });
  EXPECT_THAT(turned, HasSubstr("  sun sensor   turned by x +0.573 +/- 0.057  y -1.146 +/- 0.057  "
                                "z +0.000 +/- 0.057 deg, body axes\n"));
}

TEST(SeparationText, SaysWhatIsNotKnown) {
  const std::string no_orbit = text_after([](auto& one) { one.in_orbit_frame.clear(); });
  EXPECT_THAT(no_orbit, HasSubstr("  orbit frame  not known: the mission file names no orbit\n"));
  const std::string unchecked = text_after([](auto& one) {
    one.launcher = Unexpected{{ErrorCode::NoCoverage, "no orbit at T1"}};
  });
  EXPECT_THAT(unchecked, HasSubstr("  launcher     not checked: no orbit at T1\n"));
  const std::string nothing_told = text_after([](auto& one) { one.launcher.reset(); });
  EXPECT_THAT(nothing_told, Not(HasSubstr("launcher")));
}

TEST(SeparationText, MarksAnglesNearTheirSingularity) {
  const std::string text = text_after([](auto& one) {
    one.solution.events[1].attitude.q_icrf_body =
        quaternion_of({.phi_rad = 89.9 * kRadPerDeg, .theta_rad = 0.0, .psi_rad = 0.0});
  });
  EXPECT_THAT(text, ::testing::ContainsRegex("T2 batch .*89.900.*near the singularity\n"));
}

TEST(SeparationText, ShowsTheDigitsThatASmallSigmaLeaves) {
  const std::string text = text_after([](auto& one) {
    for (ReconstructedEvent& event : one.solution.events) {
      event.attitude.covariance_rad2 *= 1e-4;
    }
  });
  EXPECT_THAT(text, HasSubstr("10.0000"));
  EXPECT_THAT(text, HasSubstr("0.0040"));
}

TEST(SeparationText, SaysInsideWhereTheLauncherAgrees) {
  const std::string text = text_after([](auto& one) {
    (*one.launcher)->chance = 0.5;
    (*one.launcher)->difference = {.angle_rad = 0.5 * kRadPerDeg, .chi_square = 2.4};
  });
  EXPECT_THAT(text, HasSubstr("batch: 0.500 deg apart at T1, chi-square 2.40 of 3 degrees of "
                              "freedom: inside 99 %\n"));
}

}  // namespace spindrift::testing::separation_text_test
