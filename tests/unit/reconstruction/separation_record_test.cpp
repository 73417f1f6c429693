#include "pipelines/reconstruction/separation_record.h"

#include <algorithm>
#include <chrono>
#include <tuple>
#include <variant>
#include <vector>

#include "pipelines/reconstruction/observations.h"
#include "pipelines/reconstruction/separation.h"
#include "tests/support/matchers.h"
#include "tests/support/separation_flight.h"

namespace spindrift::testing::separation_record_test {

using namespace std::chrono_literals;

using AnySample = std::variant<GyroSample, SunDirection, StarFix>;

TaiTime time_of(const AnySample& sample) {
  return std::visit([](const auto& is) { return is.t; }, sample);
}

/// Returns all samples in order of time; at equal times the star fix is last.
std::vector<AnySample> samples_of(const SeparationFlight& flight) {
  std::vector<AnySample> samples{flight.gyro.begin(), flight.gyro.end()};
  samples.insert(samples.end(), flight.sun.begin(), flight.sun.end());
  samples.insert(samples.end(), flight.stars.begin(), flight.stars.end());
  std::ranges::stable_sort(samples, [](const AnySample& a, const AnySample& b) {
    return std::tuple{time_of(a), a.index()} < std::tuple{time_of(b), b.index()};
  });
  return samples;
}

class SeparationRecordTest : public ::testing::Test {
 protected:
  void fly(const FlightPlan& plan) {
    flight_ = separation_flight(plan, 1);
    times_ = {.separation = flight_.times.separation};
  }
  /// Returns the times at which a solution is due, s after T1.
  std::vector<double> due_at_s(const std::vector<AnySample>& arrivals) {
    SeparationRecord record = empty();
    std::vector<double> due;
    for (const AnySample& sample : arrivals) {
      if (push(sample, record)) {
        due.push_back(seconds_between(times_.separation, time_of(sample)));
        due_requests_.push_back(record.request());
      }
    }
    return due;
  }
  SeparationRecord empty() const {
    return SeparationRecord{{.sensors = flight_.sensors,
                             .times = times_,
                             .gyro = {},
                             .sun_directions = {},
                             .star_fixes = {},
                             .orbit = flight_.orbit}};
  }
  SeparationRecord filled(const std::vector<AnySample>& samples) const {
    SeparationRecord record = empty();
    for (const AnySample& sample : samples) {
      push(sample, record);
    }
    return record;
  }
  /// Returns the samples without those of the gyro from `from_s` on.
  std::vector<AnySample> samples_without_gyro_from(double from_s) const {
    std::vector<AnySample> samples = samples_of(flight_);
    std::erase_if(samples, [&](const AnySample& sample) {
      return std::holds_alternative<GyroSample>(sample) && time_of(sample) >= at(from_s);
    });
    return samples;
  }
  static bool push(const AnySample& sample, SeparationRecord& record) {
    return std::visit([&](const auto& is) { return record.push(is); }, sample);
  }
  TaiTime at(double t_s) const { return shifted(times_.separation, t_s); }

  SeparationFlight flight_ = separation_flight({}, 1);
  SeparationTimes times_{.separation = flight_.times.separation};
  std::vector<ReconstructionRequest> due_requests_;
};

TEST_F(SeparationRecordTest, ForgetsWhatAnOperatorLeavesOutAndIsDueOnceASolutionRestedOnIt) {
  SeparationRecord record = empty();
  Exclusions<SampleKind> excluded;
  excluded.apply(at(0.0), ExcludeSegment<SampleKind>{
                              .from = at(0.0), .to = at(250.0), .channel = SampleKind::Gyro});
  bool was_due = false;
  for (const AnySample& sample : samples_of(flight_)) {
    if (!was_due) {
      EXPECT_FALSE(record.forget(excluded));
    }
    was_due = push(sample, record) || was_due;
  }
  ASSERT_TRUE(was_due);
  EXPECT_FALSE(record.forget(excluded));
  excluded.apply(at(280.0), ExcludeChannel<SampleKind>{SampleKind::Sun});
  const auto sun_before = record.request().sun_directions.size();
  EXPECT_TRUE(record.forget(excluded));
  EXPECT_FALSE(record.request().gyro.empty());
  EXPECT_GE(record.request().gyro.front().t, at(250.0));
  EXPECT_LT(record.request().sun_directions.size(), sun_before);
  EXPECT_LT(record.request().sun_directions.back().t, at(280.0));
}

TEST_F(SeparationRecordTest, OfContradictingSamplesNoneCountsUnlessOneIsPreferred) {
  SeparationRecord record = filled(samples_of(flight_));
  const auto whole = record.request();
  GyroSample other = flight_.gyro.at(40);
  other.sender = static_cast<Sender>(2);
  record.push(other);
  EXPECT_EQ(record.request().gyro.size(), whole.gyro.size());
  other.rate_body_rad_s.x() += 0.1;
  record.push(other);
  EXPECT_EQ(record.request().gyro.size(), whole.gyro.size() - 1);
  GyroSample preferred = flight_.gyro.at(40);
  preferred.sender = Sender::Preferred;
  record.push(preferred);
  ASSERT_EQ(record.request().gyro.size(), whole.gyro.size());
  EXPECT_EQ(record.request().gyro.at(40).t, preferred.t);
  EXPECT_EQ(record.request().gyro.at(40).rate_body_rad_s, preferred.rate_body_rad_s);
  preferred.rate_body_rad_s.y() += 0.1;
  record.push(preferred);
  EXPECT_EQ(record.request().gyro.size(), whole.gyro.size() - 1);
}

TEST_F(SeparationRecordTest, AnotherSolutionIsDueWhereOneRestedOnWhatIsContradicted) {
  SeparationRecord record = empty();
  bool was_due = false;
  for (const AnySample& sample : samples_of(flight_)) {
    was_due = push(sample, record) || was_due;
    EXPECT_FALSE(record.take_correction(10s));
  }
  ASSERT_TRUE(was_due);
  const auto contradict = [&](SunDirection sun) {
    sun.sun_body = -sun.sun_body;
    EXPECT_FALSE(record.push(sun));
    return record.take_correction(10s);
  };
  EXPECT_TRUE(contradict(flight_.sun.at(0)));
  EXPECT_FALSE(record.take_correction(10s));
  // Many consecutive corrections do not cause a solution each, but the last one is included.
  std::size_t next = 1;
  while (flight_.sun.at(next).t < flight_.sun.front().t + 10s) {
    EXPECT_FALSE(contradict(flight_.sun.at(next++)));
  }
  EXPECT_TRUE(contradict(flight_.sun.at(next)));
  EXPECT_FALSE(contradict(flight_.sun.at(next + 1)));
  EXPECT_TRUE(record.fall_silent(10s));
  EXPECT_FALSE(record.take_correction(0s));
}

TEST_F(SeparationRecordTest, ASolutionIsDueWithTheStarFixAndIsThatOfAllSamples) {
  EXPECT_THAT(due_at_s(samples_of(flight_)), ElementsAre(300.0));
  ReconstructionRequest whole = flight_.request();
  whole.times = times_;
  whole.disturbance_rad_s2 = due_requests_.front().disturbance_rad_s2;
  const Reconstruction due =
      reconstruct(due_requests_.front(), ReconstructionMethod::Batch).value();
  const Reconstruction expected = reconstruct(whole, ReconstructionMethod::Batch).value();
  ASSERT_EQ(due.events.size(), 4U);
  for (std::size_t i = 0; i < due.events.size(); ++i) {
    EXPECT_EQ(due.events[i].attitude.t, expected.events[i].attitude.t);
    EXPECT_EQ(due.events[i].attitude.q_icrf_body.coeffs(),
              expected.events[i].attitude.q_icrf_body.coeffs());
  }
}

TEST_F(SeparationRecordTest, MoreAreDueWhenTwiceAsManyStarFixesHaveArrived) {
  fly({.star_fix_step_s = 10.0, .end_s = 400.0});
  EXPECT_THAT(due_at_s(samples_of(flight_)), ElementsAre(300.0, 310.0, 330.0, 370.0));
}

TEST_F(SeparationRecordTest, AFixBeforeT3DoesNotCount) {
  fly({.first_star_fix_s = 70.0, .star_fix_step_s = 10.0, .end_s = 120.0});
  times_.acquisition = at(95.0);
  EXPECT_THAT(due_at_s(samples_of(flight_)), ElementsAre(100.0, 110.0));
}

TEST_F(SeparationRecordTest, FixesCountAnewOnceASunVectorShowsT3) {
  fly({.acquisition_s = 95.0, .first_star_fix_s = 70.0, .star_fix_step_s = 10.0, .end_s = 140.0});
  EXPECT_THAT(due_at_s(samples_of(flight_)), ElementsAre(70.0, 80.0, 100.0, 110.0, 130.0));
}

TEST_F(SeparationRecordTest, AFixAheadOfTheGyroSamplesWaitsForThem) {
  std::vector<AnySample> samples = samples_of(flight_);
  const auto early = samples.end() - 20;
  std::rotate(early, samples.end() - 1, samples.end());
  ASSERT_TRUE(std::holds_alternative<StarFix>(*early));
  EXPECT_THAT(due_at_s(samples), ElementsAre(300.0));
  EXPECT_EQ(due_requests_.front().gyro.back().t, at(300.0));
}

TEST_F(SeparationRecordTest, AFixThatTheNextGyroSampleWouldPassDoesNotWait) {
  EXPECT_THAT(due_at_s(samples_without_gyro_from(299.7)), ElementsAre(300.0));
}

TEST_F(SeparationRecordTest, AFixOfAClockThatIsAheadHoldsUpNone) {
  std::vector<AnySample> samples = samples_of(flight_);
  StarFix ahead = flight_.stars.front();
  ahead.t = at(5000.0);
  samples.insert(samples.begin() + 100, ahead);
  EXPECT_THAT(due_at_s(samples), ElementsAre(300.0));
}

TEST_F(SeparationRecordTest, SamplesCountInTheOrderOfTimeHoweverTheyArrive) {
  fly({.star_fix_step_s = 50.0, .end_s = 350.0});
  std::vector<AnySample> samples = samples_of(flight_);
  due_at_s(samples);
  const ReconstructionRequest in_order = due_requests_.back();
  // Each sample arrives twice, and many arrive late.
  for (std::size_t i = 0; i + 40 < samples.size(); i += 40) {
    const auto first = samples.begin() + static_cast<std::ptrdiff_t>(i);
    std::rotate(first, first + 7, first + 30);
  }
  samples.insert(samples.begin() + 900, samples.begin() + 100, samples.begin() + 800);
  due_at_s(samples);
  const ReconstructionRequest disordered = due_requests_.back();
  const auto same_times = [](const auto& a, const auto& b) {
    return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                      [](const auto& one, const auto& other) { return one.t == other.t; });
  };
  EXPECT_TRUE(same_times(disordered.gyro, in_order.gyro));
  EXPECT_TRUE(same_times(disordered.sun_directions, in_order.sun_directions));
  EXPECT_TRUE(same_times(disordered.star_fixes, in_order.star_fixes));
}

TEST_F(SeparationRecordTest, WhatIsBeforeT1OrMoreThanADayBehindItIsNotKept) {
  SeparationRecord record = empty();
  for (const double t_s : {-1.0, 0.0, 86400.0, 86401.0}) {
    record.push(GyroSample{at(t_s), Eigen::Vector3d::Zero()});
  }
  ASSERT_EQ(record.request().gyro.size(), 2U);
  EXPECT_EQ(record.request().gyro.front().t, at(0.0));
  EXPECT_EQ(record.request().gyro.back().t, at(86400.0));
}

TEST_F(SeparationRecordTest, InASilenceTheFixesBehindTheLastSolutionAreDueOnce) {
  fly({.star_fix_step_s = 10.0, .end_s = 360.0});
  SeparationRecord record = empty();
  EXPECT_FALSE(record.fall_silent(10s));
  std::size_t at_last = 0;
  for (const AnySample& sample : samples_of(flight_)) {
    if (push(sample, record)) {
      at_last = record.request().star_fixes.size();
      EXPECT_FALSE(record.fall_silent(10s));
    }
  }
  EXPECT_EQ(at_last, 4U);
  EXPECT_EQ(record.request().star_fixes.size(), 7U);
  EXPECT_TRUE(record.fall_silent(10s));
  EXPECT_FALSE(record.fall_silent(10s));
}

TEST_F(SeparationRecordTest,
       InSilencesOfABurstyStreamOneIsDueEveryTenSecondsAsLongAsSamplesAreUsed) {
  fly({.star_fix_step_s = 2.0, .end_s = 600.0});
  SeparationRecord record = empty();
  std::vector<double> due_s;
  for (const AnySample& sample : samples_of(flight_)) {
    push(sample, record);
    if (std::holds_alternative<StarFix>(sample) && record.fall_silent(10s)) {
      due_s.push_back(seconds_between(times_.separation, time_of(sample)));
    }
  }
  ASSERT_GE(due_s.size(), 2U);
  EXPECT_LE(due_s.size(), 12U);
  EXPECT_LE(due_s.back(), 300.0 + kUsedBehindFirstFix_s);
  for (std::size_t i = 1; i < due_s.size(); ++i) {
    EXPECT_GE(due_s[i] - due_s[i - 1], 10.0);
  }
  // A sample of an earlier part of the flight that arrives now.
  GyroSample late = flight_.gyro[flight_.gyro.size() / 4];
  late.t += 1ms;
  EXPECT_FALSE(push(late, record));
  EXPECT_TRUE(record.fall_silent(10s));
}

TEST_F(SeparationRecordTest, InASilenceAFixThatIsAwaitedHoldsUpNoOthers) {
  fly({.star_fix_step_s = 1.0, .end_s = 303.0});
  EXPECT_TRUE(filled(samples_without_gyro_from(302.2)).fall_silent(10s));
}

TEST_F(SeparationRecordTest, InASilenceTheFirstFixWaitsForGyroSamples) {
  SeparationRecord record = empty();
  for (const AnySample& sample : samples_without_gyro_from(250.0)) {
    EXPECT_FALSE(push(sample, record));
  }
  EXPECT_FALSE(record.fall_silent(10s));
}

TEST_F(SeparationRecordTest, WithoutAGyroSampleNothingIsDue) {
  EXPECT_THAT(due_at_s({flight_.stars.front(), flight_.sun.front()}), IsEmpty());
}

}  // namespace spindrift::testing::separation_record_test
