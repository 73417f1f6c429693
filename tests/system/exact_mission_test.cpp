/// @file
/// Where the mission file is exactly true and says so, the answers are those of estimators that
/// know of noise only.

#include "tests/support/exact_mission.h"

#include <SQLiteCpp/Database.h>
#include <SQLiteCpp/Statement.h>
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include "pipelines/frames/angle.h"
#include "tests/support/archive_rows.h"
#include "tests/support/processed.h"
#include "tests/support/simulated.h"
#include "tests/support/test_paths.h"

namespace spindrift::exact_mission_test {

/// An answer of such estimators, as `tests/data/exact_mission` holds them.
struct Row {
  std::string estimator;
  std::int64_t t_tai_ns = 0;
  std::string quality;
  double sigma_deg = 0.0;
  std::vector<double> numbers;
};

std::vector<Row> rows_from(const std::filesystem::path& csv) {
  std::ifstream file{csv};
  std::vector<Row> rows;
  for (std::string line; std::getline(file, line);) {
    std::istringstream cells{line};
    Row row;
    std::string cell;
    std::getline(cells, row.estimator, ',');
    std::getline(cells, cell, ',');
    row.t_tai_ns = std::stoll(cell);
    std::getline(cells, row.quality, ',');
    std::getline(cells, cell, ',');
    row.sigma_deg = std::stod(cell);
    while (std::getline(cells, cell, ',')) {
      row.numbers.push_back(std::stod(cell));
    }
    rows.push_back(std::move(row));
  }
  return rows;
}

/// Processes a pass whose mission file says that it is exactly true.
/// @param query Selects quality, sigma, noise sigma and the numbers of an estimator at an instant.
/// @param unit_deg The size of a unit of the numbers in degrees.
void expect_as_by_noise_alone(const std::filesystem::path& pass, std::string_view exact,
                              const std::string& name, const char* query, double unit_deg) {
  const TemporaryFolder folder;
  std::filesystem::copy(pass, folder.path(), std::filesystem::copy_options::recursive);
  std::ofstream{folder.path() / "mission.toml", std::ios::app} << exact;
  const Processed processed{folder.path()};
  const SQLite::Database db{processed.db.string(), SQLite::OPEN_READONLY, kBusy_ms};
  const auto rows = rows_from(test_data() / "exact_mission" / (name + ".csv"));
  ASSERT_GT(rows.size(), 20U);
  for (const Row& row : rows) {
    SCOPED_TRACE(fmt::format("{} at {}", row.estimator, row.t_tai_ns));
    SQLite::Statement now{db, query};
    now.bind(1, row.estimator);
    now.bind(2, row.t_tai_ns);
    ASSERT_TRUE(now.executeStep());
    EXPECT_EQ(now.getColumn(0).getString(), row.quality);
    EXPECT_NEAR(now.getColumn(1).getDouble(), row.sigma_deg, 1e-9 * row.sigma_deg);
    EXPECT_NEAR(now.getColumn(2).getDouble(), row.sigma_deg, 1e-9 * row.sigma_deg);
    for (int i = 0; i < static_cast<int>(row.numbers.size()); ++i) {
      EXPECT_NEAR(now.getColumn(3 + i).getDouble(), row.numbers[static_cast<std::size_t>(i)],
                  1e-9 * row.sigma_deg / unit_deg)
          << i;
    }
  }
}

constexpr auto kAxis =
    "SELECT quality, sigma_deg, noise_sigma_deg, ra_deg, dec_deg, spin_rate_rpm FROM spin_estimate"
    " WHERE (estimator, t_tai_ns) = (?, ?)";
constexpr auto kAttitude =
    "SELECT quality, sigma_deg, noise_sigma_deg, qx, qy, qz, qw, rate_x_rad_s, rate_y_rad_s,"
    " rate_z_rad_s FROM attitude WHERE (source, t_tai_ns) = (?, ?)";

TEST(ExactMission, GivesASpinnerTheAnswersOfNoiseAlone) {
  expect_as_by_noise_alone(kPasses / "nominal", kExactSpin, "nominal", kAxis, 1.0);
}

TEST(ExactMission, GivesASeparationTheAnswersOfNoiseAlone) {
  expect_as_by_noise_alone(test_data() / "three-axis" / "separation", kExactThreeAxis, "separation",
                           kAttitude, 1.0 / kRadPerDeg);
}

TEST(ExactMission, GivesATumblingBodyTheAnswersOfNoiseAlone) {
  const Simulated tumbling{"tumbling.toml"};
  expect_as_by_noise_alone(tumbling.pass, kExactThreeAxis, "tumbling", kAttitude, 1.0 / kRadPerDeg);
}

}  // namespace spindrift::exact_mission_test
