#include "services/products/not_finite.h"
#include "services/products/products.h"
#include "services/products/to_json.h"
#include "tests/support/made_separation.h"
#include "tests/support/matchers.h"

namespace spindrift::testing::reconstruction_rows_test {

using enum ReconstructionMethod;

/// Returns the rows of a table as objects.
template <class Table>
std::vector<nlohmann::json> rows_of(const ReconstructionProduct& product) {
  std::vector<nlohmann::json> rows;
  for_each_row<Table>(product, [&](const auto& row) {
    nlohmann::json object;
    const auto put = [&](std::string_view name, const auto& value) {
      if constexpr (requires { value.has_value(); }) {
        object[std::string{name}] = value ? nlohmann::json(*value) : nlohmann::json{};
      } else {
        object[std::string{name}] = value;
      }
    };
    with_columns<Table>([&](const auto&... column) { (put(column.name, column.of(row)), ...); });
    rows.push_back(object);
  });
  return rows;
}

TEST(ReconstructionRows, HaveOneOfTheWhole) {
  const auto batch = json_of(made_product(Batch));
  EXPECT_EQ(batch["method"], "batch");
  EXPECT_EQ(batch["t_tai_ns"], kSeparation_tai_ns + 300'000'000'000);
  EXPECT_EQ(batch["quality"], "OK");
  EXPECT_EQ(batch["status"], "OK, 1 star fix");
  EXPECT_EQ(batch["gyro_samples"], 961);
  EXPECT_EQ(batch["sun_vectors"], 223);
  EXPECT_EQ(batch["star_fixes"], 1);
  EXPECT_NEAR(batch["bias_y_rad_s"].get<double>(), -0.002 * kRadPerDeg, 1e-15);
  EXPECT_NEAR(batch["bias_sigma_z_rad_s"].get<double>(), 1e-5, 1e-12);
  EXPECT_NEAR(batch["launcher_angle_deg"].get<double>(), 3.9, 1e-9);
  EXPECT_EQ(batch["launcher_chi_square"], 60.0);
  EXPECT_EQ(batch["launcher_chance"], 1e-12);
}

TEST(ReconstructionRows, HaveNoValueWhereThereIsNone) {
  const auto sequential = json_of(made_product(Sequential));
  EXPECT_TRUE(sequential["bias_x_rad_s"].is_null());
  EXPECT_TRUE(sequential["bias_sigma_x_rad_s"].is_null());
  ReconstructedSeparation unchecked = made_separation(Batch);
  unchecked.launcher = Unexpected{{ErrorCode::NoCoverage, "no orbit at T1"}};
  const auto row =
      json_of(ReconstructionProduct{std::make_shared<const ReconstructedSeparation>(unchecked)});
  EXPECT_TRUE(row["launcher_angle_deg"].is_null());
  EXPECT_TRUE(row["launcher_chance"].is_null());
}

TEST(ReconstructionRows, HaveOneOfEachEvent) {
  const auto rows = rows_of<ReconstructionEventTable>(made_product(Batch));
  ASSERT_EQ(rows.size(), 4U);
  EXPECT_EQ(rows[0]["method"], "batch");
  EXPECT_EQ(rows[0]["event"], "T1");
  EXPECT_EQ(rows[3]["event"], "T4");
  EXPECT_EQ(rows[3]["found"], true);
  EXPECT_EQ(rows[1]["t_tai_ns"], kSeparation_tai_ns + 60'000'000'000);
  EXPECT_NEAR(rows[0]["euler312_icrf_deg_1"].get<double>(), 10.0, 1e-9);
  EXPECT_NEAR(rows[0]["euler312_icrf_deg_3"].get<double>(), 30.0, 1e-9);
  EXPECT_NEAR(rows[0]["euler312_orbit_deg_2"].get<double>(), 2.0, 1e-9);
  EXPECT_TRUE(rows[2]["euler312_orbit_deg_2"].is_null());
  EXPECT_NEAR(rows[0]["sigma_deg"].get<double>(), 0.4, 1e-9);
  EXPECT_NEAR(rows[0]["noise_sigma_deg"].get<double>(), 0.2, 1e-9);
  EXPECT_NEAR(rows[0]["bound_deg"].get<double>(), 0.35, 1e-9);
  EXPECT_TRUE(
      rows_of<ReconstructionEventTable>(made_product(Sequential))[0]["bound_deg"].is_null());
}

TEST(ReconstructionRows, HaveTheHistoryUnderTheNameOfTheMethod) {
  const auto rows = rows_of<ReconstructedAttitudeTable>(made_product(Sequential));
  ASSERT_EQ(rows.size(), 31U);
  for (const auto& row : rows) {
    EXPECT_EQ(row["source"], "sequential");
    EXPECT_EQ(row["quality"], "OK");
  }
  EXPECT_EQ(rows[1]["t_tai_ns"], kSeparation_tai_ns + 10'000'000'000);
  EXPECT_EQ(rows[0]["rate_z_rad_s"], 0.003);
  EXPECT_NEAR(rows[0]["sigma_deg"].get<double>(), 0.4, 1e-9);
  EXPECT_NEAR(rows[0]["noise_sigma_deg"].get<double>(), 0.2, 1e-9);
  EXPECT_EQ(ReconstructedAttitudeTable::group(made_product(Sequential)), "sequential");
}

TEST(ReconstructionRows, AreFoundNotFinite) {
  EXPECT_FALSE(not_finite(made_product(Batch)));
  ReconstructedSeparation wrong = made_separation(Batch);
  wrong.solution.history[5].rate_body_rad_s.y() = std::nan("");
  const auto found =
      not_finite(ReconstructionProduct{std::make_shared<const ReconstructedSeparation>(wrong)})
          .value();
  EXPECT_EQ(found.table, "attitude");
  EXPECT_EQ(found.column, "rate_y_rad_s");
}

}  // namespace spindrift::testing::reconstruction_rows_test
