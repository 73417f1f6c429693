#include <nlohmann/json.hpp>

#include "services/reports/separation_report.h"
#include "tests/support/made_separation.h"
#include "tests/support/matchers.h"

namespace spindrift::testing::separation_json_test {

TEST(SeparationJson, HasWhatItsDescriptionSays) {
  const nlohmann::json json = to_json(made_report());
  EXPECT_EQ(json["spacecraft"], "LEOSAT");
  EXPECT_EQ(json["run_id"], "run-1");
  const auto& batch = json["batch"];
  EXPECT_EQ(batch["quality"], "OK");
  EXPECT_EQ(batch["status"], "OK, 1 star fix");
  EXPECT_EQ(batch["reasons"], nlohmann::json::parse(R"([{"code": "star_fixes", "count": 1}])"));
  EXPECT_EQ(batch["attitudes"], 31);
  EXPECT_EQ(batch["iterations"], 4);
  EXPECT_EQ(batch["gyro"], nlohmann::json::parse(R"({"count": 961, "outliers": 2, "noise": 1.0})"));
  EXPECT_TRUE(batch["sun"]["noise"].is_null());
  EXPECT_NEAR(batch["gyro_bias_deg_s"][1].get<double>(), -0.002, 1e-12);
  EXPECT_NEAR(batch["gyro_bias_sigma_deg_s"][0].get<double>(), 1e-5 / kRadPerDeg, 1e-12);
  EXPECT_EQ(batch["open_bias"].size(), 1U);
  EXPECT_NEAR(batch["open_bias"][0]["off_sun_deg"].get<double>(), 2.0, 1e-9);
  EXPECT_EQ(batch["launcher"]["inside"], false);
  EXPECT_NEAR(batch["launcher"]["angle_deg"].get<double>(), 3.9, 1e-9);
}

TEST(SeparationJson, HasTheEventsInOrder) {
  const nlohmann::json json = to_json(made_report());
  const auto& events = json["batch"]["events"];
  ASSERT_EQ(events.size(), 4U);
  const auto& first = events[0];
  EXPECT_EQ(first["event"], "T1");
  EXPECT_EQ(first["t_tai_ns"], kSeparation_tai_ns);
  EXPECT_EQ(first["utc"], "2026-03-01T04:00:00.000Z");
  EXPECT_EQ(first["found"], false);
  EXPECT_EQ(events[3]["found"], true);
  EXPECT_NEAR(first["euler312_icrf_deg"][2].get<double>(), 30.0, 1e-9);
  EXPECT_NEAR(first["euler312_orbit_deg"][2].get<double>(), 3.0, 1e-9);
  EXPECT_TRUE(events[2]["euler312_orbit_deg"].is_null());
  EXPECT_NEAR(first["sigma_deg"].get<double>(), 0.4, 1e-9);
  EXPECT_NEAR(first["noise_sigma_deg"].get<double>(), 0.2, 1e-9);
  const auto& covariance = first["covariance_deg2"];
  EXPECT_NEAR(covariance[0][0].get<double>() + covariance[1][1].get<double>() +
                  covariance[2][2].get<double>(),
              0.4 * 0.4, 1e-9);
  EXPECT_NEAR(first["bound_deg"].get<double>(), 0.35, 1e-9);
  EXPECT_NEAR(first["rate_deg_s"][1].get<double>(), -0.002 / kRadPerDeg, 1e-9);
  EXPECT_EQ(first["near_singular"], false);
}

TEST(SeparationJson, HasTheMisalignmentThatWasEstimated) {
  const nlohmann::json json = to_json(report_after([](auto& one) {
    one.solution.misalignment =
        SunMisalignment{Eigen::Vector3d{0.01, -0.02, 0.0}, 1e-6 * Eigen::Matrix3d::Identity()};
  }));
  EXPECT_NEAR(json["batch"]["sun_misalignment_deg"][1].get<double>(), -0.02 / kRadPerDeg, 1e-9);
  EXPECT_NEAR(json["batch"]["sun_misalignment_sigma_deg"][0].get<double>(), 1e-3 / kRadPerDeg,
              1e-9);
}

TEST(SeparationJson, IsNullWhereThereIsNothing) {
  const nlohmann::json both = to_json(made_report());
  EXPECT_TRUE(both["sequential"]["gyro_bias_deg_s"].is_null());
  EXPECT_TRUE(both["sequential"]["events"][0]["bound_deg"].is_null());
  const nlohmann::json bare = to_json(report_after([](auto& one) {
    one.in_orbit_frame.clear();
    one.launcher.reset();
  }));
  EXPECT_TRUE(bare["sequential"].is_null());
  EXPECT_TRUE(bare["batch"]["launcher"].is_null());
  EXPECT_TRUE(bare["batch"]["events"][0]["euler312_orbit_deg"].is_null());
}

TEST(SeparationJson, SaysWhyTheLauncherWasNotChecked) {
  const nlohmann::json json = to_json(report_after([](auto& one) {
    one.launcher = Unexpected{{ErrorCode::NoCoverage, "no orbit at T1"}};
  }));
  EXPECT_EQ(json["batch"]["launcher"], nlohmann::json::parse(R"({"error": "no orbit at T1"})"));
}

}  // namespace spindrift::testing::separation_json_test
