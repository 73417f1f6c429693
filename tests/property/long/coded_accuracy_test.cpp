// Accuracy of the axis from coded telemetry, from `spindrift simulate` to the archive of `spindrift
// process`: sigma reaches the information limit and is consistent with the errors.

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <filesystem>
#include <string>
#include <utility>

#include "pipelines/frames/angle.h"
#include "pipelines/frames/celestial.h"
#include "tests/support/archive_rows.h"
#include "tests/support/information_limit.h"
#include "tests/support/observed_spin.h"
#include "tests/support/program.h"
#include "tests/support/test_paths.h"

namespace spindrift::testing::coded_accuracy_test {

constexpr double kDuration_s = 600.0;
constexpr int kPasses = 40;
const std::filesystem::path kScenario = scenarios() / "gto-nominal.toml";

// The scenario's axis, orbit and sensors.
const SpinningBody kBody = body_across_the_earth();

double information_limit_rad() {
  const auto around = seen_from(orbit_across_the_earth());
  return std::sqrt(cramer_rao_rad2(kBody, around, kDuration_s).trace());
}

/// Processes a simulated pass of coded frames and returns its archive.
std::filesystem::path processed(const TemporaryFolder& folder, int seed) {
  std::string text = text_of(kScenario);
  const std::string duration = "duration_s = 600.0\n";
  text.insert(text.find(duration), "seed = " + std::to_string(seed) + "\n");
  const auto scenario = folder.write("scenario.toml", text + "[telemetry]\nkind = \"coded\"\n");
  const auto pass = folder.path() / "pass";
  Program simulate{{"simulate", scenario.string(), "--out", pass.string()}};
  EXPECT_EQ(simulate.exit_status(), 0) << simulate.log();
  auto db = folder.path() / "processed.db";
  Program process{{"process", "--mission", (pass / "mission.toml").string(), "--telemetry",
                   pass.string(), "--db", db.string(), "--strict"}};
  EXPECT_EQ(process.exit_status(), 0) << process.log();
  return db;
}

struct Answer {
  Eigen::Vector3d axis_icrf;
  Eigen::Matrix2d covariance_rad2;
};

Answer answer_of(const std::filesystem::path& db, const std::string& estimator) {
  const auto value = [&](const std::string& column) {
    return real_of(db,
                   "SELECT " + column + " FROM pass_answer WHERE estimator = '" + estimator + "'");
  };
  const double east_north = value("cov_east_north_deg2");
  Eigen::Matrix2d covariance_deg2;
  covariance_deg2 << value("cov_east_east_deg2"), east_north, east_north,
      value("cov_north_north_deg2");
  return {.axis_icrf = direction_icrf(
              {.ra_rad = value("ra_deg") * kRadPerDeg, .dec_rad = value("dec_deg") * kRadPerDeg}),
          .covariance_rad2 = covariance_deg2 * kRadPerDeg * kRadPerDeg};
}

struct Sums {
  double squared_error = 0.0;   ///< Sum of squared errors normalised by the covariance.
  double variance_ratio = 0.0;  ///< Variance over the Cramer-Rao bound.
};

TEST(CodedAccuracy, SigmaIsWhatTheEdgesAllowAndErrorsAreWhatItPromises) {
  const double limit_rad = information_limit_rad();
  Sums mean;
  Sums sequential;
  for (int seed = 1; seed <= kPasses; ++seed) {
    SCOPED_TRACE(seed);
    const TemporaryFolder folder;
    const auto db = processed(folder, seed);
    ASSERT_FALSE(HasFailure());
    for (const auto& [estimator, sums] : {std::pair{"mean", &mean}, {"sequential", &sequential}}) {
      const Answer answer = answer_of(db, estimator);
      sums->squared_error += testing::squared_error(answer, kBody.axis_icrf);
      sums->variance_ratio += answer.covariance_rad2.trace() / (limit_rad * limit_rad) / kPasses;
    }
  }
  // The 0.05 % and 99.95 % points of chi-square with 80 degrees of freedom.
  for (const Sums& sums : {mean, sequential}) {
    EXPECT_GT(sums.squared_error, 44.79);
    EXPECT_LT(sums.squared_error, 128.26);
  }
  EXPECT_NEAR(sequential.variance_ratio, 1.0, 0.05);
  // The mean uses whole fixes only and loses the edges of revolutions without a good fix.
  EXPECT_GT(mean.variance_ratio, 0.95);
  EXPECT_LT(mean.variance_ratio, 1.25);
}

}  // namespace spindrift::testing::coded_accuracy_test
