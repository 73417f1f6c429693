/// The attitude that a very small satellite computes itself, against the truth.

#include "pipelines/geomagnetism/tables/on_board_attitude.h"

#include <Eigen/Geometry>
#include <vector>

#include "pipelines/ephemeris/flight_frames.h"
#include "pipelines/ephemeris/sun.h"
#include "pipelines/frames/angle.h"
#include "pipelines/frames/celestial.h"
#include "pipelines/frames/rotation_vector.h"
#include "pipelines/geomagnetism/tables/revolution_field.h"
#include "pipelines/time/utc.h"
#include "services/mission/igrf.h"
#include "tests/support/matchers.h"

namespace spindrift::testing::on_board_attitude_test {

using Eigen::Vector3d;

TEST(SunByFormula, IsWithinAFiftiethOfADegreeForACentury) {
  ApparentSun sun;
  const OrbitState at_centre{.position_icrf_km = Vector3d::Zero(),
                             .velocity_icrf_km_s = Vector3d::Zero()};
  for (int day = -20 * 365; day < 80 * 365; day += 97) {
    const TaiTime t{std::chrono::days{day}};
    EXPECT_LT(degrees(angle_between_rad(sun_by_formula_icrf(t), sun.direction_icrf(t, at_centre))),
              0.02)
        << day;
  }
}

class OnBoardAttitudes : public ::testing::Test {
 protected:
  OnBoardModel model(TableKind kind) {
    return {.orbit = orbit_,
            .table = make_table([&](double behind_rad) { return revolution_.at(behind_rad); }, kind,
                                orbit_.true_anomaly_at_epoch_rad(), 80)
                         .value(),
            .field = field_};
  }

  /// Measures Sun and field without noise.
  void measure(TaiTime t) {
    const OrbitState here = orbit_.at(t).value();
    const Eigen::Quaterniond q_icrf_orbit = orbit_frame(here).value();
    const Vector3d field_nt = field_orbit_nt(field_, here, earth_orientation(t)).value();
    suns_.push_back({.t = t, .sun_body = q_icrf_body_.conjugate() * sun_.direction_icrf(t, here)});
    fields_.push_back(
        {.t = t, .field_body_nt = q_icrf_body_.conjugate() * (q_icrf_orbit * field_nt)});
  }

  std::vector<OnBoardAttitude> attitudes(TableKind kind) {
    return on_board_attitudes(model(kind), suns_, fields_).value();
  }
  double error_deg(const Eigen::Quaterniond& q_icrf_body) const {
    return degrees(angle_between_rad(q_icrf_body, q_icrf_body_));
  }

  TaiTime epoch_ = parse_utc("2026-03-01T04:00:00").value();
  KeplerOrbit orbit_ = KeplerOrbit::make({.epoch = epoch_,
                                          .semi_major_axis_km = 8000.0,
                                          .eccentricity = 0.1,
                                          .inclination_rad = 97.0 * kRadPerDeg,
                                          .raan_rad = 100.0 * kRadPerDeg,
                                          .argument_of_perigee_rad = 10.0 * kRadPerDeg,
                                          .mean_anomaly_rad = 30.0 * kRadPerDeg})
                           .value();
  MainField field_ = igrf().value().at(2026.16).value();
  RevolutionField revolution_{orbit_, field_};
  ApparentSun sun_;
  Eigen::Quaterniond q_icrf_body_ = quaternion_by({0.3, -1.2, 0.7});
  std::vector<SunDirection> suns_;
  std::vector<MagneticField> fields_;
};

TEST_F(OnBoardAttitudes, AreTheTruthButForTheSunAndTheTable) {
  for (int i = 0; i < 70; ++i) {
    measure(shifted(epoch_, 100.0 * i));
  }
  ASSERT_EQ(attitudes(TableKind::Chebyshev).size(), 70U);
  for (const OnBoardAttitude& at : attitudes(TableKind::Chebyshev)) {
    EXPECT_LT(error_deg(at.q_icrf_body_with_field), 0.1);
    EXPECT_LT(degrees(angle_between_rad(at.q_icrf_body, at.q_icrf_body_with_field)), 1e-5);
  }
  double most_deg = 0.0;
  for (const OnBoardAttitude& at : attitudes(TableKind::Uniform)) {
    most_deg =
        std::max(most_deg, degrees(angle_between_rad(at.q_icrf_body, at.q_icrf_body_with_field)));
  }
  EXPECT_GT(most_deg, 0.001);
  EXPECT_LT(most_deg, 0.2);
}

TEST_F(OnBoardAttitudes, NeedBothSensorsAtTheSameInstant) {
  for (int i = 0; i < 6; ++i) {
    measure(shifted(epoch_, 10.0 * i));
  }
  suns_.erase(suns_.begin() + 1);
  fields_.erase(fields_.begin() + 3);
  fields_[0].t += std::chrono::nanoseconds{1};
  const auto found = attitudes(TableKind::Chebyshev);
  ASSERT_EQ(found.size(), 3U);
  EXPECT_EQ(found[0].t, shifted(epoch_, 20.0));
  EXPECT_EQ(found[1].t, shifted(epoch_, 40.0));
  EXPECT_EQ(found[2].t, shifted(epoch_, 50.0));
}

TEST_F(OnBoardAttitudes, AreNoneWhereSunAndFieldAreInLine) {
  measure(epoch_);
  fields_[0].field_body_nt = 30'000.0 * suns_[0].sun_body;
  EXPECT_TRUE(attitudes(TableKind::Chebyshev).empty());
}

TEST_F(OnBoardAttitudes, AreOffInTheNextRevolutionWhenTheEarthHasTurned) {
  measure(epoch_);
  measure(orbit_.when_behind_epoch(1.0 + kTurn_rad));
  const auto found = attitudes(TableKind::Chebyshev);
  ASSERT_EQ(found.size(), 2U);
  EXPECT_LT(error_deg(found[0].q_icrf_body), 0.1);
  EXPECT_GT(error_deg(found[1].q_icrf_body), 1.0);
  EXPECT_LT(error_deg(found[1].q_icrf_body_with_field), 0.1);
}

}  // namespace spindrift::testing::on_board_attitude_test
