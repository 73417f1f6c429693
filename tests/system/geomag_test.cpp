#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>

#include "pipelines/frames/angle.h"
#include "pipelines/frames/wgs84.h"
#include "tests/support/matchers.h"
#include "tests/support/ran.h"

namespace spindrift::geomag_test {

const std::string kHeader = "lat_deg,lon_deg,height_km\n";

class GeomagField : public ::testing::Test {
 protected:
  /// Returns the command on a file of points with this text.
  Words field_at(const std::string& text, const std::string& year = "2025.0") const {
    return {"geomag", "field", "--date=" + year, "--points", folder_.write("points.csv", text)};
  }

  TemporaryFolder folder_;
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

TEST_F(GeomagField, PrintsThePublishedFieldOfAGeodeticPoint) {
  // Source: British Geological Survey, IGRF-14, 2025, colatitude 56, longitude -3, 6375 km
  // geocentric: north 28927.56, east 261.98, down 30910.08 nT.
  const auto [latitude_rad, height_km] = geodetic_of(34.0 * kRadPerDeg, 6375.0);
  char point[100];
  std::snprintf(point, sizeof point, "%.9f,-3,%.6f\n", degrees(latitude_rad), height_km);
  const Ran run = succeeded(field_at(kHeader + point));
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

TEST_F(GeomagField, KnowsThePolesTheDateLineAndSpace) {
  const std::string points =
      kHeader + "90,0,400\r\n-90,10,0\n10.25,-180,525.5\n10.25,180,525.5\n0,0,1e6\n";
  const auto json = succeeded(with(field_at(points, "2010.0"), {"--json"})).json();
  EXPECT_EQ(json["date"], 2010.0);
  EXPECT_EQ(json["model"], "IGRF-14");
  const auto& fields = json["points"];
  ASSERT_EQ(fields.size(), 5U);
  EXPECT_GT(fields[0]["down_nt"], 40'000.0);
  EXPECT_LT(fields[1]["down_nt"], -40'000.0);
  EXPECT_NEAR(fields[2]["north_nt"], fields[3]["north_nt"], 1e-7);
  EXPECT_NEAR(fields[2]["east_nt"], fields[3]["east_nt"], 1e-7);
  EXPECT_NEAR(fields[4]["north_nt"], 0.0, 0.1);
}

TEST_F(GeomagField, RefusesPointsWithFileLineAndColumn) {
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
    SCOPED_TRACE(text);
    const std::string file = (folder_.path() / "points.csv").string();
    EXPECT_EQ(refused(field_at(text), {file + says}).out, "");
  }
}

TEST_F(GeomagField, RefusesYearsOutsideTheModel) {
  for (const std::string year : {"1899.9", "2030.1", "-1", "nan"}) {
    SCOPED_TRACE(year);
    const Ran run =
        refused(with(field_at(kHeader + "0,0,0\n", year), {"--json"}), {"known from 1900 to 2030"});
    EXPECT_THAT(run.json()["error"].get<std::string>(), HasSubstr("--date"));
  }
}

TEST_F(GeomagField, RefusesWhatIsNoFile) {
  refused({"geomag", "field", "--date", "2020", "--points", "/nowhere.csv"},
          {"/nowhere.csv: cannot be read"});
}

}  // namespace spindrift::geomag_test
