// Operator actions among the samples, in the archive, and after a restart.

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "pipelines/frames/celestial.h"
#include "services/alerts/alert_desk.h"
#include "services/archive/stored_edges.h"
#include "services/operator/parse_action.h"
#include "tests/integration/archive_fixture.h"
#include "tests/support/archive_rows.h"
#include "tests/support/recorded_edges.h"
#include "tests/support/samples.h"
#include "tests/support/test_paths.h"

namespace spindrift::operator_action_test {

using ::testing::ElementsAre;

using nlohmann::json;

const std::filesystem::path kPass = recorded_passes() / "nominal";
constexpr std::size_t kActed = 240;
constexpr std::size_t kStopped = 420;
constexpr std::size_t kAll = 600;

Mission mission() { return load_mission(kPass / "mission.toml").value(); }

Processor new_processor(const std::string& partition = "live", RunMode mode = RunMode::Live) {
  return Processor::make({mission()},
                         {.mode = mode, .telemetry = {"DDS domain 0, partition " + partition}})
      .value();
}

SampleBatch batch_of(json action) {
  action["spacecraft"] = "SPINNER";
  action["by"] = "shift";
  SampleBatch batch;
  batch.actions.push_back(parse_action(action, known_spacecraft({mission()})).value());
  return batch;
}

const json kNoNorthIn{{"action", "exclude_channel"}, {"channel", "north_in"}};

testing::Samples edges() { return testing::edges_of(kPass, kAll); }

/// Runs a service that receives the edges and, after the first `kActed` of the pass, the actions.
struct Serving {
  std::filesystem::path db;
  std::string partition = "live";
  RunMode mode = RunMode::Live;

  void receive(std::size_t from, std::size_t to, const std::vector<json>& said,
               bool finishes = false) const {
    ASSERT_TRUE(Archive::open(db, {}).value()->close());
    const testing::Samples all = edges();
    Processor processor = new_processor(partition, mode);
    ASSERT_TRUE(processor.arrive_after(db));
    auto stored = processor.go_on(db);
    ASSERT_TRUE(stored) << stored.error().message;
    auto gone_on = *std::move(stored);
    const auto archive = Archive::open(db, {}).value();
    testing::work(processor, std::move(gone_on.routed), *archive);
    const auto take = [&](std::size_t first, std::size_t last) {
      testing::work(
          processor,
          processor.route(testing::batch_of_samples<Pulse>(testing::part_of(all, first, last))),
          *archive);
    };
    const std::size_t middle = from < kActed && kActed < to ? kActed : to;
    take(from, middle);
    for (const json& action : said) {
      testing::work(processor, processor.route(batch_of(action)), *archive);
    }
    take(middle, to);
    if (finishes) {
      testing::submit(*archive, processor.finish());
    }
    EXPECT_TRUE(archive->close());
  }
};

struct OperatorActions : testing::ArchiveFixture {
  Serving live() const { return {.db = path()}; }
  std::int64_t left_out() const { return count("pulse_use WHERE rejected_by = 'operator'"); }

  /// Expects a service that is restarted after these actions to make what one that is not makes.
  /// @return Archive of the latter.
  std::filesystem::path expect_the_same_restarted(const std::vector<json>& said) const {
    live().receive(0, kStopped, said);
    const auto before = product_rows(path());
    live().receive(kStopped, kStopped, {});
    EXPECT_EQ(product_rows(path()), before);
    live().receive(kStopped, kAll, {}, true);
    const Serving whole{.db = directory() / "whole.db"};
    whole.receive(0, kAll, said, true);
    EXPECT_EQ(product_rows(path()), product_rows(whole.db));
    return whole.db;
  }
};

TEST_F(OperatorActions, AreStoredAmongTheSamplesWithTheTimeThatTelemetryHadReached) {
  live().receive(0, kAll, {kNoNorthIn}, true);
  EXPECT_THAT(rows_of(path(), "SELECT by, action, arguments, note FROM operator_action"),
              ElementsAre(R"(shift|exclude_channel|{"channel":"north_in"}||)"));
  EXPECT_EQ(count("pulse WHERE arrival < (SELECT arrival FROM operator_action)"), kActed);
  EXPECT_EQ(number("SELECT t_tai_ns = (SELECT max(t_tai_ns) FROM pulse WHERE pulse.arrival < "
                   "operator_action.arrival) FROM operator_action"),
            1);
  EXPECT_EQ(left_out(), count("pulse WHERE channel = 'north_in' AND t_tai_ns >= (SELECT t_tai_ns "
                              "FROM operator_action)"));
  EXPECT_GT(left_out(), 50);
}

TEST_F(OperatorActions, SayBackWhatHoldsFromTheirTimeOn) {
  const json again{{"action", "include_channel"}, {"channel", "north_in"}};
  live().receive(0, kAll,
                 {again,
                  kNoNorthIn,
                  again,
                  {{"action", "set_limit"}, {"key", "spin.sigma"}, {"deg", 0.5}, {"after_s", 9}}},
                 true);
  EXPECT_THAT(rows_of(path(),
                      "SELECT substr(says, 34) FROM notice JOIN operator_action ON action_id = "
                      "notice.arguments ->> 'action_id'"
                      " AND notice.arguments ->> 't_tai_ns' = operator_action.t_tai_ns"
                      " ORDER BY arrival"),
              ElementsAre(": north_in is not left out here: nothing changes|",
                          ": north_in is used again from here on|",
                          ": spin.sigma is held to after_s 9, deg 0.5 from here on|"));
}

TEST_F(OperatorActions, SaidBeforeTheTelemetryOfAReplayHoldForAllOfIt) {
  const Serving replay{.db = path(), .partition = "replay", .mode = RunMode::Replay};
  replay.receive(0, 0, {kNoNorthIn});
  replay.receive(0, kAll, {}, true);
  EXPECT_EQ(left_out(), count("pulse WHERE channel = 'north_in'"));
}

TEST_F(OperatorActions, AreRepeatedByARestartToTheBit) {
  expect_the_same_restarted(
      {kNoNorthIn,
       {{"action", "set_prior"}, {"ra_deg", 100.0}, {"dec_deg", -55.0}, {"sigma_deg", 1.0}},
       {{"action", "mark_manoeuvre"}}});
  EXPECT_EQ(count("operator_action"), 3);
  EXPECT_EQ(count("run"), 1);
}

/// A segment of twelve turns is excluded ten turns after its end.
TEST_F(OperatorActions, LeaveAPastSegmentOutOfBatchAlsoAfterARestart) {
  const testing::Samples all = edges();
  const TaiTime from = all[108].value.t;
  const TaiTime to = all[180].value.t;
  const auto whole = expect_the_same_restarted(
      {{{"action", "exclude_segment"}, {"from_tai_ns", tai_ns(from)}, {"to_tai_ns", tai_ns(to)}}});
  EXPECT_EQ(last_batch_rows(path()), last_batch_rows(whole));

  EXPECT_EQ(number("SELECT t_tai_ns FROM operator_action"), tai_ns(from));
  const auto kept = std::move(read_edges(path(), "SPINNER", std::nullopt)->pass).edges();
  EXPECT_TRUE(std::none_of(kept.begin(), kept.end(), [&](const PassEdge& edge) {
    return from <= edge.pulse.t && edge.pulse.t < to;
  }));
  EXPECT_EQ(number("SELECT edges + outliers FROM spin_batch ORDER BY t_tai_ns DESC LIMIT 1"),
            static_cast<std::int64_t>(kept.size()));
  EXPECT_EQ(text("SELECT arguments FROM notice WHERE code = 'batch_leaves_out'"),
            R"({"action":"exclude_segment","edges":72,"spacecraft":"SPINNER","t_tai_ns":)" +
                std::to_string(tai_ns(from)) + "}");
  EXPECT_GT(kept.size(), kAll - 100);
  EXPECT_LE(kept.size(), kAll - 72);
}

TEST_F(OperatorActions, GiveABatchSolutionOfTheStoredRunTheirPrior) {
  live().receive(
      0, kAll,
      {{{"action", "set_prior"}, {"ra_deg", 101.0}, {"dec_deg", -54.0}, {"sigma_deg", 2.0}}}, true);
  const auto told = read_edges(path(), "SPINNER", std::nullopt)->told_prior;
  ASSERT_TRUE(told);
  EXPECT_LT((told->axis_icrf -
             direction_icrf({.ra_rad = 101.0 * kRadPerDeg, .dec_rad = -54.0 * kRadPerDeg}))
                .norm(),
            1e-12);
  EXPECT_NEAR(told->sigma_rad, 2.0 * kRadPerDeg, 1e-12);
}

TEST_F(OperatorActions, AreObeyedByABatchSolutionOfTheStoredRun) {
  live().receive(0, kAll, {{{"action", "mark_manoeuvre"}}}, true);
  StoredEdges stored = read_edges(path(), "SPINNER", std::nullopt).value();
  const auto edges = std::move(stored.pass).edges();
  ASSERT_FALSE(edges.empty());
  EXPECT_GE(tai_ns(edges.front().pulse.t), number("SELECT t_tai_ns FROM operator_action"));
  EXPECT_EQ(number("SELECT edges + outliers FROM spin_batch ORDER BY t_tai_ns DESC LIMIT 1"),
            static_cast<std::int64_t>(edges.size()));
}

TEST_F(OperatorActions, HoldForLaterRunsOfTheSameMode) {
  live().receive(0, kStopped, {kNoNorthIn});
  const std::int64_t of_first = left_out();
  Serving{.db = path(), .partition = "replay", .mode = RunMode::Replay}.receive(kStopped, kAll, {},
                                                                                true);
  EXPECT_EQ(left_out(), of_first);
  Serving{.db = path(), .partition = "live-2"}.receive(kStopped, kAll, {}, true);
  EXPECT_EQ(count("run"), 3);
  EXPECT_GT(left_out(), of_first);
}

/// A processor whose products supervision sees.
struct Supervised {
  Processor processor = new_processor();
  AlertDesk desk{{mission()}, RunMode::Live};
  std::vector<Product> products;

  void see(std::vector<ArchiveBatch> batches) {
    for (ArchiveBatch& batch : batches) {
      desk.evaluate(batch);
      products.insert(products.end(), batch.products.begin(), batch.products.end());
    }
  }
  void see(Routed routed) {
    see(std::move(routed.samples));
    for (const PassInput& input : routed.work) {
      see(processor.compute(input));
    }
  }
  /// Returns the last product of a kind that the condition holds for.
  template <class Kind, class Condition>
  const Kind* last(Condition holds) const {
    const Kind* found = nullptr;
    for (const Product& product : products) {
      const auto* const one = std::get_if<Kind>(&product);
      found = one != nullptr && holds(*one) ? one : found;
    }
    return found;
  }
};

TEST_F(OperatorActions, SetTheTargetOfSupervisionAlsoAfterARestart) {
  const json target{{"action", "set_target"}, {"ra_deg", 90.0}, {"dec_deg", 0.0}};
  live().receive(0, kStopped, {target});
  Supervised again;
  again.see(again.processor.go_on(path()).value().routed);
  EXPECT_EQ(std::count_if(again.products.begin(), again.products.end(),
                          [](const Product& product) {
                            const auto* const alert = std::get_if<Alert>(&product);
                            return alert != nullptr && alert->key == "spin.off_target" &&
                                   alert->state == AlertState::Active;
                          }),
            1);
  EXPECT_TRUE(again.desk.target_of("SPINNER"));
}

/// Behind the manoeuvre all fixes graze the limb, and none settles the axis of `sequential`.
TEST_F(OperatorActions, OfAManoeuvreBehindTwoExcludedChannelsLeaveTheAnswerOfBatchInForce) {
  const testing::Samples all = testing::edges_of(kPass, 3600);
  Supervised pass;
  pass.see(pass.processor.begin());
  const auto take = [&](std::size_t from, std::size_t to) {
    pass.see(
        pass.processor.route(testing::batch_of_samples<Pulse>(testing::part_of(all, from, to))));
  };
  take(0, kAll);
  for (const json& action : {json{{"action", "exclude_channel"}, {"channel", "sun2"}}, kNoNorthIn,
                             json{{"action", "mark_manoeuvre"}}}) {
    pass.see(pass.processor.route(batch_of(action)));
  }
  take(kAll, all.size());
  pass.see(pass.processor.finish());
  const auto quality_of = [&](SpinEstimator estimator) {
    return pass
        .last<SpinEstimate>([&](const SpinEstimate& is) { return is.estimator == estimator; })
        ->assessment.quality;
  };
  EXPECT_EQ(quality_of(SpinEstimator::Sequential), Quality::Ambiguous);
  EXPECT_EQ(quality_of(SpinEstimator::Batch), Quality::Ok);
  const auto* const answer = pass.last<SpinAnswer>([](const SpinAnswer&) { return true; });
  ASSERT_NE(answer, nullptr);
  EXPECT_EQ(answer->estimate.estimator, SpinEstimator::Batch);
  EXPECT_EQ(answer->quality, Quality::Ok);
}

}  // namespace spindrift::operator_action_test
