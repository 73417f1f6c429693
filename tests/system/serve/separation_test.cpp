#include <spindrift.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <filesystem>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "pipelines/frames/angle.h"
#include "pipelines/frames/rotation_vector.h"
#include "services/bus/qos.h"
#include "services/publisher/product_messages.h"
#include "tests/support/archive_rows.h"
#include "tests/support/bus_fixture.h"
#include "tests/support/matchers.h"
#include "tests/support/on_bus.h"
#include "tests/support/processed.h"
#include "tests/support/ran.h"
#include "tests/support/recorded_separation.h"
#include "tests/support/subscriber.h"
#include "tests/support/test_paths.h"
#include "tests/support/three_axis_files.h"

namespace spindrift::serve_separation_test {

using ::testing::Eq;
using ::testing::Pointwise;

const std::filesystem::path kSeparation = test_data() / "three-axis" / "separation";

/// Returns the reconstructed rows without the names of runs.
std::vector<std::string> reconstructed_rows(const std::filesystem::path& db) {
  return rows_of(
      db,
      std::vector<std::string>{
          "SELECT method, event, t_tai_ns, found, qx, qy, qz, qw, rate_x_rad_s, rate_y_rad_s, "
          "rate_z_rad_s, euler312_orbit_deg_1, euler312_orbit_deg_2, euler312_orbit_deg_3, "
          "sigma_deg, bound_deg FROM reconstruction_event ORDER BY 1, 2",
          "SELECT method, t_tai_ns, quality, reasons, status, samples, gyro_samples, sun_vectors, "
          "star_fixes, bias_x_rad_s, bias_sigma_z_rad_s FROM reconstruction ORDER BY 1",
          "SELECT t_tai_ns, source, qx, qy, qz, qw, rate_x_rad_s, sigma_deg, quality, status FROM "
          "attitude ORDER BY 2, 1"});
}

/// Collects all published attitudes.
class Listener {
 public:
  explicit Listener(const bus::BusConfig& bus)
      : attitudes_{bus, product_topic<AttitudeEstimate>(), bus::telemetry_reader_qos()} {}

  /// Returns the attitudes of an estimator in the order of arrival.
  std::vector<spindrift_AttitudeEstimate> of(const std::string& estimator) {
    const auto note = [&](const auto& one) { got_[one.estimator].push_back(one); };
    while (attitudes_.take(note) > 0) {
    }
    return got_[estimator];
  }

 private:
  Subscriber<spindrift_AttitudeEstimate> attitudes_;
  std::map<std::string, std::vector<spindrift_AttitudeEstimate>> got_;
};

/// Returns the attitudes that a late subscriber receives.
std::vector<std::int64_t> kept_on(const bus::BusConfig& bus, const std::string& estimator) {
  const Subscriber attitudes{bus, product_topic<AttitudeEstimate>()};
  std::vector<std::int64_t> times;
  for (const auto& one : take_samples(attitudes.reader(), 3)) {
    if (one.estimator == estimator) {
      times.push_back(one.t_tai_ns);
    }
  }
  return times;
}

void expect_right(const spindrift_AttitudeEstimate& told, const testing::TrueAttitude& truth) {
  EXPECT_EQ(told.t_tai_ns, tai_ns(truth.t));
  const double off_deg =
      angle_between_rad(Eigen::Quaterniond{told.qw, told.qx, told.qy, told.qz}, truth.q_icrf_body) /
      kRadPerDeg;
  EXPECT_LT(off_deg, 3.0 * told.sigma_deg);
  EXPECT_LT(told.sigma_deg, 1.5);
  EXPECT_EQ(told.quality, spindrift_QUALITY_OK) << told.status;
}

TEST(ServeSeparation, IsReconstructedWhenTheStarFixComesAndSentAndStored) {
  const auto pass = testing::recorded_separation("separation");
  ReadyService service{kSeparation.string(), "replay"};
  Listener listener{service.bus()};
  ASSERT_EQ(service.replay("0"), 0);
  for (const char* const method : {"batch", "sequential"}) {
    EXPECT_TRUE(eventually([&] { return listener.of(method).size() >= 4; })) << method;
  }
  const auto sent = listener.of("batch");
  ASSERT_GE(sent.size(), 4U);
  for (const auto& [event, place] :
       {std::pair{"T4", 0U}, std::pair{"T3", 1U}, std::pair{"T2", 2U}, std::pair{"T1", 3U}}) {
    expect_right(sent[place], pass.truth.at(event));
  }
  EXPECT_THAT(kept_on(service.bus(), "batch"), ElementsAre(tai_ns(pass.truth.at("T1").t)));
  EXPECT_EQ(count_rows(service.db(), "reconstruction"), 2);

  ASSERT_EQ(service.stop(), 0) << service.log();
  EXPECT_THAT(service.log(),
              HasSubstr("separation reconstructed: T1 2026-03-01T04:00:00.000Z, attitude ICRF to "
                        "body, Euler 3-1-2 "));
  const Processed processed{kSeparation};
  EXPECT_THAT(reconstructed_rows(service.db()), Pointwise(Eq(), reconstructed_rows(processed.db)));
  const auto summary = service.summary()["runs"][0]["reconstruction"];
  EXPECT_EQ(summary["batch"]["events"][0]["event"], "T1");
  EXPECT_EQ(summary, processed.run["reconstruction"]);
}

TEST(ServeSeparation, KilledBetweenStarFixesGivesWhatProcessGives) {
  const TemporaryFolder pass;
  testing::write_three_axis_pass(pass.path(), {.separation = true});
  const Processed processed{pass.path()};
  const std::int64_t middle =
      number_of(processed.db, "SELECT max(t_tai_ns) FROM gyro_sample") - 30'000'000'000;

  ReadyService service{pass.path().string(), "replay"};
  Listener listener{service.bus()};
  const std::int64_t t1 =
      number_of(processed.db, "SELECT min(t_tai_ns) FROM reconstruction_event WHERE event = 'T1'");
  const auto solutions = [&](const std::string& method) {
    const auto told = listener.of(method);
    return std::count_if(told.begin(), told.end(),
                         [&](const auto& one) { return one.t_tai_ns == t1; });
  };
  for (const bool first : {true, false}) {
    const TemporaryFolder half;
    testing::write_half(pass.path(), middle, first, half.path());
    succeeded(service.words({"replay", "--telemetry", half.path(), "--speed", "0"}));
    // Solutions are made at 1, 2, 4, 8 and 16 fixes; after the restart, at 16 again and at 32. On a
    // slow machine the silence of the stream makes one more.
    for (const char* const method : {"batch", "sequential"}) {
      ASSERT_TRUE(eventually([&, all = first ? 5 : 7] { return solutions(method) >= all; }))
          << solutions(method);
    }
    const std::int64_t end = first ? middle : std::numeric_limits<std::int64_t>::max();
    ASSERT_TRUE(eventually([&] {
      return three_axis_samples_before(service.db(), end) ==
             three_axis_samples_before(processed.db, end);
    }));
    if (first) {
      service.kill_and_go_on();
    }
  }
  ASSERT_EQ(service.stop(), 0) << service.log();
  EXPECT_THAT(reconstructed_rows(service.db()), Pointwise(Eq(), reconstructed_rows(processed.db)));
  EXPECT_EQ(count_rows(service.db(), "run"), 1);
  // The mission names no orbit, so the orbit frame comes from the orbit states.
  EXPECT_EQ(number_of(service.db(), "SELECT count(euler312_orbit_deg_1) FROM reconstruction_event"),
            8);
  EXPECT_TRUE(eventually([&] { return solutions("batch") >= 8; })) << solutions("batch");
}

TEST(ServeSeparation, TheCommandGoesThroughTheServiceThatHoldsTheArchive) {
  ReadyService service{kSeparation.string(), "replay"};
  Listener listener{service.bus()};
  ASSERT_EQ(service.replay("0"), 0);
  ASSERT_TRUE(eventually([&] { return count_rows(service.db(), "reconstruction") == 2; }));
  const auto plot = service.db().parent_path() / "plot.svg";
  const auto reconstruct = [&](const std::string& mission, const Words& more) {
    return ended(with({"reconstruct", "--mission", mission, "--db", service.db(), "--json"}, more));
  };
  const Ran held = reconstruct(service.mission(), {"--plot", plot, "--method", "batch"});
  ASSERT_EQ(held.status, 0) << held.log;
  EXPECT_TRUE(std::filesystem::exists(plot));
  const Ran lost = reconstruct("/no/such/mission.toml", {});
  EXPECT_EQ(lost.status, 2);
  EXPECT_THAT(lost.out, HasSubstr("/no/such/mission.toml: cannot be read"));
  ASSERT_EQ(service.stop(), 0) << service.log();
  // The command's solution is not announced. The pass's own solutions stay valid: at the fix, at
  // the end, and on a slow machine also when the stream has fallen silent.
  EXPECT_TRUE(eventually([&] { return listener.of("batch").size() >= 8; }));
  EXPECT_EQ(listener.of("batch").size() % 4, 0U);  // Each solution has T1 to T4.
  const std::string run_of_command = held.json().at("run_id");
  for (const spindrift_AttitudeEstimate& announced : listener.of("batch")) {
    EXPECT_NE(announced.run_id, run_of_command);
  }

  const Ran free = reconstruct(service.mission(), {"--method", "batch"});
  ASSERT_EQ(free.status, 0) << free.log;
  const auto by_service = held.json();
  const auto by_itself = free.json();
  EXPECT_EQ(by_service["batch"], by_itself["batch"]);
  EXPECT_EQ(by_service["plot"], plot.string());
  EXPECT_TRUE(by_service["sequential"].is_null());
  EXPECT_THAT(
      rows_of(service.db(),
              "SELECT mode, finished_utc IS NOT NULL, count(*) FROM run GROUP BY 1 ORDER BY 1"),
      ElementsAre("process|1|2|", "replay|1|1|"));
}

TEST(ServeSeparation, ProcessSaysWhyThereIsNoneAndDoesTheRest) {
  const TemporaryFolder folder;
  const Ran program =
      succeeded({"process", "--mission", kSeparation / "mission.toml", "--telemetry",
                 kSeparation / "gyro.csv", "--db", folder.path() / "out.db"});
  EXPECT_THAT(program.log, HasSubstr("no reconstruction of the separation: no star fix from T1 on: "
                                     "nothing can be anchored"));
}

}  // namespace spindrift::serve_separation_test
