#include "services/program/arrival_tally.h"

#include "tests/support/matchers.h"

namespace spindrift::arrivals_test {

using ::testing::Pair;

TaiTime at(double t_s) { return shifted(tai_from_ns(1'795'143'637'000'000'000), t_s); }

template <class Value>
void add(ArchiveBatch& batch, const Value& value, bool is_left_out = false) {
  batch.samples.of<Value>().push_back({.spacecraft = batch.spacecraft_id,
                                       .origin = {},
                                       .value = value,
                                       .is_left_out = is_left_out});
}

TEST(ArrivalTally, KnowsTheLastOfEachChannelWhateverTheOrder) {
  ArchiveBatch batch{.run_id = "run", .spacecraft_id = "SPINNER"};
  add(batch, Pulse{.t = at(2.0), .channel = PulseChannel::Sun1});
  add(batch, Pulse{.t = at(1.0), .channel = PulseChannel::Sun1});
  add(batch, Pulse{.t = at(9.0), .channel = PulseChannel::NorthIn}, true);
  CodedFrame frame{.t = at(3.0), .period_s = 1.0, .delay_s = {}};
  frame.delay_s.at(index_of(PulseChannel::Sun2)) = 0.25;
  add(batch, frame);
  ArrivalTally tally;
  tally.count(batch);
  const TalliedArrivals found = tally.of("SPINNER");
  EXPECT_EQ(found.samples, 4);
  EXPECT_THAT(found.last, ElementsAre(Pair("sun1", at(3.0)), Pair("sun2", at(3.25))));
  EXPECT_FALSE(found.revolution);
  EXPECT_EQ(tally.of("OTHER").samples, 0);
}

TEST(ArrivalTally, KnowsTheKindsOfSensorsAndWhatARehearsalBringsAgain) {
  ArchiveBatch batch{.run_id = "run", .spacecraft_id = "SAT"};
  add(batch, GyroSample{.t = at(1.0)});
  add(batch, TimedOrbitState{.t = at(5.0)});
  batch.moved.of<GyroSample>().push_back({.arrival = {3}, .value = {.t = at(4.0)}});
  ArrivalTally tally;
  tally.count(batch);
  EXPECT_THAT(tally.of("SAT").last, ElementsAre(Pair("gyro", at(4.0))));
}

TEST(ArrivalTally, CountsTheRevolutionsOfARun) {
  ArchiveBatch batch{.run_id = "run", .spacecraft_id = "SPINNER"};
  batch.start = RunStart{};
  batch.products = {RevolutionProduct{.revolution = 7, .t_sun1 = at(7.0), .period_s = 1.0},
                    RevolutionProduct{.revolution = 6, .t_sun1 = at(6.0), .period_s = 1.0}};
  ArrivalTally tally;
  tally.count(batch);
  EXPECT_EQ(tally.of("SPINNER").revolution, 7);
  batch.start.reset();
  tally.count({.run_id = "next", .spacecraft_id = "SPINNER", .start = RunStart{}});
  tally.count(batch);  // The batch belongs to the earlier run.
  EXPECT_FALSE(tally.of("SPINNER").revolution);
}

}  // namespace spindrift::arrivals_test
