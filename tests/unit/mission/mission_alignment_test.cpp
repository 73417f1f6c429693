#include <fmt/format.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include "pipelines/frames/angle.h"
#include "services/mission/mission.h"
#include "tests/support/matchers.h"
#include "tests/support/outcome.h"
#include "tests/unit/mission/mission_texts.h"

namespace spindrift::mission_test {
namespace {

constexpr double kDeg2 = kRadPerDeg * kRadPerDeg;

/// Returns the contract's example of a spinner with a [calibration] behind it.
std::string calibrated(std::string_view names, std::string_view covariance) {
  return fmt::format("{}\n[calibration]\nnames = {}\ncovariance = {}\n", contract(), names,
                     covariance);
}

std::string as_three_axis(const std::string& toml) {
  return replaced(toml, "kind = [\"']spin[\"']", "kind = \"three_axis\"");
}

SpinAlignment spin_alignment_of(std::string_view toml) {
  return value_or_throw(load(toml)).spin()->alignment;
}

ThreeAxisConfig three_axis_of(const std::string& toml) {
  return *value_or_throw(load(toml)).three_axis();
}

std::string without(const std::string& kind) {
  return replaced(contract(), "\n\\[" + kind + "\\.alignment\\][^@]*?\n\\[", "\n[");
}

SpinAlignment default_spin_alignment() {
  Eigen::Matrix<double, kSpinAlignmentErrors, 1> sigma;
  sigma << Eigen::Matrix<double, 6, 1>::Constant(0.05 * kRadPerDeg), 3.0, 0.0;
  return sigma.cwiseAbs2().asDiagonal();
}

TEST(MissionAlignment, OfASpinnerStandsAtItsDefaults) {
  EXPECT_TRUE(spin_alignment_of(contract()).isApprox(default_spin_alignment(), 1e-14));
  EXPECT_TRUE(spin_alignment_of(without("spin")).isApprox(default_spin_alignment(), 1e-14));
}

TEST(MissionAlignment, OfAThreeAxisSpacecraftStandsAtItsDefaults) {
  for (const std::string& toml : {contract(), without("three_axis")}) {
    const AttitudeAlignment b = three_axis_of(as_three_axis(toml)).alignment;
    EXPECT_TRUE(b.isDiagonal());
    const auto sigma = [&](int error) { return std::sqrt(b(error, error)); };
    for (int axis = 0; axis < 3; ++axis) {
      EXPECT_NEAR(sigma(StarTrackerError + axis), 0.01 * kRadPerDeg, 1e-15);
      EXPECT_NEAR(sigma(SunSensorError + axis), 0.2 * kRadPerDeg, 1e-15);
      EXPECT_NEAR(sigma(MagnetometerError + axis), 0.3 * kRadPerDeg, 1e-15);
      EXPECT_NEAR(sigma(MagnetometerBiasError + axis), 100.0, 1e-12);
      EXPECT_NEAR(sigma(GyroScaleError + axis), 0.001, 1e-15);
      EXPECT_NEAR(sigma(GyroAxisError + axis), 0.05 * kRadPerDeg, 1e-15);
      EXPECT_NEAR(sigma(GyroAxisError + 3 + axis), 0.05 * kRadPerDeg, 1e-15);
      EXPECT_NEAR(sigma(StarTrackerTimeError + axis), 0.01, 1e-15);
    }
  }
}

TEST(MissionAlignment, OfTheInertiaIsThatOfItsOwnTableWhereThatSpeaks) {
  const auto own =
      three_axis_of(as_three_axis(contract_with("three_axis.inertia.sigma_fraction", "0.02")));
  EXPECT_NEAR(own.inertia->sigma_fraction, 0.02, 1e-15);
  EXPECT_NEAR(own.alignment(InertiaError, InertiaError), 4e-4, 1e-15);
  const auto stated =
      three_axis_of(as_three_axis(replaced(contract(), "sigma_fraction = 0.0.*\n", "")));
  EXPECT_NEAR(stated.inertia->sigma_fraction, 0.05, 1e-15);
  EXPECT_NEAR(stated.alignment(InertiaError + 2, InertiaError + 2), 2.5e-3, 1e-15);
}

TEST(MissionAlignment, IsZeroWhereAllKeysAre) {
  toml::table document = toml::parse(contract());
  for (const char* const south : {"south_mount_angle_deg", "south_azimuth_deg"}) {
    document["spin"]["alignment"].as_table()->insert(south, 0.05);
  }
  for (const std::string_view kind : {"spin", "three_axis"}) {
    for (auto&& [key, value] : *document[kind]["alignment"].as_table()) {
      *value.as_floating_point() = 0.0;
    }
  }
  std::ostringstream toml;
  toml << document;
  EXPECT_TRUE(spin_alignment_of(toml.str()).isZero(0.0));
  EXPECT_TRUE(three_axis_of(as_three_axis(toml.str())).alignment.isZero(0.0));
}

TEST(MissionAlignment, IsWithCalibrationThatOfTheKeysItNames) {
  const SpinAlignment b = spin_alignment_of(
      calibrated(R"(["spin.horizon.co2_altitude_km", "spin.ir.north.mount_angle_deg"])",
                 "[[1.0, 0.02], [0.02, 1.0e-3]]"));
  SpinAlignment expected = default_spin_alignment();
  expected(Co2AltitudeError, Co2AltitudeError) = 1.0;
  expected(NorthMountAngleError, NorthMountAngleError) = 1e-3 * kDeg2;
  expected(Co2AltitudeError, NorthMountAngleError) = 0.02 * kRadPerDeg;
  expected(NorthMountAngleError, Co2AltitudeError) = 0.02 * kRadPerDeg;
  EXPECT_LT((b - expected).cwiseAbs().maxCoeff(), 1e-16);
}

TEST(MissionAlignment, OfThreeAxesIsWithCalibrationThatOfTheKeysItNames) {
  const auto config = three_axis_of(as_three_axis(
      calibrated(R"(["inertia_y_fraction", "gyro_xy_deg"])", "[[1.0e-4, 0], [0, 9]]")));
  EXPECT_NEAR(config.alignment(InertiaError + 1, InertiaError + 1), 1e-4, 1e-18);
  EXPECT_EQ(config.alignment(InertiaError, InertiaError), 0.0);  // Of its own table.
  EXPECT_NEAR(config.alignment(GyroAxisError, GyroAxisError), 9.0 * kDeg2, 1e-15);
}

std::vector<std::string> defaults_of(const std::string& toml) {
  std::vector<std::string> keys;
  for (const DefaultSigma& sigma : value_or_throw(load(toml)).default_sigmas) {
    keys.push_back(fmt::format("{} = {}", sigma.key, sigma.value));
  }
  return keys;
}

TEST(MissionAlignment, ListsWhatStandsAtItsDefaultOfTheSensorsThatThereAre) {
  EXPECT_THAT(defaults_of(contract()), IsEmpty());
  EXPECT_THAT(defaults_of(without("spin")),
              ElementsAre("spin.alignment.slit_cant_deg = 0.05",
                          "spin.alignment.slit_separation_deg = 0.05",
                          "spin.alignment.north_mount_angle_deg = 0.05",
                          "spin.alignment.north_azimuth_deg = 0.05",
                          "spin.alignment.co2_altitude_km = 3", "spin.alignment.time_tag_s = 0"));
  EXPECT_THAT(
      defaults_of(as_three_axis(without("three_axis"))),
      ElementsAre("three_axis.alignment.star_tracker_deg = 0.01",
                  "three_axis.alignment.sun_sensor_deg = 0.2",
                  "three_axis.alignment.magnetometer_deg = 0.3",
                  "three_axis.alignment.magnetometer_bias_nt = 100",
                  "three_axis.alignment.gyro_scale = 0.001", "three_axis.alignment.gyro_deg = 0.05",
                  "three_axis.alignment.time_tag_s = 0.01"));
  EXPECT_THAT(defaults_of(replaced(calibrated(R"(["spin.sun_sensor.slit_cant_deg"])", "[[1e-4]]"),
                                   "\nslit_cant_deg = 0.05", "")),
              IsEmpty());
}

TEST(MissionAlignment, NeedNotBePositiveDefinite) {
  EXPECT_THAT(
      problems_of(calibrated(R"(["spin.horizon.co2_altitude_km", "spin.ir.north.mount_angle_deg"])",
                             "[[1, 0.1], [0.1, 0.01]]")),
      IsEmpty());
  EXPECT_THAT(problems_of(calibrated(R"(["spin.alignment.time_tag_s"])", "[[0]]")), IsEmpty());
}

TEST(MissionAlignment, OfTheSunSensorIsRefusedAtItsOldPlace) {
  EXPECT_THAT(problems_of(contract_with("three_axis.sun_sensor.misalignment_sigma_deg", "0.5")),
              ElementsAre(HasSubstr(": three_axis.sun_sensor.misalignment_sigma_deg = 0.5: moved "
                                    "to [three_axis.alignment] sun_sensor_deg")));
}

TEST(MissionAlignment, OfABiasToEstimateMustNotBeZero) {
  const std::string asked = contract() + "\n[spin.batch]\nsun_angle = true\ndihedral = true\n";
  EXPECT_THAT(problems_of(asked), IsEmpty());
  const auto exact = [](const std::string& toml, const std::string& key) {
    return replaced(toml, "\n" + key + " = 0.05", "\n" + key + " = 0.0");
  };
  const std::string one = exact(asked, "slit_cant_deg");
  EXPECT_THAT(problems_of(one), IsEmpty());
  EXPECT_THAT(problems_of(exact(one, "slit_separation_deg")),
              ElementsAre(HasSubstr(": spin.batch.sun_angle = true: by the alignment "
                                    "spin.sun_sensor.slit_cant_deg is known exactly; ")));
}

struct BadCalibration {
  std::string_view names;
  std::string_view covariance;
  std::string problem;  ///< With NAMES or COVARIANCE for file and line.
};

/// Two good names and three, without the brackets.
constexpr std::string_view kTwo =
    R"(["spin.horizon.co2_altitude_km", "spin.ir.north.mount_angle_deg"])";
constexpr std::string_view kThree =
    R"(["spin.horizon.co2_altitude_km", "spin.ir.north.mount_angle_deg", "spin.ir.north.azimuth_deg"])";

TEST(MissionAlignment, IsRefusedWithWhatIsWrongInItsCalibration) {
  const std::vector<BadCalibration> all = {
      {R"(["spin.ir.north.mount_agle_deg"])", "[[1e-4]]",
       "NAMES: calibration.names[0] = \"spin.ir.north.mount_agle_deg\": unknown; did you mean "
       "spin.ir.north.mount_angle_deg?"},
      {R"(["colour"])", "[[1e-4]]",
       "NAMES: calibration.names[0] = \"colour\": unknown; allowed here: "
       "spin.sun_sensor.slit_cant_deg, "},
      {R"(["gyro_scale_x"])", "[[1e-8]]",
       "NAMES: calibration.names[0] = \"gyro_scale_x\": is of a spacecraft of kind "
       "\"three_axis\", this one is \"spin\""},
      {R"(["spin.ir.south.azimuth_deg"])", "[[1e-4]]",
       "NAMES: calibration.names[0] = \"spin.ir.south.azimuth_deg\": must be of a sensor that this "
       "mission has: spin.ir.south.azimuth_deg is missing"},
      {R"(["spin.ir.north.azimuth_deg", "spin.ir.north.azimuth_deg"])", "[[1e-4, 0], [0, 1e-4]]",
       "NAMES: calibration.names[1] = \"spin.ir.north.azimuth_deg\": must be named once"},
      {"[]", "[[1e-4]]", "NAMES: calibration.names = []: must be an array of n texts"},
      {"[3]", "[[1e-4]]", "NAMES: calibration.names = [ 3 ]: must be an array of n texts"},
      {kTwo, "[[1]]",
       "COVARIANCE: calibration.covariance has 1 rows: must have a row and a column for each of "
       "the 2 names"},
      {kTwo, "[[1, 0, 0], [0]]",
       "COVARIANCE: calibration.covariance = [ [ 1, 0, 0 ], [ 0 ] ]: must be an array of n x n "
       "numbers in [-1000000000000, 1000000000000]"},
      {kTwo, "[1, 1]", "COVARIANCE: calibration.covariance = [ 1, 1 ]: must be an array of n x n"},
      {kTwo, "[[1, nan], [nan, 1]]", "COVARIANCE: calibration.covariance = ["},
      {kTwo, "[[1, 0], [0, -1e-4]]",
       "COVARIANCE: calibration.covariance[1][1] = -0.0001: the variance of "
       "spin.ir.north.mount_angle_deg must lie in [0, 100]"},
      {kTwo, "[[2501, 0], [0, 1e-4]]",
       "COVARIANCE: calibration.covariance[0][0] = 2501: the variance of "
       "spin.horizon.co2_altitude_km must lie in [0, 2500]"},
      {kTwo, "[[1, 0.01], [0.02, 1]]",
       "COVARIANCE: calibration.covariance[1][0] = 0.02: must be symmetric, [0][1] = 0.01"},
      {kTwo, "[[4, 2.1], [2.1, 1]]",
       "COVARIANCE: calibration.covariance[1][0] = 2.1: the correlation of "
       "spin.horizon.co2_altitude_km and spin.ir.north.mount_angle_deg must lie in [-1, 1]: at "
       "most 2 by their variances"},
      {kTwo, "[[0, 1e-6], [1e-6, 1]]",
       "COVARIANCE: calibration.covariance[1][0] = 1e-06: the correlation of "
       "spin.horizon.co2_altitude_km and spin.ir.north.mount_angle_deg must lie in [-1, 1]: at "
       "most 0 by their variances"},
      // Each pair of the three is correlated by -0.6, which three cannot be.
      {kThree, "[[1, -0.6, -0.6], [-0.6, 1, -0.6], [-0.6, -0.6, 1]]",
       "COVARIANCE: calibration.covariance: must be positive semidefinite: the least eigenvalue of "
       "its correlations is -0.2"},
  };
  for (const auto& [names, covariance, problem] : all) {
    const std::string toml = calibrated(names, covariance);
    const auto last_line = std::ranges::count(toml, '\n');
    const bool of_names = problem.starts_with("NAMES");
    const std::string expected = fmt::format("mission.toml:{}{}", last_line - (of_names ? 1 : 0),
                                             problem.substr(problem.find(':')));
    EXPECT_THAT(problems_of(toml), ElementsAre(StartsWith(expected)));
  }
}

TEST(MissionAlignment, IsRefusedWithHalfACalibration) {
  EXPECT_THAT(
      problems_of(contract() + "\n[calibration]\nnames = [\"gyro_scale_x\"]\n"),
      ElementsAre(HasSubstr(": calibration.covariance: missing: an array of n x n numbers")));
  EXPECT_THAT(problems_of(contract() + "\n[calibration]\ncovariance = [[1]]\n"),
              ElementsAre(HasSubstr(": calibration.names: missing: an array of n texts")));
}

}  // namespace
}  // namespace spindrift::mission_test
