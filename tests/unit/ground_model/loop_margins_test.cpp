#include <array>

#include "pipelines/frames/angle.h"
#include "pipelines/ground_model/control/control_laws.h"
#include "pipelines/ground_model/flights/channel_margins.h"
#include "tests/support/matchers.h"

namespace spindrift::loop_margins_test {

const Eigen::Vector3d kMoments_kg_m2{0.6, 1.2, 1.12};
constexpr double kFrequency_rad_s = 0.1;
const PdGains kGains = PdGains::of(kMoments_kg_m2, kFrequency_rad_s, 0.6716);

ChannelLoop channel(int axis, double factor = 1.0,
                    const std::optional<LoopSampling>& sampling = std::nullopt) {
  return {.moment_kg_m2 = factor * kMoments_kg_m2[axis],
          .kp_nm = kGains.kp_nm[axis],
          .kd_nms = kGains.kd_nms[axis],
          .sampling = sampling};
}

LoopMargins margins(const ChannelLoop& loop) { return loop_margins(loop).value(); }

double decibel(double ratio) { return 20.0 * std::log10(ratio); }

TEST(LoopMargins, AreThoseOfSeed004InEachChannel) {
  for (const int axis : {0, 1, 2}) {
    const LoopMargins of = margins(channel(axis));
    EXPECT_NEAR(degrees(of.phase_rad), 63.6, 0.05) << axis;
    EXPECT_FALSE(of.gain) << axis;
  }
}

TEST(LoopMargins, LoseLittleBySamplingAndDelay) {
  const LoopMargins at_10_hz = margins(channel(0, 1.0, LoopSampling{0.1, 1}));
  EXPECT_NEAR(degrees(at_10_hz.phase_rad), 62.3, 0.1);
  EXPECT_NEAR(decibel(*at_10_hz.gain), 37.0, 0.5);
  const LoopMargins at_1_hz = margins(channel(0, 1.0, LoopSampling{1.0, 1}));
  EXPECT_NEAR(degrees(at_1_hz.phase_rad), 50.8, 0.1);
  EXPECT_NEAR(decibel(*at_1_hz.gain), 17.0, 0.5);
}

TEST(LoopMargins, StayWithInertiaAFifthOff) {
  EXPECT_NEAR(degrees(margins(channel(1, 0.8)).phase_rad), 67.7, 0.1);
  EXPECT_NEAR(degrees(margins(channel(1, 1.2)).phase_rad), 60.1, 0.1);
}

TEST(LoopMargins, OfAnUnhurriedSamplingAreThoseOfNone) {
  const ChannelLoop plain = channel(2);
  const ChannelLoop fine = channel(2, 1.0, LoopSampling{1e-5, 0});
  EXPECT_NEAR(margins(fine).phase_rad, margins(plain).phase_rad, 1e-5);
  const auto points = bode(plain, 1e-3, 1.0, 31);
  ASSERT_EQ(points.size(), 31U);
  EXPECT_DOUBLE_EQ(points.back().frequency_rad_s, 1.0);
  for (const BodePoint& point : points) {
    const std::complex<double> s{0.0, point.frequency_rad_s};
    const std::complex<double> expected =
        (plain.kd_nms * s + 0.5 * plain.kp_nm) / (plain.moment_kg_m2 * s * s);
    EXPECT_NEAR(point.gain / std::abs(expected), 1.0, 1e-12);
    EXPECT_NEAR(std::remainder(point.phase_rad - std::arg(expected), kTurn_rad), 0.0, 1e-12);
    const BodePoint sampled = open_loop_at(fine, point.frequency_rad_s);
    EXPECT_NEAR(sampled.gain / point.gain, 1.0, 1e-9);
  }
}

TEST(LoopMargins, OfASampledLoopAreOfItsTransferFunction) {
  const ChannelLoop loop = channel(0, 1.0, LoopSampling{1.0, 2});
  for (const BodePoint& point : bode(loop, 1e-2, 3.0, 20)) {
    const std::complex<double> z = std::polar(1.0, point.frequency_rad_s);
    const std::complex<double> expected =
        (loop.kd_nms / (z - 1.0) + 0.25 * loop.kp_nm * (z + 1.0) / ((z - 1.0) * (z - 1.0))) /
        (loop.moment_kg_m2 * z * z);
    EXPECT_NEAR(point.gain / std::abs(expected), 1.0, 1e-12);
    EXPECT_NEAR(std::remainder(point.phase_rad - std::arg(expected), kTurn_rad), 0.0, 1e-9);
  }
}

TEST(ClosedLoopPoles, AreOfSecondOrderWithTheFrequencyAndDampingChosen) {
  const auto poles = closed_loop_poles(channel(1), 1.0);
  ASSERT_EQ(poles.size(), 2U);
  for (const std::complex<double>& pole : poles) {
    EXPECT_NEAR(std::abs(pole), kFrequency_rad_s, 1e-15);
    EXPECT_NEAR(-pole.real() / std::abs(pole), 0.6716, 1e-12);
  }
}

TEST(ClosedLoopPoles, StayLeftWithInertiaAFifthOff) {
  const std::array factors{1.0 / 1.2, 1.0, 1.0 / 0.8};
  for (const int axis : {0, 1, 2}) {
    for (const LocusPoint& point : root_locus(channel(axis), factors)) {
      for (const std::complex<double>& pole : point.poles) {
        EXPECT_LT(pole.real(), -0.05) << axis << ' ' << point.factor;
      }
    }
  }
}

double outermost(const ChannelLoop& loop, double factor) {
  double most = 0.0;
  for (const std::complex<double>& pole : closed_loop_poles(loop, factor)) {
    most = std::max(most, std::abs(pole));
  }
  return most;
}

TEST(ClosedLoopPoles, LeaveTheUnitCircleAtTheGainMargin) {
  for (const int late : {0, 1, 3}) {
    SCOPED_TRACE(late);
    const ChannelLoop loop = channel(0, 1.0, LoopSampling{1.0, late});
    const double margin = margins(loop).gain.value();
    EXPECT_GT(margin, 1.0);
    EXPECT_LT(outermost(loop, 0.999 * margin), 1.0);
    EXPECT_GT(outermost(loop, 1.001 * margin), 1.0);
  }
}

TEST(LoopMargins, RefuseALoopThatIsNone) {
  ChannelLoop loop = channel(0);
  loop.kd_nms = 0.0;
  EXPECT_THAT(loop_margins(loop).error().message, HasSubstr("must be above 0"));
  EXPECT_FALSE(loop_margins(channel(0, 1.0, LoopSampling{0.0, 1})));
  EXPECT_THAT(loop_margins(channel(0, 1.0, LoopSampling{20.0, 1})).error().message,
              HasSubstr("is not closed by a period of 20 s"));
  // The torque comes 17 s late, whereas kd leads by at most 2 kd / kp = 2 * 2 * 0.6716 / 0.1 = 13.4
  // s.
  EXPECT_THAT(loop_margins(channel(0, 1.0, LoopSampling{2.0, 8})).error().message,
              HasSubstr("swings with any gain"));
  EXPECT_LT(margins(channel(0, 1.0, LoopSampling{2.0, 4})).phase_rad, 0.0);
}

}  // namespace spindrift::loop_margins_test
