#include "services/mission/mission.h"

#include <Eigen/Geometry>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

#include "pipelines/frames/angle.h"
#include "services/mission/limits_in_force.h"
#include "tests/support/matchers.h"
#include "tests/support/outcome.h"
#include "tests/support/temporary_folder.h"
#include "tests/unit/mission/mission_texts.h"

namespace spindrift::mission_test {

TEST(Mission, GivesASpinnerAsTheContractDescribesIt) {
  const auto mission = value_or_throw(load(contract()));
  EXPECT_EQ(mission.spacecraft_id, "SPINNER");
  EXPECT_EQ(mission.kind(), SpacecraftKind::Spin);
  EXPECT_TRUE(mission.orbit);
  ASSERT_TRUE(mission.spin());
  const SpinConfig& spin = *mission.spin();
  EXPECT_DOUBLE_EQ(spin.sun_sensor.slit_cant_rad, 45.0 * kRadPerDeg);
  EXPECT_DOUBLE_EQ(spin.sun_sensor.slit_separation_rad, 35.0 * kRadPerDeg);
  ASSERT_TRUE(spin.north);
  EXPECT_DOUBLE_EQ(spin.north->mount_angle_rad, 85.0 * kRadPerDeg);
  EXPECT_DOUBLE_EQ(spin.north->azimuth_rad, 90.0 * kRadPerDeg);
  EXPECT_FALSE(spin.north->healthy);
  EXPECT_FALSE(spin.south);
  EXPECT_EQ(spin.noise.sun_s, 1.0e-4);
  EXPECT_EQ(spin.noise.infrared_s, 5.0e-4);
  EXPECT_EQ(spin.horizon.model, HorizonModel::Sphere);
  EXPECT_EQ(spin.horizon.co2_altitude_km, 40.0);
  ASSERT_TRUE(spin.prior);
  // Right ascension 100 deg, declination -55 deg.
  EXPECT_NEAR(spin.prior->axis_icrf.x(), -0.0996005, 1e-7);
  EXPECT_NEAR(spin.prior->axis_icrf.y(), 0.5648625, 1e-7);
  EXPECT_NEAR(spin.prior->axis_icrf.z(), -0.8191520, 1e-7);
  EXPECT_DOUBLE_EQ(spin.prior->sigma_rad, 5.0 * kRadPerDeg);
}

TEST(Mission, KeepsEveryOptionalValueThatIsGiven) {
  auto toml = contract();
  toml = replaced(toml, "healthy = false", "healthy = true");
  toml = replaced(toml, "\"sphere\"", "\"ellipsoid\"");
  toml = replaced(toml, "window = 100", "window = 50");
  toml = replaced(toml, "sigma = 3.0", "sigma = 4");
  toml = replaced(toml, "interference_s = 0.0", "interference_s = 0.001");
  toml = replaced(toml, "usable = 0.03", "usable = 0.05");
  toml = replaced(toml, "ambiguous = 0.01", "ambiguous = 0.02");
  toml += "[spin.ir.south]\nmount_angle_deg = 95\nazimuth_deg = -92\n";
  const auto mission = value_or_throw(load(toml));
  const SpinConfig& spin = *mission.spin();
  EXPECT_TRUE(spin.north->healthy);
  ASSERT_TRUE(spin.south);
  EXPECT_DOUBLE_EQ(spin.south->mount_angle_rad, 95.0 * kRadPerDeg);
  EXPECT_DOUBLE_EQ(spin.south->azimuth_rad, -92.0 * kRadPerDeg);
  EXPECT_FALSE(spin.south->healthy);
  EXPECT_EQ(spin.horizon.model, HorizonModel::Ellipsoid);
  EXPECT_EQ(spin.screening.window, 50);
  EXPECT_EQ(spin.screening.sigma, 4.0);
  EXPECT_EQ(spin.screening.interference_s, 0.001);
  EXPECT_EQ(spin.geometry.determinant_usable, 0.05);
  EXPECT_EQ(spin.geometry.determinant_ambiguous, 0.02);
}

TEST(Mission, HasTheDefaultsOfThePipelineWhereTheFileIsSilent) {
  const auto mission = value_or_throw(load_mission(kData / "spin" / "nominal" / "mission.toml"));
  EXPECT_EQ(mission.spin()->screening.window, SpinScreening{}.window);
  EXPECT_EQ(mission.spin()->screening.sigma, SpinScreening{}.sigma);
  EXPECT_EQ(mission.spin()->screening.interference_s, SpinScreening{}.interference_s);
  EXPECT_EQ(mission.spin()->geometry.determinant_usable, SpinGeometry{}.determinant_usable);
  EXPECT_EQ(mission.spin()->geometry.determinant_ambiguous, SpinGeometry{}.determinant_ambiguous);
  EXPECT_FALSE(mission.spin()->prior);
}

TEST(Mission, HasLimitsOfAlertsAndATargetWhereTheFileGivesThem) {
  EXPECT_EQ(value_or_throw(load(kElements)).alerts, AlertLimits{});
  const auto contract_mission = load(contract()).value();
  EXPECT_EQ(contract_mission.alerts.ambiguous_s, AlertLimits{}.ambiguous_s);
  EXPECT_EQ(contract_mission.alerts.rejection.revolutions, AlertLimits{}.rejection.revolutions);
  const auto& target = contract_mission.target.value();
  EXPECT_NEAR(target.axis_icrf.z(), std::sin(-55.0 * kRadPerDeg), 1e-15);
  EXPECT_NEAR(target.rate.value().rad_s, 6.283185307179586, 1e-12);
  const auto given = value_or_throw(
      load(replaced(contract(), "\"spin.sigma\" = .*", "\"spin.ambiguous\" = { seconds = 7.0 }")));
  EXPECT_EQ(given.alerts.ambiguous_s, 7.0);
}

TEST(Mission, OfAThreeAxisSpacecraftHasItsSensorsAndInertiaButNoSpin) {
  const auto mission =
      value_or_throw(load(replaced(contract(), "kind = \"spin\"", "kind = \"three_axis\"")));
  EXPECT_EQ(mission.kind(), SpacecraftKind::ThreeAxis);
  EXPECT_FALSE(mission.spin());
  EXPECT_TRUE(mission.orbit);
  const auto& config = std::get<ThreeAxisConfig>(mission.config);
  ASSERT_TRUE(config.gyro && config.sun_sensor && config.star_tracker && config.magnetometer);
  EXPECT_DOUBLE_EQ(config.gyro->noise_rad_s, 0.002 * kRadPerDeg);
  EXPECT_DOUBLE_EQ(config.gyro->bias_sigma_rad_s, 0.01 * kRadPerDeg);
  EXPECT_DOUBLE_EQ(config.gyro->range_rad_s.value(), 100.0 * kRadPerDeg);
  EXPECT_DOUBLE_EQ(config.sun_sensor->noise_rad, 0.5 * kRadPerDeg);
  EXPECT_DOUBLE_EQ(config.star_tracker->noise_rad, 20.0 / 3600.0 * kRadPerDeg);
  EXPECT_EQ(config.star_tracker->q_body_sensor.w(), 1.0);
  EXPECT_EQ(config.magnetometer->noise_nt, 100.0);
  ASSERT_TRUE(config.inertia);
  EXPECT_EQ(config.inertia->kg_m2.diagonal(), Eigen::Vector3d(120.0, 100.0, 140.0));
  EXPECT_EQ(config.inertia->sigma_fraction, 0.0);
}

TEST(Mission, KeepsTheOrderOfTheQuaternionThatTheFileHas) {
  const auto mission = value_or_throw(load_mission(kData / "mission" / "separation.toml"));
  const auto& tracker = std::get<ThreeAxisConfig>(mission.config).star_tracker.value();
  EXPECT_NEAR(tracker.q_body_sensor.x(), 0.191688957157693, 1e-12);
  EXPECT_NEAR(tracker.q_body_sensor.w(), 0.876384251986657, 1e-12);
}

TEST(Mission, OfAThreeAxisSpacecraftMayHaveNoOrbit) {
  const auto mission = value_or_throw(load_mission(kData / "mission" / "juno.toml"));
  EXPECT_EQ(mission.spacecraft_id, "juno");
  EXPECT_FALSE(mission.orbit);
}

TEST(Mission, IsReadFromEveryFileThatWeHave) {
  int count = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator{kData}) {
    const auto folder = entry.path().parent_path().filename();
    if (entry.path().filename() == "mission.toml" ||
        (folder == "mission" && entry.path().extension() == ".toml")) {
      SCOPED_TRACE(entry.path());
      const auto mission = value_or_throw(load_mission(entry.path()));
      for (const std::string& doubt : mission.orbit_doubts) {
        EXPECT_THAT(doubt, Not(HasSubstr("jumps")));
      }
      ++count;
    }
  }
  EXPECT_GE(count, 6);
}

TEST(Mission, KeepsItsTextAndTheDigestOfIt) {
  const auto mission = value_or_throw(load(kElements));
  EXPECT_EQ(mission.toml_text, kElements);
  EXPECT_EQ(mission.sha256, "93982e46ee9573e317a20ad5691cd557a7bef3767e635b3b7261c7bd8bcd5d08");
}

TEST(Mission, TakesItsOrbitFromElements) {
  const auto mission = value_or_throw(load(kElements));
  ASSERT_TRUE(mission.orbit);
  EXPECT_FALSE(mission.orbit_sha256);
  const auto state = mission.orbit->at(tai_from_ns(1795143637000000000)).value();
  EXPECT_NEAR(state.position_icrf_km.norm(), 7000.0, 7000.0 * 0.001);
  // The inclination is the angle of the orbit normal from the pole.
  const auto normal = state.position_icrf_km.cross(state.velocity_icrf_km_s).normalized();
  EXPECT_NEAR(normal.z(), std::cos(98.0 * kRadPerDeg), 1e-12);
}

TEST(Mission, FindsItsOrbitBesideIt) {
  const TemporaryFolder folder;
  std::filesystem::create_directory(folder.path() / "orbits");
  folder.write("orbits/a.oem", text_of(kData / "mission" / "orbit.oem"));
  const auto path = folder.write(
      "mission.toml",
      "spacecraft = {id = \"A\", kind = \"three_axis\"}\norbit.oem = \"orbits/a.oem\"");
  const auto mission = value_or_throw(load_mission(path));
  EXPECT_TRUE(mission.orbit);
  // Computed with sha256sum.
  EXPECT_EQ(mission.orbit_sha256,
            "fa12bab2701921c14d404592742de10c1b9252419573b8ee588436c30390c9c1");
}

/// Returns the orbit doubts of the contract's mission for another spacecraft name. The orbit is
/// that of LEOSAT, 2026-999A.
std::vector<std::string> orbit_doubts_of(const char* spacecraft) {
  return load(contract_with("spacecraft.id", spacecraft)).value().orbit_doubts;
}

TEST(Mission, DoubtsAnOrbitUnderTheNameOfAnother) {
  EXPECT_THAT(orbit_doubts_of("'SPINNER'"),
              ElementsAre("the orbit file says OBJECT_NAME = LEOSAT, OBJECT_ID = 2026-999A, the "
                          "mission file spacecraft.id = \"SPINNER\""));
  EXPECT_THAT(orbit_doubts_of("'LEOSAT'"), IsEmpty());
  EXPECT_THAT(orbit_doubts_of("'2026-999A'"), IsEmpty());
  EXPECT_THAT(load(kElements).value().orbit_doubts, IsEmpty());
}

TEST(Mission, DoubtsAnOrbitThatJumps) {
  const TemporaryFolder folder;
  const std::string orbit = text_of(kData / "mission" / "orbit.oem");
  folder.write("orbit.oem", replaced(orbit, "6468\\.015605479", "6453.015605479"));
  const auto mission = value_or_throw(
      load_mission(folder.write("mission.toml", contract_with("spacecraft.id", "'LEOSAT'"))));
  // The distance to the Earth's centre is 7037 km.
  EXPECT_THAT(
      mission.orbit_doubts,
      ElementsAre(AllOf(
          HasSubstr("orbit.oem = \"orbit.oem\", line 33: the orbit jumps by 15 km at "
                    "2026-03-01T04:06:00.000Z, the first of 2 such steps: states of different"),
          HasSubstr("off by up to 0.12 deg there"))));
}

TEST(Mission, DoubtsAnOrbitWhoseSegmentsDoNotMeet) {
  const std::string orbit = text_of(kData / "mission" / "orbit.oem");
  const std::string head = orbit.substr(0, orbit.find("2026-03-01T03:58:00.000 "));
  // Both segments contain this state.
  const std::size_t joint = orbit.find("2026-03-01T04:02:00.000 ");
  const std::size_t behind = orbit.find("2026-03-01T04:02:30.000 ");
  const std::string two =
      orbit.substr(0, behind) + head.substr(head.find("META_START")) + orbit.substr(joint);
  for (const bool meet : {true, false}) {
    const TemporaryFolder folder;
    std::string text = two;
    if (!meet) {
      const std::string speed = "-0.774484845657";
      text.replace(text.rfind(speed), speed.size(), "-0.654484845657");
    }
    folder.write("orbit.oem", text);
    const auto mission = value_or_throw(
        load_mission(folder.write("mission.toml", contract_with("spacecraft.id", "'LEOSAT'"))));
    if (meet) {
      EXPECT_THAT(mission.orbit_doubts, IsEmpty());
    } else {
      EXPECT_THAT(mission.orbit_doubts,
                  ElementsAre(HasSubstr("line 38: two segments do not meet at "
                                        "2026-03-01T04:02:00.000Z: by 0.000 km and 120.00 m/s: ")));
    }
  }
}

TEST(Mission, KnowsThePlannedContact) {
  EXPECT_FALSE(load(kElements)->contact);
  const auto mission = value_or_throw(load(contract()));
  EXPECT_EQ(mission.contact->to - mission.contact->from, std::chrono::minutes{10});
}

TEST(Mission, HasLimitsOfItsOwnBeforeAndAfterTheContactUntilAnOperatorSetsOne) {
  const auto mission = value_or_throw(
      load(contract() + "\n[alerts.before_aos]\n\"spin.sigma\" = { deg = 3.0 }\n"
                        "[alerts.after_los]\n\"spin.sigma\" = { deg = 2.0, after_s = 0.0 }\n"));
  LimitsInForce limits{mission.alert_values, mission.contact};
  const auto [aos, los] = mission.contact.value();
  const auto sigma_deg = [&](TaiTime t) { return limits.at(t).sigma_deg; };
  constexpr std::chrono::nanoseconds kMoment{1};
  EXPECT_EQ(sigma_deg(aos - kMoment), 3.0);
  EXPECT_EQ(limits.at(aos - kMoment).sigma_after_s, 120.0);
  EXPECT_EQ(sigma_deg(aos), 1.0);
  EXPECT_EQ(sigma_deg(los - kMoment), 1.0);
  EXPECT_EQ(sigma_deg(los), 2.0);
  EXPECT_EQ(limits.at(los).sigma_after_s, 0.0);
  limits.set(aos + std::chrono::minutes{1}, {.key = "spin.sigma", .limits = {{"deg", 0.5}}});
  EXPECT_EQ(sigma_deg(aos), 1.0);
  EXPECT_EQ(sigma_deg(aos + std::chrono::minutes{1}), 0.5);
  EXPECT_EQ(sigma_deg(los), 0.5);
  EXPECT_EQ(limits.at(los).sigma_after_s, 0.0);
}

TEST(Mission, GivesTheCommandedAttitudeInItsFrame) {
  const auto nominal = [](const std::string& keys) {
    return value_or_throw(load(std::string{kElements} + keys)).three_axis()->nominal;
  };
  EXPECT_FALSE(nominal(""));
  const auto in_orbit = nominal("[three_axis.nominal]\nq_orbit_body = [0.6, 0, 0, 0.8]\n");
  ASSERT_TRUE(in_orbit);
  EXPECT_EQ(in_orbit->frame, NominalAttitude::Frame::Orbit);
  EXPECT_NEAR(in_orbit->q_frame_body.x(), 0.6, 1e-12);
  EXPECT_NEAR(in_orbit->q_frame_body.w(), 0.8, 1e-12);
  const auto in_icrf = nominal("[three_axis.nominal]\nq_icrf_body = [0, 0, 0.7071, 0.7071]\n");
  ASSERT_TRUE(in_icrf);
  EXPECT_EQ(in_icrf->frame, NominalAttitude::Frame::Icrf);
  EXPECT_NEAR(in_icrf->q_frame_body.norm(), 1.0, 1e-12) << "it is made of unit length";
}

}  // namespace spindrift::mission_test
