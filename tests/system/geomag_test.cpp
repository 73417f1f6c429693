#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>

#include "pipelines/frames/angle.h"
#include "pipelines/frames/wgs84.h"
#include "tests/support/program.h"
#include "tests/support/ran.h"

namespace spindrift::geomag_test {

using ::testing::HasSubstr;
using ::testing::IsEmpty;

const std::string kHeader = "lat_deg,lon_deg,height_km\n";

/// Runs the command on a file of points with this text.
struct FieldAt {
  explicit FieldAt(const std::string& text, const std::string& year = "2025.0", bool json = false)
      : points{(folder.path() / "points.csv").string()} {
    std::ofstream{points} << text;
    std::vector<std::string> arguments = {"geomag", "field", "--date=" + year, "--points", points};
    if (json) {
      arguments.emplace_back("--json");
    }
    Program program{std::move(arguments)};
    status = program.exit_status();
    out = program.out();
    log = program.log();
  }

  TemporaryFolder folder;
  std::string points;
  int status;
  std::string out;
  std::string log;
};

/// Returns geodetic latitude and height of a geocentric position by iteration.
std::pair<double, double> geodetic_of(double geocentric_rad, double radius_km) {
  constexpr double kSquare = 1.0 - wgs84::kPolarRadius_km * wgs84::kPolarRadius_km /
                                       (wgs84::kEquatorialRadius_km * wgs84::kEquatorialRadius_km);
  const double off_axis_km = radius_km * std::cos(geocentric_rad);
  const double along_axis_km = radius_km * std::sin(geocentric_rad);
  double latitude_rad = geocentric_rad;
  double height_km = 0.0;
  for (int i = 0; i < 20; ++i) {
    const double normal_km = wgs84::kEquatorialRadius_km /
                             std::sqrt(1.0 - kSquare * std::pow(std::sin(latitude_rad), 2));
    height_km = off_axis_km / std::cos(latitude_rad) - normal_km;
    latitude_rad = std::atan2(along_axis_km,
                              off_axis_km * (1.0 - kSquare * normal_km / (normal_km + height_km)));
  }
  return {latitude_rad, height_km};
}

TEST(GeomagField, PrintsThePublishedFieldOfAGeodeticPoint) {
  // Source: British Geological Survey, IGRF-14, 2025, colatitude 56, longitude -3, 6375 km
  // geocentric: north 28927.56, east 261.98, down 30910.08 nT.
  const auto [latitude_rad, height_km] = geodetic_of(34.0 * kRadPerDeg, 6375.0);
  char point[100];
  std::snprintf(point, sizeof point, "%.9f,-3,%.6f\n", degrees(latitude_rad), height_km);
  const FieldAt run{kHeader + point};
  ASSERT_EQ(run.status, 0) << run.log;
  EXPECT_EQ(run.log, "");
  double lat_deg = 0.0;
  double north_nt = 0.0;
  double east_nt = 0.0;
  double down_nt = 0.0;
  ASSERT_EQ(
      std::sscanf(run.out.c_str(),
                  "lat_deg,lon_deg,height_km,north_nt,east_nt,down_nt\n%lf,%*f,%*f,%lf,%lf,%lf",
                  &lat_deg, &north_nt, &east_nt, &down_nt),
      4)
      << run.out;
  const double deflection_rad = latitude_rad - 34.0 * kRadPerDeg;
  EXPECT_NEAR(lat_deg, degrees(latitude_rad), 1e-9);
  EXPECT_NEAR(north_nt * std::cos(deflection_rad) - down_nt * std::sin(deflection_rad), 28927.56,
              0.02);
  EXPECT_NEAR(east_nt, 261.98, 0.02);
  EXPECT_NEAR(down_nt * std::cos(deflection_rad) + north_nt * std::sin(deflection_rad), 30910.08,
              0.02);
}

TEST(GeomagField, KnowsThePolesTheDateLineAndSpace) {
  const FieldAt run{kHeader + "90,0,400\r\n-90,10,0\n10.25,-180,525.5\n10.25,180,525.5\n0,0,1e6\n",
                    "2010.0", true};
  ASSERT_EQ(run.status, 0) << run.log;
  const auto json = nlohmann::json::parse(run.out);
  EXPECT_EQ(json["date"], 2010.0);
  EXPECT_EQ(json["model"], "IGRF-14");
  const auto& points = json["points"];
  ASSERT_EQ(points.size(), 5U);
  EXPECT_GT(points[0]["down_nt"], 40'000.0);
  EXPECT_LT(points[1]["down_nt"], -40'000.0);
  EXPECT_NEAR(points[2]["north_nt"], points[3]["north_nt"], 1e-7);
  EXPECT_NEAR(points[2]["east_nt"], points[3]["east_nt"], 1e-7);
  EXPECT_NEAR(points[4]["north_nt"], 0.0, 0.1);
}

TEST(GeomagField, RefusesPointsWithFileLineAndColumn) {
  for (const auto& [text, says] : {
           std::pair{kHeader + "10,20,30\n91,0,0\n", ":3: lat_deg = 91: must lie in [-90, 90]"},
           {kHeader + "0,361,0\n", ":2: lon_deg = 361: must lie in [-360, 360]"},
           {kHeader + "0,0,-101\n", ":2: height_km = -101: must lie in [-100, 1000000]"},
           {kHeader + "\n0,0,nan\n", ":3: height_km = \"nan\": must be a number"},
           {kHeader + "0,,0\n", ":2: lon_deg = \"\": must be a number"},
           {kHeader + "0,0\n", ":2: row \"0,0\": must be lat_deg,lon_deg,height_km"},
           {kHeader + "0,0,0,0\n", ":2: row \"0,0,0,0\": must be lat_deg,lon_deg,height_km"},
           {"lat_deg,lon_deg\n", ": must begin with the header lat_deg,lon_deg,height_km"},
           {"", ": must begin with the header lat_deg,lon_deg,height_km"},
       }) {
    const FieldAt run{text};
    EXPECT_EQ(run.status, 2) << text;
    EXPECT_THAT(run.log, HasSubstr(run.points + says));
    EXPECT_THAT(run.out, IsEmpty());
  }
}

TEST(GeomagField, RefusesYearsOutsideTheModel) {
  for (const std::string year : {"1899.9", "2030.1", "-1", "nan"}) {
    const FieldAt run{kHeader + "0,0,0\n", year, true};
    EXPECT_EQ(run.status, 2) << year;
    EXPECT_THAT(run.log, HasSubstr("known from 1900 to 2030"));
    EXPECT_THAT(nlohmann::json::parse(run.out)["error"].get<std::string>(), HasSubstr("--date"));
  }
}

TEST(GeomagField, RefusesWhatIsNoFile) {
  refused({"geomag", "field", "--date", "2020", "--points", "/nowhere.csv"},
          {"/nowhere.csv: cannot be read"});
}

}  // namespace spindrift::geomag_test
