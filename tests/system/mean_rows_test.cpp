// Passes whose beams look near the limb: checks every mean that `process` stores, not only the
// last.

#include <SQLiteCpp/Database.h>
#include <SQLiteCpp/Statement.h>

#include <filesystem>
#include <string>
#include <vector>

#include "tests/support/axis_error.h"
#include "tests/support/exact_mission.h"
#include "tests/support/matchers.h"
#include "tests/support/processed.h"
#include "tests/support/simulated.h"

namespace spindrift::mean_rows_test {

struct MeanRow {
  double off_deg;
  double sigma_deg;
  std::string status;
};

std::vector<MeanRow> means_of(const std::filesystem::path& db, const nlohmann::json& truth) {
  const SQLite::Database database{db.string(), SQLite::OPEN_READONLY};
  SQLite::Statement rows{database,
                         "SELECT ra_deg, dec_deg, sigma_deg, status FROM spin_estimate WHERE "
                         "estimator = 'mean' ORDER BY t_tai_ns"};
  std::vector<MeanRow> means;
  while (rows.executeStep()) {
    means.push_back({.off_deg = error_deg({{"ra_deg", rows.getColumn(0).getDouble()},
                                           {"dec_deg", rows.getColumn(1).getDouble()}},
                                          truth),
                     .sigma_deg = rows.getColumn(2).getDouble(),
                     .status = rows.getColumn(3).getString()});
  }
  return means;
}

/// @param more Changes of this pass.
Replacements usual_but(const std::string& raan, const std::string& anomaly, const std::string& ra,
                       const std::string& dec, const std::string& rpm, const Replacements& more) {
  Replacements all{{"raan_deg = 300.0", "raan_deg = " + raan},
                   {"mean_anomaly_deg = 30.0", "mean_anomaly_deg = " + anomaly},
                   {"\nra_deg = 100.0", "\nra_deg = " + ra},
                   {"\ndec_deg = -55.0", "\ndec_deg = " + dec},
                   {"rate_rpm = 60.0", "rate_rpm = " + rpm + "\nrate_drift_rpm_h = 0.3"},
                   {"\nazimuth_deg = 92.0", "\nazimuth_deg = 120.0"},
                   {"model = \"sphere\"", "model = \"ellipsoid\""}};
  all.insert(all.end(), more.begin(), more.end());
  return all;
}

TEST(MeanRows, FewFixesWithShortChordsAreAveragedAndDoubtful) {
  for (int seed = 112; seed <= 118; ++seed) {
    SCOPED_TRACE(seed);
    const Simulated simulated{
        "gto-nominal.toml",
        usual_but("313.2237056952047", "15.0", "254.68834644255713", "-27.78443213581462", "60.0",
                  {{"duration_s = 600.0", "duration_s = 900.0\nseed = " + std::to_string(seed)},
                   {"mount_angle_deg = 85.0", "mount_angle_deg = 60.0"},
                   {"mount_angle_deg = 95.0", "mount_angle_deg = 120.0"},
                   {"co2_altitude_km = 40.0",
                    "co2_altitude_km = 40.0\n[faults]\nlost = 0.03\nspoilt = 0.02\n"
                    "[faults.channel.north_in]\ndead = true\n"
                    "[faults.channel.north_out]\ndead = true"}})};
    const Processed outcome{simulated.pass};
    const auto means =
        means_of(outcome.db, {{"ra_deg", 254.68834644255713}, {"dec_deg", -27.78443213581462}});
    ASSERT_THAT(means, Not(IsEmpty()));
    for (const MeanRow& mean : means) {
      EXPECT_LT(mean.off_deg, 2.0 * mean.sigma_deg) << mean.status;
      EXPECT_LT(mean.sigma_deg, 0.5) << mean.status;
      EXPECT_THAT(mean.status, StartsWith("DOUBTFUL"));
    }
    EXPECT_EQ(means.front().status, "DOUBTFUL, 1 fix, fewer than 3");
    EXPECT_EQ(means.back().status, "DOUBTFUL, " + std::to_string(means.size()) +
                                       " fixes, plain average: beams too near the limb");
    EXPECT_THAT(outcome.log, Not(HasSubstr("begins anew")));
  }
}

TEST(MeanRows, ShortChordsThatBecomeLongLeadToTheLeastSquares) {
  const Simulated simulated{
      "gto-nominal.toml",
      usual_but("308.380173754614", "120.0", "210.78820351767155", "9.292454335835854", "20.0",
                {{"duration_s = 600.0", "duration_s = 900.0\nseed = 171"},
                 {"mount_angle_deg = 95.0", "mount_angle_deg = 105.0"},
                 {"co2_altitude_km = 40.0",
                  "co2_altitude_km = 40.0\n[faults]\nlost = 0.03\nspoilt = 0.02"}}),
      std::string{kExactSpin}};
  const Processed outcome{simulated.pass};
  const auto means =
      means_of(outcome.db, {{"ra_deg", 210.78820351767155}, {"dec_deg", 9.292454335835854}});
  ASSERT_THAT(means, Not(IsEmpty()));
  for (const MeanRow& mean : means) {
    EXPECT_LT(mean.off_deg, 3.0 * mean.sigma_deg) << mean.status;
    EXPECT_LT(mean.sigma_deg, 0.1) << mean.status;
  }
  EXPECT_EQ(means.back().status, "OK, " + std::to_string(means.size()) + " fixes");
  EXPECT_LT(means.back().sigma_deg, 0.01);
  EXPECT_THAT(outcome.log, Not(HasSubstr("begins anew")));
}

}  // namespace spindrift::mean_rows_test
