#include "tests/support/recorded_separation.h"

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <variant>

#include "services/mission/mission.h"
#include "tests/support/test_paths.h"

namespace spindrift::testing {
namespace {

struct Row {
  TaiTime t;
  std::vector<double> values;
};

/// Returns the rows of a file; none if it does not exist.
std::vector<Row> rows_of(const std::filesystem::path& path) {
  std::ifstream file{path};
  std::string line;
  std::getline(file, line);
  std::vector<Row> rows;
  while (std::getline(file, line)) {
    std::istringstream fields{line};
    std::string field;
    std::getline(fields, field, ',');
    Row row{.t = tai_from_ns(std::stoll(field)), .values = {}};
    while (std::getline(fields, field, ',')) {
      row.values.push_back(std::stod(field));
    }
    rows.push_back(row);
  }
  return rows;
}

}  // namespace

RecordedSeparation recorded_separation(const std::string& name) {
  const std::filesystem::path folder = test_data() / "three-axis" / name;
  Mission mission = load_mission(folder / "mission.toml").value();
  RecordedSeparation pass{.sensors = std::get<ThreeAxisConfig>(mission.config),
                          .orbit = std::move(mission.orbit),
                          .times = {},
                          .gyro = {},
                          .sun = {},
                          .stars = {},
                          .truth = {}};
  for (const Row& row : rows_of(folder / "gyro.csv")) {
    pass.gyro.push_back({row.t, Eigen::Vector3d{row.values.data()}});
  }
  for (const Row& row : rows_of(folder / "sun.csv")) {
    pass.sun.push_back({row.t, Eigen::Vector3d{row.values.data()}});
  }
  for (const Row& row : rows_of(folder / "star.csv")) {
    pass.stars.push_back({row.t, Eigen::Quaterniond{row.values.data()}});
  }
  std::ifstream file{folder / "truth.json"};
  const nlohmann::json truth = nlohmann::json::parse(file);
  for (const char* const event : {"T1", "T2", "T3", "T4"}) {
    const auto q = truth.at(event).at("q_icrf_body_xyzw").get<std::vector<double>>();
    pass.truth[event] = {tai_from_ns(truth.at(event).at("t_tai_ns").get<std::int64_t>()),
                         Eigen::Quaterniond{q.data()}};
  }
  pass.times = {.separation = pass.truth["T1"].t,
                .control_on = pass.truth["T2"].t,
                .acquisition = pass.truth["T3"].t,
                .first_star_fix = pass.truth["T4"].t};
  return pass;
}

}  // namespace spindrift::testing
