#include "services/ingest/writing_order.h"

#include <string>
#include <vector>

#include "tests/support/matchers.h"

namespace spindrift::writing_order_test {

using namespace std::chrono_literals;

/// Returns gyro samples and star fixes with these writing times, as taken in one look at all
/// topics.
SampleBatch look(const std::vector<std::int64_t>& gyro, const std::vector<std::int64_t>& star,
                 const std::string& source = "station") {
  SampleBatch taken;
  const auto add = [&]<class Value>(Kind<Value> /*kind*/, std::int64_t written) {
    taken.samples.of<Value>().push_back(
        {.spacecraft = "SAT", .origin = {.source = source}, .value = {}, .place = {written}});
  };
  for (const std::int64_t written : gyro) {
    add(Kind<GyroSample>{}, written);
  }
  for (const std::int64_t written : star) {
    add(Kind<StarFix>{}, written);
  }
  return taken;
}

/// Returns the writing times in the order of processing.
std::vector<std::int64_t> written(const SampleBatch& batch) {
  std::vector<std::int64_t> order;
  in_order_of_arrival(batch.samples,
                      [&](const auto& sample) { order.push_back(sample.place.number); });
  return order;
}

class WritingOrderTest : public ::testing::Test {
 protected:
  /// Ends the initial period of the session.
  void SetUp() override {
    pass_on(look({1}, {}));
    now_ += WritingOrder::kLastMinutes;
    EXPECT_THAT(pass_on({}), ElementsAre(1));
  }
  std::vector<std::int64_t> pass_on(SampleBatch taken) {
    return written(order_.pass_on(std::move(taken), now_));
  }

  WritingOrder order_;
  WritingOrder::Instant now_{1h};
};

TEST_F(WritingOrderTest, ASampleWaitsForOneLookAtAllTopics) {
  EXPECT_THAT(pass_on(look({2}, {})), IsEmpty());
  EXPECT_TRUE(order_.holds_some());
  EXPECT_FALSE(order_.wait_until());
  EXPECT_THAT(pass_on({}), ElementsAre(2));
  EXPECT_FALSE(order_.holds_some());
}

TEST_F(WritingOrderTest, WhatWasWrittenBeforeOnAnotherTopicComesBefore) {
  EXPECT_THAT(pass_on(look({4, 6, 8}, {})), IsEmpty());
  // Star fixes that were in transit, and samples written since.
  EXPECT_THAT(pass_on(look({9}, {5, 7, 10})), ElementsAre(4, 5, 6, 7, 8));
  EXPECT_THAT(pass_on(look({}, {})), ElementsAre(9, 10));
}

TEST_F(WritingOrderTest, OneTopicStaysInTheOrderInWhichItWasTaken) {
  SampleBatch taken = look({3, 5, 2, 4}, {});
  EXPECT_THAT(pass_on(std::move(taken)), IsEmpty());
  const SampleBatch passed = order_.pass_on({}, now_);
  std::vector<std::int64_t> order;
  for (const auto& sample : passed.samples.of<GyroSample>()) {
    order.push_back(sample.place.number);
  }
  EXPECT_THAT(order, ElementsAre(3, 5, 2, 4));
}

TEST_F(WritingOrderTest, TheLastMinutesOfANewSessionComeTopicByTopic) {
  EXPECT_THAT(pass_on(look({10, 20, 30, 40}, {}, "front-end")), IsEmpty());
  ASSERT_EQ(order_.wait_until(), now_ + WritingOrder::kLastMinutes);
  now_ += 50ms;
  EXPECT_THAT(pass_on({}), IsEmpty());
  EXPECT_THAT(pass_on(look({}, {15, 35}, "front-end")), IsEmpty());
  now_ += 200ms;
  EXPECT_THAT(pass_on({}), ElementsAre(10, 15, 20, 30, 35, 40));
  EXPECT_THAT(pass_on(look({50}, {}, "front-end")), IsEmpty());
  EXPECT_FALSE(order_.wait_until());
}

TEST_F(WritingOrderTest, TooManyDoNotWait) {
  std::vector<std::int64_t> many(WritingOrder::kMost);
  EXPECT_THAT(pass_on(look(many, {}, "front-end")), IsEmpty());
  EXPECT_EQ(pass_on({}).size(), many.size());
}

/// Returns gyro samples and star fixes, as `look`, whose seq are their writing times.
SampleBatch look_again(const std::vector<std::int64_t>& gyro,
                       const std::vector<std::int64_t>& star) {
  SampleBatch taken = look(gyro, star);
  taken.samples.for_each([](auto& of_kind) {
    for (auto& sample : of_kind) {
      sample.origin.seq = static_cast<std::uint64_t>(sample.place.number);
    }
  });
  return taken;
}

class WritingOrderAfterARestart : public WritingOrderTest {
 protected:
  void SetUp() override {
    LastOrigins stored;
    stored[kTelemetryKind<GyroSample>] = {{.source = "station", .session = 0, .seq = 20}};
    stored[kTelemetryKind<StarFix>] = {{.source = "station", .session = 0, .seq = 15}};
    order_ = WritingOrder{stored};
    EXPECT_THAT(pass_on(look_again({10, 20, 30, 40}, {})), ElementsAre(10, 20));
  }
};

TEST_F(WritingOrderAfterARestart, NewSamplesWaitUntilAllTopicsHaveSentAgainWhatIsStored) {
  now_ += 4s;
  EXPECT_THAT(pass_on(look_again({50}, {5})), ElementsAre(5));
  now_ += 500ms;
  EXPECT_THAT(pass_on(look_again({}, {15})), ElementsAre(15));
  now_ += 100ms;
  EXPECT_THAT(pass_on(look_again({}, {25, 35})), IsEmpty());
  now_ += WritingOrder::kLastMinutes;
  EXPECT_THAT(pass_on({}), ElementsAre(25, 30, 35, 40, 50));
  EXPECT_THAT(pass_on(look_again({60}, {})), IsEmpty());
  EXPECT_THAT(pass_on({}), ElementsAre(60));
}

TEST_F(WritingOrderAfterARestart, ATopicThatSendsNothingAgainIsNotWaitedForForEver) {
  now_ += WritingOrder::kLongest - 1ms;
  EXPECT_THAT(pass_on({}), IsEmpty());
  now_ += 1ms;
  EXPECT_THAT(pass_on({}), ElementsAre(30, 40));
  EXPECT_FALSE(order_.wait_until());
  EXPECT_THAT(pass_on(look({50}, {}, "front-end")), IsEmpty());
  EXPECT_EQ(order_.wait_until(), now_ + WritingOrder::kLastMinutes);
}

TEST_F(WritingOrderTest, GivesTheRestAtTheEnd) {
  EXPECT_THAT(pass_on(look({30}, {20}, "front-end")), IsEmpty());
  EXPECT_THAT(written(order_.rest()), ElementsAre(20, 30));
  EXPECT_FALSE(order_.holds_some());
}

}  // namespace spindrift::writing_order_test
