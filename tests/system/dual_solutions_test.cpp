// Passes of which no single revolution tells the true axis from the false one, through the program.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numbers>
#include <string>

#include "pipelines/frames/celestial.h"
#include "tests/support/archive_rows.h"
#include "tests/support/processed_pass.h"

namespace spindrift {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

constexpr double kDegree = std::numbers::pi / 180.0;

double error_deg(double ra_deg, double dec_deg, double true_ra_deg, double true_dec_deg) {
  const auto place = [](double ra, double dec) {
    return direction_icrf({.ra_rad = ra * kDegree, .dec_rad = dec * kDegree});
  };
  return angle_between_rad(place(ra_deg, dec_deg), place(true_ra_deg, true_dec_deg)) / kDegree;
}

TEST(DualSolutions, AreSettledByTheirDispersionAsTheGeometryTurns) {
  // Of a beam so noisy that its fixes tell before its edges do.
  const TemporaryFolder folder;
  const auto outcome = process_simulated(folder,
                                         {{"mean_anomaly_deg = 30.0", "mean_anomaly_deg = 20.0"},
                                          {"duration_s = 600.0", "duration_s = 1500.0"},
                                          {"ir_pulse_s = 5.0e-4", "ir_pulse_s = 2.0e-3"},
                                          {"\ndec_deg = -55.0", "\ndec_deg = -20.0"}},
                                         {"sun2", "south"});
  ASSERT_EQ(outcome.status, 0) << outcome.log;
  const auto count = [&](const std::string& condition) {
    return number_of(outcome.db, "SELECT count(*) FROM spin_fix WHERE " + condition);
  };
  EXPECT_GE(count("resolution = 'DISPERSION' AND accepted"), 20);
  EXPECT_EQ(count("geometry_case <> 5"), 0);
  EXPECT_EQ(count("accepted AND alternate_ra_deg IS NULL"), 0) << "both candidates are kept";
  for (const char* const estimator : {"mean", "sequential"}) {
    const auto& estimate = outcome.run[estimator];
    ASSERT_FALSE(estimate.is_null()) << outcome.log;
    EXPECT_THAT(estimate["status"].get<std::string>(), StartsWith("OK")) << estimator;
    EXPECT_LT(error_deg(estimate["ra_deg"], estimate["dec_deg"], 100.0, -20.0),
              3.0 * estimate["sigma_deg"].get<double>())
        << estimator;
  }
}

}  // namespace
}  // namespace spindrift
