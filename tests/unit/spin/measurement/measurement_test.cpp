#include "pipelines/spin/measurement/measurement.h"

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <numbers>
#include <random>
#include <set>

#include "pipelines/frames/angle.h"
#include "pipelines/frames/celestial.h"
#include "tests/support/matchers.h"
#include "tests/support/spinning_body.h"

namespace spindrift::testing::measurement_test {

using enum PulseChannel;

constexpr double kPi = std::numbers::pi;
constexpr double kRate_rad_s = 2.0 * kPi / 1.5;
// Two edges, each rounded to 0.5 ns.
constexpr double kNanosecond_rad = kRate_rad_s * 1e-9;
const TaiTime kStart = tai_from_ns(1'795'143'637'000'000'000);

/// Holds a body that spins about ICRF z with the Sun and the Earth at these angles from it; the
/// Earth follows the Sun by `dihedral_rad`.
struct Scene {
  double sun_angle_rad = 80.0 * kRadPerDeg;
  double earth_angle_rad = 92.0 * kRadPerDeg;
  double dihedral_rad = 1.0;
  double first_turn_rad = 0.3;
  SpinConfig config = usual_config();
};

Revolution seen(const Scene& scene) {
  const auto at = [](double polar_rad, double azimuth_rad) -> Eigen::Vector3d {
    return Eigen::AngleAxisd{azimuth_rad, Eigen::Vector3d::UnitZ()} *
           (Eigen::AngleAxisd{polar_rad, Eigen::Vector3d::UnitY()} * Eigen::Vector3d::UnitZ());
  };
  return revolution_seen({.axis_icrf = Eigen::Vector3d::UnitZ(),
                          .rate_rad_s = kRate_rad_s,
                          .first_turn_rad = scene.first_turn_rad,
                          .config = scene.config},
                         at_rest(at(scene.sun_angle_rad, 0.4),
                                 16000.0 * at(scene.earth_angle_rad, 0.4 + scene.dihedral_rad)),
                         kStart);
}

Revolution without(Revolution revolution, PulseChannel channel) {
  revolution.edges.at(index_of(channel)).reset();
  return revolution;
}

Revolution rejecting(Revolution revolution, PulseChannel channel) {
  revolution.edge_rejections.at(index_of(channel)) = Rejection::Phase;
  return revolution;
}

TEST(SpinMeasurements, SunAngleIsThatOfTheOracle) {
  for (double angle_deg = 46.0; angle_deg < 135.0; angle_deg += 1.0) {
    SCOPED_TRACE(angle_deg);
    const Scene scene{.sun_angle_rad = angle_deg * kRadPerDeg};
    const auto measured = measure(scene.config, seen(scene)).sun_angle.value();
    // d(theta_s) / d(lag) is at most 1 for a cant of 45 deg.
    EXPECT_NEAR(measured.value_rad, scene.sun_angle_rad, kNanosecond_rad);
  }
}

TEST(SpinMeasurements, ADriftOfTheRateChangesNoAngle) {
  const Scene scene;
  Revolution even = seen(scene);
  even.t_start = even.edge(Sun1).value();
  Revolution drifting = even;
  // What takes t at a constant rate takes t - t^2 / 200 s here: the rate gains 1 % a second.
  drifting.period.drift_per_s2 = 0.01 / even.period.period_s;
  for (auto& edge : drifting.edges) {
    const double t_s = seconds_between(even.t_start, edge.value());
    edge = shifted(even.t_start, 2.0 * t_s / (1.0 + std::sqrt(1.0 + 2.0 * 0.01 * t_s)));
  }
  const RevolutionMeasurements expected = measure(scene.config, even);
  const RevolutionMeasurements measured = measure(scene.config, drifting);
  for (const SpinQuantity quantity : kMeasuredAngles) {
    ASSERT_EQ(value_of(measured, quantity).has_value(), value_of(expected, quantity).has_value());
    if (const auto value = value_of(measured, quantity)) {
      EXPECT_NEAR(value->value_rad, value_of(expected, quantity)->value_rad, 2.0 * kNanosecond_rad)
          << name_of(quantity);
    }
  }
}

TEST(SpinMeasurements, SlitLagOfTheOracleIsTheOneOfTheHandbook) {
  for (const double cant_deg : {15.0, 30.0, 45.0}) {
    for (const double angle_deg : {60.0, 75.0, 90.0, 110.0}) {
      Scene scene{.sun_angle_rad = angle_deg * kRadPerDeg};
      scene.config.sun_sensor.slit_cant_rad = cant_deg * kRadPerDeg;
      const Revolution revolution = seen(scene);
      const double lag_rad = kRate_rad_s * seconds_between(revolution.edge(Sun1).value(),
                                                           revolution.edge(Sun2).value()) -
                             scene.config.sun_sensor.slit_separation_rad;
      // cot(theta_s) = sin(psi_12 - psi0) / tan I.
      EXPECT_NEAR(1.0 / std::tan(angle_deg * kRadPerDeg),
                  std::sin(lag_rad) / std::tan(cant_deg * kRadPerDeg),
                  kNanosecond_rad / std::tan(cant_deg * kRadPerDeg));
    }
  }
}

TEST(SpinMeasurements, DihedralIsThatOfTheOracleInEveryDirection) {
  for (double dihedral_rad = -3.1; dihedral_rad < 3.14; dihedral_rad += 0.1) {
    SCOPED_TRACE(dihedral_rad);
    const Scene scene{.dihedral_rad = dihedral_rad};
    const RevolutionMeasurements measured = measure(scene.config, seen(scene));
    for (const Side side : kSides) {
      ASSERT_TRUE(measured.crossing(side));
      ASSERT_TRUE(measured.crossing(side)->dihedral);
      EXPECT_NEAR(measured.crossing(side)->dihedral->value_rad, dihedral_rad,
                  2.0 * kNanosecond_rad);
    }
  }
}

TEST(SpinMeasurements, ChordIsTheTurnFromEdgeToEdge) {
  const Scene scene;
  const Revolution revolution = seen(scene);
  const RevolutionMeasurements measured = measure(scene.config, revolution);
  const double width_s = seconds_between(*revolution.edge(NorthIn), *revolution.edge(NorthOut));
  EXPECT_DOUBLE_EQ(measured.crossing(Side::North)->chord->value_rad, kRate_rad_s * width_s);
  EXPECT_LE(std::abs(seconds_between(shifted(*revolution.edge(NorthIn), 0.5 * width_s),
                                     measured.crossing(Side::North)->t_mid())),
            1e-9);
}

TEST(SpinMeasurements, WhatAnEdgeOrASensorDoesNotGiveIsAbsent) {
  Scene scene;
  const Revolution revolution = seen(scene);
  const auto measured_without = [&](PulseChannel channel) {
    return measure(scene.config, without(revolution, channel));
  };
  EXPECT_FALSE(measured_without(Sun1).sun_angle);
  EXPECT_FALSE(measured_without(Sun1).t_sun1);
  EXPECT_TRUE(measured_without(Sun1).crossing(Side::North)->chord);
  EXPECT_FALSE(measured_without(Sun1).crossing(Side::North)->dihedral);
  EXPECT_FALSE(measured_without(Sun2).sun_angle);
  EXPECT_TRUE(measured_without(Sun2).crossing(Side::North)->dihedral);
  EXPECT_FALSE(measured_without(NorthIn).crossing(Side::North));
  EXPECT_FALSE(measured_without(NorthOut).crossing(Side::North));
  EXPECT_TRUE(measured_without(NorthOut).crossing(Side::South));
  EXPECT_FALSE(measured_without(SouthIn).crossing(Side::South));
  scene.config.south.reset();
  EXPECT_FALSE(measure(scene.config, revolution).crossing(Side::South));
  EXPECT_TRUE(measure(scene.config, revolution).crossing(Side::North));
}

TEST(SpinMeasurements, ASlitLagOfAQuarterTurnHasNoMeaning) {
  const SunSensor sensor = usual_config().sun_sensor;
  const auto with_lag = [&](double lag_rad) {
    return sun_angle(sensor, (sensor.slit_separation_rad + lag_rad) / kRate_rad_s, kRate_rad_s,
                     1e-4);
  };
  for (const double lag_deg : {-89.9, 0.0, 89.9, 360.0, -400.0}) {
    EXPECT_TRUE(with_lag(lag_deg * kRadPerDeg)) << lag_deg;
  }
  for (const double lag_deg : {-179.0, -90.1, 90.1, 180.0, 260.0}) {
    EXPECT_FALSE(with_lag(lag_deg * kRadPerDeg)) << lag_deg;
  }
  EXPECT_FALSE(sun_angle(sensor, std::nan(""), kRate_rad_s, 1e-4));
}

TEST(SpinMeasurements, AChordOfAWholeTurnOrBackwardsHasNoMeaning) {
  const Scene scene;
  Revolution revolution = seen(scene);
  const auto chord_of = [&](double width_rad) {
    revolution.edges.at(index_of(NorthOut)) =
        shifted(*revolution.edge(NorthIn), width_rad / kRate_rad_s);
    return measure(scene.config, revolution).crossing(Side::North);
  };
  EXPECT_TRUE(chord_of(1.99 * kPi));
  EXPECT_FALSE(chord_of(2.01 * kPi));
  EXPECT_FALSE(chord_of(0.0));
  EXPECT_FALSE(chord_of(-0.1));
}

constexpr std::array kAll = {SpinQuantity::SunAngle, SpinQuantity::NorthChord,
                             SpinQuantity::SouthChord, SpinQuantity::NorthDihedral,
                             SpinQuantity::SouthDihedral};

TEST(SpinMeasurements, RejectingAQuantityLeavesTheOthersGood) {
  const Scene scene;
  for (const SpinQuantity rejected : kAll) {
    RevolutionMeasurements measured = measure(scene.config, seen(scene));
    reject(measured, rejected, Rejection::SunAngle);
    reject(measured, rejected, Rejection::Phase);
    for (const SpinQuantity quantity : kAll) {
      ASSERT_TRUE(value_of(measured, quantity));
      EXPECT_EQ(good_value_of(measured, quantity).has_value(), quantity != rejected)
          << name_of(quantity) << " without " << name_of(rejected);
    }
    EXPECT_EQ(value_of(measured, rejected)->rejected_by, Rejection::SunAngle);
  }
}

TEST(SpinMeasurements, WhatRestsOnARejectedEdgeIsThereAndRejected) {
  const Scene scene;
  using enum SpinQuantity;
  const auto rejected_with = [&](PulseChannel channel) {
    const RevolutionMeasurements measured = measure(scene.config, rejecting(seen(scene), channel));
    std::set<SpinQuantity> rejected;
    for (const SpinQuantity quantity : kMeasuredAngles) {
      const auto value = value_of(measured, quantity);
      if (value && value->rejected_by) {
        EXPECT_EQ(value->rejected_by, Rejection::Phase);
        EXPECT_EQ(value->value_rad,
                  value_of(measure(scene.config, seen(scene)), quantity)->value_rad);
        rejected.insert(quantity);
      }
    }
    return rejected;
  };
  EXPECT_EQ(rejected_with(Sun1), (std::set{SunAngle, NorthDihedral, SouthDihedral}));
  EXPECT_EQ(rejected_with(Sun2), (std::set{SunAngle}));
  EXPECT_EQ(rejected_with(NorthIn), (std::set{NorthChord, NorthDihedral}));
  EXPECT_EQ(rejected_with(SouthOut), (std::set{SouthChord, SouthDihedral}));
}

TEST(SpinMeasurements, WithoutAGoodSun1TheEarthIsTimedFromSun2) {
  for (double dihedral_rad = -3.1; dihedral_rad < 3.14; dihedral_rad += 0.2) {
    const Scene scene{.dihedral_rad = dihedral_rad};
    const Revolution whole = seen(scene);
    const double slits_rad =
        kRate_rad_s * seconds_between(whole.edge(Sun1).value(), whole.edge(Sun2).value());
    for (const Revolution& revolution : {without(whole, Sun1), rejecting(whole, Sun1)}) {
      const RevolutionMeasurements measured = measure(scene.config, revolution);
      EXPECT_FALSE(measured.t_sun1);
      ASSERT_TRUE(good_value_of(measured, SpinQuantity::MixedAzimuth));
      EXPECT_NEAR(wrapped_rad(measured.mixed_azimuth->value_rad - (dihedral_rad - slits_rad)), 0.0,
                  2.0 * kNanosecond_rad);
    }
    EXPECT_FALSE(measure(scene.config, whole).mixed_azimuth);
  }
}

TEST(SpinMeasurements, ADoubtfulSensorStaysOutOfTheMixedAzimuth) {
  const Scene scene;
  Revolution revolution = without(seen(scene), Sun1);
  const double whole_rad = measure(scene.config, revolution).mixed_azimuth->value_rad;
  revolution.edges.at(index_of(NorthIn)) = shifted(*revolution.edge(NorthIn), -0.01);
  EXPECT_GT(std::abs(measure(scene.config, revolution).mixed_azimuth->value_rad - whole_rad), 1e-3);
  revolution = rejecting(revolution, NorthIn);
  const auto south_alone = measure(scene.config, revolution).mixed_azimuth;
  EXPECT_NEAR(south_alone->value_rad, whole_rad, 2.0 * kNanosecond_rad);
  EXPECT_FALSE(south_alone->rejected_by);
  revolution = rejecting(revolution, SouthIn);
  EXPECT_EQ(measure(scene.config, revolution).mixed_azimuth->rejected_by, Rejection::Phase);
}

TEST(SpinMeasurements, NoiseIsWhatEachEdgeMovesThemBy) {
  const Scene scene{.sun_angle_rad = 70.0 * kRadPerDeg};
  for (const Revolution& revolution : {seen(scene), without(seen(scene), Sun1)}) {
    const RevolutionMeasurements exact = measure(scene.config, revolution);
    for (std::size_t channel = 0; channel < kPulseChannels; ++channel) {
      if (!revolution.edges.at(channel)) {
        continue;
      }
      const double sigma_s = edge_sigma_s(scene.config.noise, static_cast<PulseChannel>(channel));
      const auto moved_by = [&](double offset_s) {
        Revolution moved = revolution;
        moved.edges.at(channel) = shifted(*revolution.edges.at(channel), offset_s);
        return measure(scene.config, moved);
      };
      const RevolutionMeasurements later = moved_by(sigma_s);
      const RevolutionMeasurements earlier = moved_by(-sigma_s);
      for (const SpinQuantity quantity : kMeasuredAngles) {
        if (const auto value = value_of(exact, quantity)) {
          // Rounding to nanoseconds, and the third order of a sigma of 4e-4 rad.
          EXPECT_NEAR(value->noise_rad(static_cast<Eigen::Index>(channel)),
                      0.5 * wrapped_rad(value_of(later, quantity)->value_rad -
                                        value_of(earlier, quantity)->value_rad),
                      2.0 * kNanosecond_rad)
              << name_of(quantity) << ' ' << channel;
        }
      }
    }
  }
}

TEST(SpinMeasurements, SigmaIsTheScatterThatTheNoiseMakes) {
  constexpr int kDraws = 20000;
  Scene scene{.sun_angle_rad = 70.0 * kRadPerDeg};
  scene.config.sun_sensor.slit_cant_rad = 30.0 * kRadPerDeg;
  const Revolution exact = seen(scene);
  const RevolutionMeasurements truth = measure(scene.config, exact);
  std::mt19937_64 rng{71};
  std::normal_distribution<double> normal;
  std::array<double, kAll.size()> sums{};
  std::array<double, kAll.size()> squares{};
  for (int draw = 0; draw < kDraws; ++draw) {
    Revolution noisy = exact;
    for (std::size_t channel = 0; channel < kPulseChannels; ++channel) {
      const double sigma_s = edge_sigma_s(scene.config.noise, static_cast<PulseChannel>(channel));
      noisy.edges.at(channel) = shifted(noisy.edges.at(channel).value(), sigma_s * normal(rng));
    }
    const RevolutionMeasurements measured = measure(scene.config, noisy);
    for (std::size_t i = 0; i < kAll.size(); ++i) {
      const double error =
          value_of(measured, kAll.at(i))->value_rad - value_of(truth, kAll.at(i))->value_rad;
      const double normalised = error / value_of(truth, kAll.at(i))->sigma_rad;
      sums.at(i) += normalised;
      squares.at(i) += normalised * normalised;
    }
  }
  // Four standard errors: 1 / sqrt(n) of the mean, 1 / sqrt(2 n) of the standard deviation. The
  // curvature of theta_s over one sigma (6e-4 rad) is far below both.
  for (std::size_t i = 0; i < kAll.size(); ++i) {
    SCOPED_TRACE(name_of(kAll.at(i)));
    EXPECT_NEAR(sums.at(i) / kDraws, 0.0, 4.0 / std::sqrt(kDraws));
    EXPECT_NEAR(std::sqrt(squares.at(i) / kDraws), 1.0, 4.0 / std::sqrt(2.0 * kDraws));
  }
}

}  // namespace spindrift::testing::measurement_test
