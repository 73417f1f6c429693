#include <fmt/format.h>

#include <chrono>
#include <cmath>
#include <numbers>

#include "pipelines/frames/celestial.h"
#include "services/publisher/product_messages.h"
#include "services/publisher/result_publisher.h"
#include "services/publisher/telemetry_publisher.h"
#include "services/publisher/to_idl.h"
#include "tests/support/bus_fixture.h"
#include "tests/support/matchers.h"
#include "tests/support/some_health.h"

namespace spindrift::publisher_test {

using bus::Participant;
using bus::Reader;

constexpr double kRad_deg = std::numbers::pi / 180.0;
// Allows for a few roundings of values up to 360.
constexpr double kRounding = 1e-12;

template <class Sample>
Reader<Sample> results_reader(const Participant& participant, const bus::Topic<Sample>& topic) {
  return Reader<Sample>::create(participant, topic, bus::results_qos()).value();
}

Eigen::Vector3d axis_deg(double ra_deg, double dec_deg) {
  return direction_icrf({.ra_rad = ra_deg * kRad_deg, .dec_rad = dec_deg * kRad_deg});
}

constexpr const char* kService = "spindrift@ship";
constexpr ResultOrigin kOrigin{.spacecraft = "SPINNER", .run_id = "run-1", .service = kService};

SpinFix a_fix() {
  return {.revolution = 4'000'000'000,
          .t = tai_from_ns(kTestTime_tai_ns),
          .geometry_case = 3,
          .axis_icrf = axis_deg(310.0, -64.0),
          .covariance_rad2 = Eigen::Vector2d{9.0, 16.0}.asDiagonal() * (kRad_deg * kRad_deg),
          .alternates = {},
          .resolution = Resolution::Geometry,
          .norm = 1.0,
          .accepted = true};
}

Reason revolutions(std::int64_t count) { return {ReasonCode::Revolutions, {{"count", count}}}; }

SpinEstimate an_estimate() {
  SpinEstimate estimate{.t = tai_from_ns(kTestTime_tai_ns),
                        .estimator = SpinEstimator::Mean,
                        .axis_icrf = axis_deg(12.5, 88.0),
                        .covariance_rad2 = {},
                        .spin_rate_rad_s = 100.0 * 2.0 * std::numbers::pi / 60.0,
                        .spin_rate_sigma_rad_s = 0.5 * 2.0 * std::numbers::pi / 60.0,
                        .assessment = {Quality::Doubtful, {revolutions(120)}}};
  estimate.covariance_rad2 << 0.25, -0.125, -0.125, 2.0;
  estimate.covariance_rad2 *= kRad_deg * kRad_deg;
  return estimate;
}

Health a_health() {
  Health health = testing::some_health();
  health.t = tai_from_ns(kTestTime_tai_ns);
  return health;
}

class ResultPublisherTest : public ::testing::Test {
 protected:
  /// Publishes a product and returns what a late subscriber receives.
  template <class Product>
  auto published(const std::string& spacecraft, const Product& product) {
    EXPECT_TRUE(publisher_.publish(spacecraft, "run-1", product));
    return take_samples(results_reader(participant_, product_topic<Product>()), 1).at(0);
  }

  Participant participant_ = Participant::create(bus_of_its_own()).value();
  ResultPublisher publisher_ = ResultPublisher::create(participant_, kService).value();
};

TEST_F(ResultPublisherTest, PublishesAFixInDegrees) {
  SpinFix fix = a_fix();
  fix.alternates = {{.axis_icrf = axis_deg(130.0, 20.0)}};
  const auto taken = published("SPINNER", fix);
  EXPECT_EQ(fmt::format("{} {} {} {} {} {}", taken.spacecraft, taken.t_tai_ns, taken.revolution,
                        taken.geometry_case, taken.run_id, taken.service),
            fmt::format("SPINNER {} 4000000000 3 run-1 {}", kTestTime_tai_ns, kService));
  EXPECT_NEAR(taken.ra_deg, 310.0, kRounding);
  EXPECT_NEAR(taken.dec_deg, -64.0, kRounding);
  EXPECT_NEAR(taken.sigma_deg, 5.0, kRounding);  // sqrt(9 + 16).
  EXPECT_NEAR(taken.alternate_ra_deg, 130.0, kRounding);
  EXPECT_NEAR(taken.alternate_dec_deg, 20.0, kRounding);
  EXPECT_EQ(taken.resolution, spindrift_GEOMETRY);
}

TEST_F(ResultPublisherTest, PublishesAnAttitudeAndNaNForARateThatIsNone) {
  AttitudeEstimate attitude{
      .t = tai_from_ns(kTestTime_tai_ns),
      .q_icrf_body = Eigen::Quaterniond{0.5, -0.5, 0.1, 0.7},
      .rate_body_rad_s = Eigen::Vector3d{0.25, -0.5, 1.0},
      .covariance_rad2 = Eigen::Vector3d{4.0, 16.0, 16.0}.asDiagonal() * (kRad_deg * kRad_deg),
      .assessment = {Quality::Doubtful,
                     {{ReasonCode::SensorGated, {{"sensor", std::string{"sun"}}}}}}};
  const auto taken = published("SAT", attitude);
  EXPECT_EQ(fmt::format("{} {} {} {} {} {} {} {}", taken.spacecraft, taken.estimator,
                        taken.t_tai_ns, taken.qx, taken.qy, taken.qz, taken.qw, taken.run_id),
            fmt::format("SAT mekf {} -0.5 0.1 0.7 0.5 run-1", kTestTime_tai_ns));
  EXPECT_THAT(taken.rate_body_rad_s, ElementsAre(0.25, -0.5, 1.0));
  EXPECT_NEAR(taken.sigma_deg, 6.0, kRounding);
  EXPECT_EQ(taken.quality, spindrift_QUALITY_DOUBTFUL);
  EXPECT_STREQ(taken.status, "DOUBTFUL, many sun samples gated");

  attitude.rate_body_rad_s.reset();
  EXPECT_TRUE(std::isnan(published("SAT", attitude).rate_body_rad_s[2]));
}

TEST_F(ResultPublisherTest, PublishesAnEstimateInDegreesAndRpm) {
  const auto taken = published("SPINNER", an_estimate());
  EXPECT_EQ(fmt::format("{} {} {} {} {}", taken.spacecraft, taken.estimator, taken.t_tai_ns,
                        taken.run_id, taken.service),
            fmt::format("SPINNER mean {} run-1 {}", kTestTime_tai_ns, kService));
  // The pole is two degrees away, which amplifies rounding.
  EXPECT_NEAR(taken.ra_deg, 12.5, kRounding * 100.0);
  EXPECT_NEAR(taken.dec_deg, 88.0, kRounding);
  EXPECT_NEAR(taken.sigma_deg, 1.5, kRounding);  // sqrt(0.25 + 2).
  EXPECT_NEAR(taken.covariance_deg2[0], 0.25, kRounding);
  EXPECT_NEAR(taken.covariance_deg2[1], -0.125, kRounding);
  EXPECT_NEAR(taken.covariance_deg2[2], 2.0, kRounding);
  EXPECT_NEAR(taken.spin_rate_rpm, 100.0, kRounding);
  EXPECT_NEAR(taken.sigma_rpm, 0.5, kRounding);
  EXPECT_STREQ(taken.status, "DOUBTFUL, 120 revolutions");
  EXPECT_EQ(taken.quality, spindrift_QUALITY_DOUBTFUL);
}

TEST_F(ResultPublisherTest, PublishesHealth) {
  ASSERT_TRUE(publisher_.publish(a_health()));
  const auto health = take_samples(results_reader(participant_, bus::kHealthTopic), 1).at(0);
  EXPECT_EQ(fmt::format("{} {} {} {} {} {} {} {} {}", health.service, health.t_tai_ns,
                        health.samples_received, health.samples_committed, health.gaps,
                        health.duplicates, health.queue_depth, health.commit_p99_ms, health.status),
            fmt::format("{} {} 6 5 4 3 2 1.5 ok", kService, kTestTime_tai_ns));
}

TEST_F(ResultPublisherTest, PublishesTheWholeMessageAndTheStateOfEverySpacecraft) {
  Health health = a_health();
  health.message = std::string(500, 'x') + "\nanother";
  health.status = health.message;
  health.spacecraft = {{.spacecraft = "HEARD",
                        .link = LinkState::Stale,
                        .last_sample = tai_from_ns(kTestTime_tai_ns - 7),
                        .data_age_s = 6.5,
                        .verdict = {.estimator = "mean",
                                    .quality = Quality::Doubtful,
                                    .sigma_deg = 0.25,
                                    .why = std::string(300, 'y'),
                                    .against = "mean and batch disagree"}},
                       {.spacecraft = "UNHEARD", .link = LinkState::Waiting}};
  const auto reader = results_reader(participant_, bus::kHealthTopic);
  ASSERT_TRUE(publisher_.publish(health));
  std::size_t taken = 0;
  // Strings and lists belong to the middleware and are valid only while it lends them.
  const auto check = [&](const spindrift_Health& sample) {
    ++taken;
    EXPECT_EQ(sample.status, std::string(61, 'x') + "...");
    EXPECT_EQ(sample.message, health.message);
    ASSERT_EQ(sample.spacecraft._length, 2U);
    const spindrift_SpacecraftHealth& heard = sample.spacecraft._buffer[0];
    EXPECT_STREQ(heard.spacecraft, "HEARD");
    EXPECT_EQ(heard.link, spindrift_LINK_STALE);
    EXPECT_EQ(heard.last_sample_tai_ns, kTestTime_tai_ns - 7);
    EXPECT_EQ(heard.data_age_s, 6.5);
    EXPECT_STREQ(heard.estimator, "mean");
    EXPECT_STREQ(heard.quality, "DOUBTFUL");
    EXPECT_EQ(heard.sigma_deg, 0.25);
    EXPECT_EQ(heard.why, std::string(300, 'y'));
    EXPECT_STREQ(heard.against, "mean and batch disagree");
    const spindrift_SpacecraftHealth& unheard = sample.spacecraft._buffer[1];
    EXPECT_EQ(unheard.link, spindrift_LINK_WAITING);
    EXPECT_EQ(unheard.last_sample_tai_ns, 0);
    EXPECT_TRUE(std::isnan(unheard.data_age_s));
    EXPECT_STREQ(unheard.estimator, "");
    EXPECT_STREQ(unheard.quality, "");
    EXPECT_TRUE(std::isnan(unheard.sigma_deg));
    EXPECT_STREQ(unheard.against, "no estimate");
  };
  ASSERT_TRUE(eventually([&] {
    reader.take(check).value();
    return taken > 0;
  }));
  EXPECT_EQ(taken, 1U);
}

TEST_F(ResultPublisherTest, GivesALateJoinerTheCurrentStateOfEverySpacecraft) {
  for (std::int64_t revolution = 0; revolution < 5; ++revolution) {
    SpinFix fix = a_fix();
    fix.revolution = revolution;
    ASSERT_TRUE(publisher_.publish("ONE", "run-1", fix));
    fix.revolution += 10;
    ASSERT_TRUE(publisher_.publish("TWO", "run-2", fix));
  }
  std::vector<std::int64_t> revolutions;
  for (const auto& fix : take_samples(results_reader(participant_, product_topic<SpinFix>()), 2)) {
    revolutions.push_back(fix.revolution);
  }
  EXPECT_THAT(revolutions, ::testing::UnorderedElementsAre(4, 14));
}

TEST_F(ResultPublisherTest, NamesASubscriberThatAsksForMore) {
  EXPECT_THAT(publisher_.incompatible_readers().value(), ElementsAre());
  bus::Qos demanding = bus::results_qos();
  dds_qset_durability(demanding.get(), DDS_DURABILITY_PERSISTENT);
  const auto reader =
      Reader<spindrift_Health>::create(participant_, bus::kHealthTopic, demanding).value();
  EXPECT_THAT(publisher_.incompatible_readers().value(),
              ElementsAre(HasSubstr("topic spindrift/health, asks for PERSISTENT; spindrift "
                                    "offers TRANSIENT_LOCAL")));
}

TEST(ToIdl, MarksAnAbsentAlternateByNan) {
  const auto out = to_idl(kOrigin, a_fix()).value();
  EXPECT_TRUE(std::isnan(out.alternate_ra_deg));
  EXPECT_TRUE(std::isnan(out.alternate_dec_deg));
}

TEST(ToIdl, NamesResolutionsAsTheIdlDoes) {
  const auto resolution_of = [](Resolution resolution) {
    SpinFix fix = a_fix();
    fix.resolution = resolution;
    return to_idl(kOrigin, fix).value().resolution;
  };
  EXPECT_EQ(resolution_of(Resolution::Geometry), spindrift_GEOMETRY);
  EXPECT_EQ(resolution_of(Resolution::Constraint), spindrift_CONSTRAINT);
  EXPECT_EQ(resolution_of(Resolution::Prior), spindrift_PRIOR);
  EXPECT_EQ(resolution_of(Resolution::Dispersion), spindrift_DISPERSION);
  EXPECT_EQ(resolution_of(Resolution::Ambiguous), spindrift_AMBIGUOUS);
}

TEST(ToIdl, RefusesANameThatDoesNotFit) {
  const std::string fits(32, 'x');
  const std::string too_long = fits + "x";
  const auto from = [](std::string_view spacecraft) {
    return ResultOrigin{.spacecraft = spacecraft, .run_id = "run-1", .service = kService};
  };
  EXPECT_STREQ(to_idl(from(fits), a_fix()).value().spacecraft, fits.c_str());
  EXPECT_THAT(to_idl(from(too_long), a_fix()),
              IsRefused(ErrorCode::InvalidInput, HasSubstr("33 bytes, at most 32 go on the bus")));
  EXPECT_FALSE(to_idl(from(too_long), an_estimate()).has_value());
  EXPECT_FALSE(to_idl(std::string(65, 'x'), a_health()).has_value());
  Health health = a_health();
  health.spacecraft = {{.spacecraft = too_long, .link = LinkState::Live}};
  EXPECT_FALSE(to_idl(kService, health).has_value());
}

TEST(ToIdl, CutsStatusTextBetweenWords) {
  SpinEstimate estimate = an_estimate();
  estimate.assessment.reasons.assign(4, revolutions(1234));
  EXPECT_STREQ(to_idl(kOrigin, estimate).value().status,
               "DOUBTFUL, 1234 revolutions, 1234 revolutions, 1234...");
}

TEST(ToIdl, CutsLongWordsBetweenCharacters) {
  Health health = a_health();
  health.status = std::string(64, 'x');
  EXPECT_EQ(to_idl(kService, health).value().sample.status, health.status);
  // The character has two bytes, of which only the first would fit.
  health.status = std::string(60, 'x') + "\u00e9" + std::string(9, 'x');
  EXPECT_EQ(to_idl(kService, health).value().sample.status, std::string(60, 'x') + "...");
}

constexpr Pulse kPulse{.t = tai_from_ns(kTestTime_tai_ns), .channel = PulseChannel::SouthIn};

TEST(PulsePublisher, PublishesEveryFieldAndNumbersItsSamplesFromZeroInOneSession) {
  const auto participant = Participant::create(bus_of_its_own()).value();
  auto publisher = TelemetryPublisher<Pulse>::create(participant, "replay").value();
  for (int i = 0; i < 100; ++i) {
    ASSERT_TRUE(publisher.publish("SPINNER", kPulse, {}));
  }
  const auto taken = take_samples(telemetry_reader<Pulse>(participant), 100);
  EXPECT_EQ(seqs_of(taken), first_seqs(100));
  EXPECT_STREQ(taken.at(0).spacecraft, "SPINNER");
  EXPECT_STREQ(taken[0].source, "replay");
  EXPECT_EQ(taken[0].t_tai_ns, kTestTime_tai_ns);
  EXPECT_EQ(taken[0].channel, spindrift_SOUTH_IN);
  EXPECT_EQ(taken[0].session, taken.back().session);
}

TEST(CodedPublisher, PublishesEveryFieldAndNanForWhatWasNotReceived) {
  const auto participant = Participant::create(bus_of_its_own()).value();
  auto publisher = TelemetryPublisher<CodedFrame>::create(participant, "replay", 17).value();
  ASSERT_TRUE(publisher.publish("SPINNER",
                                {.t = tai_from_ns(kTestTime_tai_ns),
                                 .period_s = 1.0,
                                 .delay_s = {std::nullopt, 0.125, 0.25, 0.375, 0.5, std::nullopt}},
                                {}));
  const auto taken = take_samples(telemetry_reader<CodedFrame>(participant), 1);
  ASSERT_EQ(taken.size(), 1U);
  const spindrift_CodedFrame& frame = taken[0];
  EXPECT_EQ(fmt::format("{} {} {} {} {}", frame.spacecraft, frame.source, frame.session, frame.seq,
                        frame.t_tai_ns),
            fmt::format("SPINNER replay 17 0 {}", kTestTime_tai_ns));
  EXPECT_EQ(fmt::format("{} {} {} {} {}", frame.period_s, frame.sun2_s, frame.north_in_s,
                        frame.north_out_s, frame.south_in_s),
            "1 0.125 0.25 0.375 0.5");
  EXPECT_TRUE(std::isnan(frame.south_out_s));
}

TEST(PulsePublisher, PackedSamplesAllArriveInOrder) {
  constexpr std::size_t kCount = 1000;
  const auto bus = bus_of_its_own();
  const auto sender = Participant::create(bus).value();
  const auto receiver = Participant::create(bus).value();
  const auto reader = telemetry_reader<Pulse>(receiver);
  auto publisher =
      TelemetryPublisher<Pulse>::create(sender, "replay", random_session(), bus::Sending::Packed)
          .value();
  ASSERT_TRUE(publisher.wait_for_subscriber(std::chrono::seconds{30}));
  for (std::size_t i = 0; i < kCount; ++i) {
    ASSERT_TRUE(publisher.publish("SPINNER", kPulse, {}));
  }
  ASSERT_TRUE(publisher.wait_for_acknowledgments(std::chrono::seconds{30}));
  EXPECT_EQ(seqs_of(take_samples(reader, kCount)), first_seqs(kCount));
}

TEST(PulsePublisher, DrawsAnotherSessionAtEachStart) {
  const auto participant = Participant::create(bus_of_its_own()).value();
  const auto first = TelemetryPublisher<Pulse>::create(participant, "replay").value();
  const auto second = TelemetryPublisher<Pulse>::create(participant, "replay").value();
  EXPECT_NE(first.next().session, second.next().session);
}

TEST(PulsePublisher, UsesNoSeqForASampleThatIsRefused) {
  const auto participant = Participant::create(bus_of_its_own()).value();
  auto publisher = TelemetryPublisher<Pulse>::create(participant, "replay").value();
  EXPECT_FALSE(publisher.publish(std::string(33, 'x'), kPulse, {}));
  EXPECT_EQ(publisher.next().seq, 0U);
  EXPECT_TRUE(publisher.publish("SPINNER", kPulse, {}));
  EXPECT_EQ(publisher.next().seq, 1U);
}

}  // namespace spindrift::publisher_test
