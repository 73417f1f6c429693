#include "services/processor/pass_computing.h"

#include <limits>
#include <stdexcept>

#include "pipelines/three_axis/three_axis_pass.h"
#include "tests/support/matchers.h"
#include "tests/support/of_kind.h"

namespace spindrift::pass_computing_test {

/// Makes a product for each sample at its time, an attitude if the rate about z is not zero,
/// another product at each silence and at the end, and throws at `throws_at`.
class FakePass {
 public:
  explicit FakePass(std::optional<TaiTime> throws_at = {}) : throws_at_{throws_at} {}

  ThreeAxisOutput push(const GyroSample& sample) {
    if (sample.t == throws_at_) {
      throw std::runtime_error{"no table has a place for it"};
    }
    t_ = sample.t;
    ThreeAxisOutput output{
        .products = {RejectedSample{
            .t = sample.t,
            .kind = SampleKind::Gyro,
            .rejected_by = Rejection::Innovation,
            .failed = FailedTest{.value = sample.rate_body_rad_s.x(), .limit = 1.0}}},
        .notices = {}};
    if (sample.rate_body_rad_s.z() != 0.0) {
      output.products.emplace_back(AttitudeEstimate{.t = sample.t,
                                                    .q_icrf_body = Eigen::Quaterniond::Identity(),
                                                    .rate_body_rad_s = sample.rate_body_rad_s,
                                                    .covariance_rad2 = Eigen::Matrix3d::Identity(),
                                                    .assessment = {Quality::Ok}});
    }
    return output;
  }
  ThreeAxisOutput fall_silent() { return again(Rejection::Frozen); }
  ThreeAxisOutput finish() { return again(Rejection::Saturated); }

 private:
  ThreeAxisOutput again(Rejection why) const {
    return {.products = {RejectedSample{.t = t_, .kind = SampleKind::Gyro, .rejected_by = why}},
            .notices = {}};
  }

  std::optional<TaiTime> throws_at_;
  TaiTime t_ = {};
};

PassInput input_at(const std::vector<std::int64_t>& times, std::vector<BatchPlace> silences = {}) {
  PassInput input{.spacecraft = 0, .run_id = "run", .silences = std::move(silences)};
  for (const std::int64_t t : times) {
    input.values.of<GyroSample>().push_back(
        {.place = next_place(input), .value = {.t = tai_from_ns(t)}});
  }
  return input;
}

constexpr auto kNote = [](const ThreeAxisOutput& /*output*/) {};

std::vector<std::int64_t> times_of(const std::vector<Product>& products) {
  std::vector<std::int64_t> times;
  for (const Product& product : products) {
    times.push_back(tai_ns(std::get<RejectedSample>(product).t));
  }
  return times;
}

TEST(PassComputing, SilencesHaveTheirPlaceAmongTheSamples) {
  PassComputing<FakePass> computing{"SAT", "run", FakePass{}};
  const auto batches = computing.compute(input_at({1, 2, 3}, {{2}, {3}}), kNote);
  ASSERT_THAT(batches, SizeIs(1));
  EXPECT_THAT(times_of(batches[0].products), ElementsAre(1, 2, 2, 3, 3));
  EXPECT_EQ(batches[0].run_id, "run");
  EXPECT_EQ(batches[0].spacecraft_id, "SAT");
}

TEST(PassComputing, SaysWhetherItsResidualsAreStored) {
  const auto stores_residuals = [](bool stores) {
    PassComputing<FakePass> computing{"SAT", "run", FakePass{}, stores};
    return computing.compute(input_at({1}), kNote).at(0).stores_residuals;
  };
  EXPECT_TRUE(stores_residuals(true));
  EXPECT_FALSE(stores_residuals(false));
}

TEST(PassComputing, KnowsNothingOfTheOtherKinds) {
  PassComputing<FakePass> computing{"SAT", "run", FakePass{}};
  PassInput input = input_at({});
  input.values.of<StarFix>().push_back({.place = {}, .value = {.t = tai_from_ns(1)}});
  EXPECT_THAT(computing.compute(input, kNote), IsEmpty());
}

TEST(PassComputing, WhatIsThrownBecomesAFaultBehindWhatWasMade) {
  PassComputing<FakePass> computing{"SAT", "run", FakePass{tai_from_ns(3)}};
  const auto batches = computing.compute(input_at({1, 2, 3, 4}), kNote);
  ASSERT_THAT(batches, SizeIs(1));
  ASSERT_THAT(batches[0].products, SizeIs(3));
  const auto& fault = std::get<RunFault>(batches[0].products[2]);
  EXPECT_EQ(fault.t, tai_from_ns(3));
  EXPECT_EQ(fault.what, "no table has a place for it");
  EXPECT_TRUE(computing.failed());
  EXPECT_THAT(computing.compute(input_at({5}), kNote), IsEmpty());
  std::vector<Product> last;
  computing.finish(last, kNote);
  EXPECT_THAT(last, IsEmpty());

  computing.begin("next", FakePass{});
  EXPECT_THAT(computing.compute(input_at({6}), kNote), SizeIs(1));
}

TEST(PassComputing, StoresNothingAgainBeforeTheResumePoint) {
  PassComputing<FakePass> computing{"SAT", "run", FakePass{}};
  computing.go_on({{"run", {.again_from = tai_from_ns(3), .batches = {}}}});
  computing.begin("run", FakePass{});
  std::size_t noted = 0;
  const auto note = [&](const ThreeAxisOutput& output) { noted += output.products.size(); };
  EXPECT_THAT(computing.compute(input_at({1, 2}, {{2}}), note), IsEmpty());
  const auto batches = computing.compute(input_at({3, 4}), note);
  ASSERT_THAT(batches, SizeIs(1));
  EXPECT_EQ(batches[0].continuation.value().t, tai_from_ns(3));
  EXPECT_THAT(times_of(batches[0].products), ElementsAre(3, 4));
  EXPECT_EQ(noted, 5U);
  EXPECT_FALSE(computing.compute(input_at({5}), note)[0].continuation);
}

TEST(PassComputing, WithholdsAProductThatIsNotFinite) {
  PassComputing<FakePass> computing{"SAT", "run", FakePass{}};
  PassInput input = input_at({1, 2});
  input.values.of<GyroSample>()[0].value.rate_body_rad_s.x() =
      std::numeric_limits<double>::quiet_NaN();
  std::vector<Notice> notices;
  const auto batches = computing.compute(input, [&](const ThreeAxisOutput& output) {
    notices.insert(notices.end(), output.notices.begin(), output.notices.end());
  });
  ASSERT_THAT(batches, SizeIs(1));
  ASSERT_THAT(batches[0].products, SizeIs(2));
  const auto& notice = std::get<RunNotice>(batches[0].products[0]);
  EXPECT_EQ(notice.code, "not_finite");
  EXPECT_FALSE(notice.t);
  EXPECT_EQ(std::get<RejectedSample>(batches[0].products[1]).t, tai_from_ns(2));
  ASSERT_THAT(notices, SizeIs(1));
  EXPECT_EQ(notices[0].code, NoticeCode::NotFinite);
}

PassInput with_rates_z(PassInput input, const std::vector<double>& rates_rad_s) {
  auto& samples = input.values.of<GyroSample>();
  for (std::size_t i = 0; i < samples.size(); ++i) {
    samples[i].value.rate_body_rad_s.z() = rates_rad_s.at(i);
  }
  return input;
}

std::vector<AttitudeEstimate> answers_in(const std::vector<ArchiveBatch>& batches) {
  std::vector<AttitudeEstimate> answers;
  for (const ArchiveBatch& batch : batches) {
    const auto more = of_kind<AttitudeEstimate>(batch.products);
    answers.insert(answers.end(), more.begin(), more.end());
  }
  return answers;
}

TEST(PassComputing, WhereItFailsTheLastAnswerStandsDoubtful) {
  PassComputing<FakePass> computing{"SAT", "run", FakePass{tai_from_ns(5)}};
  const auto answers =
      answers_in(computing.compute(with_rates_z(input_at({1, 2, 5}), {0.1, 0.2, 0.3}), kNote));
  ASSERT_THAT(answers, SizeIs(3));
  EXPECT_EQ(answers[2].t, tai_from_ns(5));
  EXPECT_EQ(answers[2].rate_body_rad_s, answers[1].rate_body_rad_s);
  EXPECT_EQ(
      answers[2].assessment,
      (Assessment{Quality::Doubtful,
                  {{ReasonCode::ComputingFailed, {{"what", "no table has a place for it"}}}}}));
}

TEST(PassComputing, InPlaceOfAWithheldAnswerTheOneBeforeStandsDoubtful) {
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  PassComputing<FakePass> computing{"SAT", "run", FakePass{}};
  const auto answers = answers_in(
      computing.compute(with_rates_z(input_at({1, 2, 3, 4}), {kNone, 0.2, kNone, 0.4}), kNote));
  ASSERT_THAT(answers, SizeIs(3));
  EXPECT_EQ(answers[0].assessment.quality, Quality::Ok);
  EXPECT_EQ(answers[1].t, tai_from_ns(3));
  EXPECT_EQ(answers[1].rate_body_rad_s, answers[0].rate_body_rad_s);
  EXPECT_EQ(answers[1].assessment.quality, Quality::Doubtful);
  EXPECT_TRUE(has(answers[1].assessment, ReasonCode::Withheld));
  EXPECT_EQ(answers[2].assessment.quality, Quality::Ok);
}

}  // namespace spindrift::pass_computing_test
