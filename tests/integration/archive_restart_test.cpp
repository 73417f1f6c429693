// What a service that resumes a pass reads back from the archive.

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "services/archive/stored_pass.h"
#include "services/archive/stored_results.h"
#include "tests/integration/archive_fixture.h"
#include "tests/support/matchers.h"

namespace spindrift::archive_restart_test {

using testing::batch_of;
using testing::going_on_from;
using testing::kRunStart;
using testing::pulse_at;
using testing::start_of;
using testing::with_products;

class ArchiveRestart : public testing::ArchiveFixture {
 protected:
  std::optional<StoredPass> stored(const RunStart& start = kRunStart) {
    const auto passes = find_stored_passes(path(), "SPINNER", start, senders_).value();
    return passes.empty() ? std::nullopt : std::optional{passes.back()};
  }

  static ArchiveBatch begun(const std::string& run_id, std::int64_t first_arrival) {
    ArchiveBatch batch = start_of(run_id);
    batch.start->first_arrival = {first_arrival};
    return batch;
  }

  static ArchiveBatch arrived(const std::string& run_id, std::int64_t arrival,
                              std::vector<ArrivedSample<Pulse>> pulses) {
    ArchiveBatch batch = batch_of(run_id);
    for (ArrivedSample<Pulse>& sample : pulses) {
      sample.arrival = {arrival++};
    }
    batch.samples.of<Pulse>() = std::move(pulses);
    const auto [first, last] =
        std::minmax_element(batch.samples.of<Pulse>().begin(), batch.samples.of<Pulse>().end(),
                            [](const ArrivedSample<Pulse>& a, const ArrivedSample<Pulse>& b) {
                              return a.value < b.value;
                            });
    batch.reach = {.first = first->value.t, .last = last->value.t};
    return batch;
  }

  static ArrivedSample<CodedFrame> frame_at(std::int64_t t_tai_ns, std::uint64_t seq,
                                            std::int64_t arrival = 0) {
    CodedFrame frame{.t = tai_from_ns(t_tai_ns), .period_s = 0.6, .delay_s = {}};
    frame.delay_s.at(index_of(PulseChannel::SouthOut)) = 0.25;
    return {.spacecraft = "SPINNER",
            .origin = {.source = "station", .session = 7, .seq = seq},
            .value = frame,
            .arrival = {arrival}};
  }

  SenderNames senders_{""};
};

std::vector<std::int64_t> times_of(const StoredPass& pass) {
  std::vector<std::int64_t> times;
  for (const Arrived<Pulse>& stored : pass.values.of<Pulse>()) {
    times.push_back(tai_ns(stored.value.t));
  }
  return times;
}

TEST_F(ArchiveRestart, CodedFrameThatArrivesTwiceIsStoredOnceWithItsFirstOrigin) {
  const auto archive = open();
  ArchiveBatch batch = start_of("run-1");
  batch.samples.of<CodedFrame>() = {frame_at(5, 1), frame_at(6, 2), frame_at(5, 3)};
  commit(*archive, batch);

  EXPECT_EQ(text("SELECT group_concat(format('%d %.2f %s %.2f %s %d', t_tai_ns, period_s, "
                 "ifnull(sun2_s, '-'), south_out_s, source, seq), '; ') FROM coded_frame"),
            "5 0.60 - 0.25 station 1; 6 0.60 - 0.25 station 2");
  EXPECT_EQ(archive->statistics().samples_committed, 3U);
}

TEST_F(ArchiveRestart, SamplesComeBackInTheOrderTheyArrivedIn) {
  ArchiveBatch late = arrived("run-1", 102, {pulse_at(40)});
  late.samples.of<CodedFrame>() = {frame_at(60, 9, 103)};
  store({begun("run-1", 100), arrived("run-1", 100, {pulse_at(50), pulse_at(70)}), late});

  const auto pass = stored();
  ASSERT_TRUE(pass);
  EXPECT_EQ(pass->run_id, "run-1");
  EXPECT_EQ(pass->earliest, tai_from_ns(40));
  EXPECT_THAT(times_of(*pass), ElementsAre(50, 70, 40));
  const auto& frames = pass->values.of<CodedFrame>();
  ASSERT_EQ(frames.size(), 1U);
  EXPECT_EQ(frames[0].arrival, RunPlace{103});
  EXPECT_EQ(frames[0].value.period_s, 0.6);
  EXPECT_EQ(frames[0].value.delay_s, frame_at(60, 9).value.delay_s);
}

TEST_F(ArchiveRestart, SamplesOfARunThatAnEarlierOneHasStoredAreItsOwnToo) {
  store({begun("run-1", 100), arrived("run-1", 100, {pulse_at(10), pulse_at(20), pulse_at(30)}),
         begun("run-2", 200), arrived("run-2", 200, {pulse_at(30), pulse_at(20), pulse_at(40)}),
         arrived("run-2", 203, {pulse_at(30)})});

  const auto pass = stored();
  ASSERT_TRUE(pass);
  EXPECT_EQ(pass->run_id, "run-2");
  EXPECT_THAT(times_of(*pass), ElementsAre(30, 20, 40));
}

TEST_F(ArchiveRestart, ARunEndsWhereOneOfAnotherModeBegins) {
  ArchiveBatch processed = begun("run-2", 200);
  processed.start->mode = RunMode::Live;
  store({begun("run-1", 100), arrived("run-1", 100, {pulse_at(10), pulse_at(20)}), processed,
         arrived("run-2", 200, {pulse_at(30)})});
  const auto pass = stored();
  ASSERT_TRUE(pass);
  EXPECT_EQ(pass->run_id, "run-1");
  EXPECT_THAT(times_of(*pass), ElementsAre(10, 20));
}

TEST_F(ArchiveRestart, WhatWasLeftOutMakesWayForASampleOfItsTime) {
  const auto archive = open();
  ASSERT_TRUE(archive->submit(begun("run-1", 100)));
  const auto gyro = [](double x, std::int64_t arrival, const std::string& source,
                       bool is_left_out = false) {
    return ArrivedSample<GyroSample>{
        .spacecraft = "SPINNER",
        .origin = {.source = source, .session = 1, .seq = 1},
        .value = {.t = tai_from_ns(10), .rate_body_rad_s = Eigen::Vector3d{x, 0.0, 0.0}},
        .arrival = {arrival},
        .is_left_out = is_left_out};
  };
  for (const auto& sample : {gyro(3.0, 101, "wrong", true), gyro(0.1, 102, "right"),
                             gyro(4.0, 103, "wrong", true), gyro(0.2, 104, "again")}) {
    ArchiveBatch batch = batch_of("run-1");
    batch.samples.of<GyroSample>() = {sample};
    ASSERT_TRUE(archive->submit(batch));
  }
  ASSERT_TRUE(archive->flush());
  const std::string rows =
      "SELECT group_concat(wx_rad_s || ' ' || source || ' ' || arrival) FROM gyro_sample";
  EXPECT_EQ(text(rows), "0.1 right 102");

  // A later run that leaves out a repeated sample does not take it from the run that has it.
  ArchiveBatch again = batch_of("run-2");
  again.samples.of<GyroSample>() = {gyro(0.1, 201, "right", true)};
  commit(*archive, {begun("run-2", 200), again});
  EXPECT_EQ(text(rows), "0.1 right 102");
}

TEST_F(ArchiveRestart, WhatARunLeftOutComesBackApartUntilARunTakesIt) {
  const auto archive = open();
  ArchiveBatch left_out = arrived("run-1", 101, {pulse_at(20, 8), pulse_at(10, 7)});
  left_out.reach = {};
  for (auto& sample : left_out.samples.of<Pulse>()) {
    sample.is_left_out = true;
  }
  commit(*archive, {begun("run-1", 100), arrived("run-1", 100, {pulse_at(50)}), left_out});

  auto pass = stored();
  ASSERT_TRUE(pass);
  EXPECT_EQ(pass->earliest, tai_from_ns(50));
  EXPECT_THAT(times_of(*pass), ElementsAre(50));
  ASSERT_EQ(pass->left_out.size(), 1U);
  EXPECT_EQ(pass->left_out[0].last.source, "station");
  EXPECT_EQ(pass->left_out[0].last.seq, 8U);
  const auto& pulses = pass->left_out[0].values.of<Pulse>();
  ASSERT_EQ(pulses.size(), 2U);
  EXPECT_EQ(pulses[0].arrival, RunPlace{101});
  EXPECT_EQ(pulses[1].arrival, RunPlace{102});
  EXPECT_EQ(pulses[1].value.t, tai_from_ns(10));

  ArchiveBatch taken = begun("run-2", 200);
  taken.reach = {.first = tai_from_ns(10), .last = tai_from_ns(20)};
  taken.moved.of<Pulse>() = {{.arrival = {200}, .value = pulses[0].value},
                             {.arrival = {201}, .value = pulses[1].value}};
  commit(*archive, taken);
  pass = stored();
  ASSERT_TRUE(pass);
  EXPECT_THAT(times_of(*pass), ElementsAre(20, 10));
  EXPECT_TRUE(pass->left_out.empty());
  EXPECT_EQ(text("SELECT group_concat(source || ' ' || seq, ', ') FROM pulse WHERE arrival >= 200"),
            "station 7, station 8");
  EXPECT_THAT(times_of(find_stored_passes(path(), "SPINNER", kRunStart, senders_).value().front()),
              ElementsAre(50));
}

TEST_F(ArchiveRestart, TheLastSampleOfEachSessionComesBack) {
  ArrivedSample<Pulse> other = pulse_at(30, 2);
  other.origin.session = ~std::uint64_t{0};
  ArchiveBatch batch = arrived("run-1", 100, {pulse_at(10, 41), pulse_at(40, 42), other});
  batch.samples.of<CodedFrame>() = {frame_at(50, 9, 103)};
  store({begun("run-1", 100), batch});

  const auto text_of = [](const std::vector<Origin>& origins) {
    std::string text;
    for (const Origin& origin : origins) {
      text += fmt::format("{} {} {}; ", origin.source, origin.session, origin.seq);
    }
    return text;
  };
  const LastOrigins last = stored().value().last_origins;
  EXPECT_EQ(text_of(last[kTelemetryKind<Pulse>]), "station 18446744073709551615 2; station 7 42; ");
  EXPECT_EQ(text_of(last[kTelemetryKind<CodedFrame>]), "station 7 9; ");
}

TEST_F(ArchiveRestart, OnlyARunThatWasMadeTheSameWayIsContinued) {
  store(begun("run-1", 100));
  ASSERT_TRUE(stored());
  EXPECT_FALSE(stored()->earliest);
  const std::vector<void (*)(RunStart&)> changes{
      [](RunStart& start) { start.mode = RunMode::Live; },
      [](RunStart& start) { start.orbit_sha256.reset(); },
      [](RunStart& start) { start.telemetry.pop_back(); },
      [](RunStart& start) { start.software_version += "x"; },
      [](RunStart& start) { start.config_sha256 += "x"; }};
  for (const auto& change : changes) {
    RunStart other = kRunStart;
    change(other);
    EXPECT_FALSE(stored(other));
  }
  EXPECT_TRUE(find_stored_passes(path(), "OTHER", kRunStart, senders_).value().empty());
}

Product revolution_at(std::int64_t number) {
  return RevolutionProduct{
      .revolution = number, .t_sun1 = tai_from_ns(10 * number), .period_s = 0.6};
}

Product period_of(std::int64_t number) {
  return SpinMeasurement{.revolution = number,
                         .quantity = SpinQuantity::Period,
                         .value = 0.6,
                         .sigma = 0.1,
                         .rejected_by = {}};
}

Product use_at(std::int64_t t_tai_ns) {
  return PulseUse{
      .pulse = pulse_at(t_tai_ns).value, .revolution = t_tai_ns / 10, .rejected_by = {}};
}

TEST_F(ArchiveRestart, RunThatGoesOnIsNotFinishedAndItsLastProductsAreWithdrawn) {
  ArchiveBatch whole = start_of("run-1");
  for (std::int64_t number = 0; number < 5; ++number) {
    whole.products.insert(whole.products.end(),
                          {revolution_at(number), period_of(number), use_at(10 * number)});
  }
  whole.finished_utc = "2026-11-20T04:00:00Z";
  store({whole, with_products(going_on_from(30), {revolution_at(3)})});

  EXPECT_EQ(count("run WHERE finished_utc IS NULL"), 1);
  EXPECT_EQ(text("SELECT group_concat(revolution, ' ') FROM revolution"), "0 1 2 3");
  EXPECT_EQ(text("SELECT group_concat(revolution, ' ') FROM spin_measurement"), "0 1 2");
  EXPECT_EQ(text("SELECT group_concat(revolution, ' ') FROM pulse_use"), "0 1 2");
}

TEST_F(ArchiveRestart, LastRevolutionIsTheOneThatNoTableIsBehind) {
  const auto archive = open();
  const auto after = [&](std::vector<Product> products) {
    commit(*archive, with_products(batch_of("run-1"), std::move(products)));
    return stored()->last_made;
  };
  ASSERT_TRUE(archive->submit(start_of("run-1")));
  EXPECT_EQ(after({revolution_at(1), revolution_at(2), revolution_at(3)}), std::nullopt);
  EXPECT_EQ(after({use_at(15)}), std::nullopt);
  EXPECT_EQ(after({period_of(1), period_of(2)}), tai_from_ns(15));
  EXPECT_EQ(after({use_at(25), use_at(35)}), tai_from_ns(20));
  EXPECT_EQ(after({period_of(4)}), tai_from_ns(30));
  EXPECT_EQ(after({revolution_at(4), period_of(5)}), tai_from_ns(35));
  // An edge with an impossible time does not show how far its table reaches.
  EXPECT_EQ(after({PulseUse{.pulse = pulse_at(1'000'000).value,
                            .revolution = {},
                            .rejected_by = Rejection::OutOfTime}}),
            tai_from_ns(35));
}

TEST_F(ArchiveRestart, MeasurementsOfRevolutionsWithoutSun1AreWithdrawnToo) {
  ArchiveBatch whole = start_of("run-1");
  for (std::int64_t number = 0; number < 5; ++number) {
    whole.products.emplace_back(
        PulseUse{.pulse = {.t = tai_from_ns(number * 10), .channel = PulseChannel::Sun2},
                 .revolution = number,
                 .rejected_by = std::nullopt});
    whole.products.emplace_back(SpinMeasurement{.revolution = number,
                                                .quantity = SpinQuantity::NorthChord,
                                                .value = 0.1,
                                                .sigma = 0.1,
                                                .rejected_by = std::nullopt});
  }
  store({whole, going_on_from(30)});

  EXPECT_EQ(text("SELECT group_concat(revolution, ' ') FROM spin_measurement"), "0 1 2");
  EXPECT_EQ(text("SELECT group_concat(revolution, ' ') FROM pulse_use"), "0 1 2");
}

SpinFix fix_with_alternates(std::size_t alternates) {
  SpinFix fix{.revolution = 7,
              .t = tai_from_ns(70),
              .geometry_case = 5,
              .axis_icrf = Eigen::Vector3d::UnitX(),
              .covariance_rad2 = Eigen::Matrix2d::Identity(),
              .alternates = {},
              .resolution = Resolution::Ambiguous,
              .norm = 1.0,
              .accepted = false};
  const std::vector<Eigen::Vector3d> axes = {Eigen::Vector3d::UnitY(), -Eigen::Vector3d::UnitX(),
                                             -Eigen::Vector3d::UnitY()};
  for (std::size_t i = 0; i < alternates; ++i) {
    fix.alternates.push_back({.axis_icrf = axes.at(i)});
  }
  return fix;
}

SpinFix accepted_fix(std::int64_t revolution) {
  SpinFix fix = fix_with_alternates(1);
  fix.revolution = revolution;
  fix.resolution = Resolution::Prior;
  fix.accepted = true;
  return fix;
}

SpinEstimate estimate_at(std::int64_t t_tai_ns, SpinEstimator estimator) {
  return {.t = tai_from_ns(t_tai_ns),
          .estimator = estimator,
          .axis_icrf = Eigen::Vector3d{1.0, 2.0, -2.0} / 3.0,
          .covariance_rad2 = (Eigen::Matrix2d{} << 4e-6, 1e-6, 1e-6, 9e-6).finished(),
          .spin_rate_rad_s = 6.0,
          .spin_rate_sigma_rad_s = 0.1,
          .assessment = {Quality::Ok,
                         {{ReasonCode::Fixes, {{"count", std::int64_t{5}}}},
                          {ReasonCode::ModelOff, {{"deg", 0.5}}},
                          {ReasonCode::ChannelGated, {{"channel", "sun1"}}}}}};
}

TEST_F(ArchiveRestart, ResultsInForceComeBackAsTheyWereGiven) {
  using enum SpinEstimator;
  ArchiveBatch batch = start_of("run-1");
  const SpinFix fix = accepted_fix(5);
  const SpinEstimate last = estimate_at(50, Sequential);
  SpinFix contradictory = accepted_fix(8);
  contradictory.accepted = false;
  batch.products = {accepted_fix(4),       fix, contradictory, estimate_at(40, Sequential),
                    estimate_at(40, Mean), last};
  store(batch);

  const StoredResults stored = find_stored_results(path(), "run-1").value();
  const std::vector<Product> in_force = stored.in_force();
  ASSERT_EQ(in_force.size(), 3U);
  const auto& again = std::get<SpinFix>(in_force.at(0));
  EXPECT_EQ(again.revolution, 5);
  EXPECT_EQ(again.t, fix.t);
  EXPECT_EQ(again.resolution, Resolution::Prior);
  EXPECT_TRUE(again.accepted);
  EXPECT_TRUE(again.axis_icrf.isApprox(fix.axis_icrf, 1e-14));
  EXPECT_TRUE(again.covariance_rad2.isApprox(fix.covariance_rad2, 1e-14));
  EXPECT_TRUE(again.alternates.at(0).axis_icrf.isApprox(fix.alternates.at(0).axis_icrf, 1e-14));
  const auto& estimate = std::get<SpinEstimate>(in_force.at(2));
  EXPECT_EQ(estimate.t, last.t);
  EXPECT_EQ(estimate.estimator, Sequential);
  EXPECT_TRUE(estimate.axis_icrf.isApprox(last.axis_icrf, 1e-14));
  EXPECT_TRUE(estimate.covariance_rad2.isApprox(last.covariance_rad2, 1e-14));
  EXPECT_NEAR(estimate.spin_rate_rad_s, last.spin_rate_rad_s, 1e-14);
  EXPECT_NEAR(estimate.spin_rate_sigma_rad_s, last.spin_rate_sigma_rad_s, 1e-14);
  EXPECT_EQ(estimate.assessment, last.assessment);
}

TEST_F(ArchiveRestart, ResultsThatWereGivenBeforeAreKnownButNotAFixThatIsDecidedNow) {
  using enum SpinEstimator;
  store_run({accepted_fix(6), fix_with_alternates(2), estimate_at(70, Mean)});

  const StoredResults stored = find_stored_results(path(), "run-1").value();
  EXPECT_TRUE(stored.hold(accepted_fix(6)));
  EXPECT_FALSE(stored.hold(accepted_fix(8)));
  // The seventh fix is AMBIGUOUS.
  EXPECT_TRUE(stored.hold(fix_with_alternates(3)));
  EXPECT_FALSE(stored.hold(accepted_fix(7)));
  EXPECT_TRUE(stored.hold(estimate_at(70, Mean)));
  EXPECT_FALSE(stored.hold(estimate_at(71, Mean)));
  EXPECT_FALSE(stored.hold(estimate_at(70, Sequential)));
  EXPECT_TRUE(find_stored_results(path(), "run-2").value().in_force().empty());
}

TEST_F(ArchiveRestart, AllAxesOfAnAmbiguousFixAreStoredUntilItIsGivenAgainOrWithdrawn) {
  const std::string stored_axes =
      "SELECT group_concat(format('%d %d %.0f', revolution, candidate, ra_deg), '; ') FROM "
      "spin_fix_candidate WHERE candidate > 0";
  const auto archive = open();
  commit(*archive, with_products(start_of("run-1"), {fix_with_alternates(3)}));
  EXPECT_EQ(text(stored_axes), "7 1 90; 7 2 180; 7 3 270");

  commit(*archive, with_products(batch_of("run-1"), {fix_with_alternates(1)}));
  EXPECT_EQ(text(stored_axes), "7 1 90");
  EXPECT_EQ(real("SELECT alternate_ra_deg FROM spin_fix"), 90.0);

  commit(*archive, {with_products(batch_of("run-1"), {fix_with_alternates(2)}), going_on_from(70)});
  EXPECT_EQ(count("spin_fix_candidate"), 0);
}

TEST_F(ArchiveRestart, WhatBecomesOfAnEdgeLaterStandsButNotThatItIsLate) {
  const Pulse pulse = pulse_at(5).value;
  store_run({PulseUse{.pulse = pulse, .revolution = {}, .rejected_by = Rejection::Unassociated},
             PulseUse{.pulse = pulse, .revolution = 3, .rejected_by = std::nullopt},
             PulseUse{.pulse = pulse, .revolution = {}, .rejected_by = Rejection::Late}});
  EXPECT_EQ(text("SELECT revolution || ' ' || accepted || ifnull(rejected_by, '') FROM pulse_use"),
            "3 1");
}

}  // namespace spindrift::archive_restart_test
