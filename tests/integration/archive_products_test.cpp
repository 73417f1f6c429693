#include <SQLiteCpp/Statement.h>
#include <fmt/format.h>

#include <memory>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "pipelines/frames/angle.h"
#include "pipelines/frames/celestial.h"
#include "pipelines/time/utc.h"
#include "services/archive/archive.h"
#include "services/archive/stored_results.h"
#include "tests/integration/archive_fixture.h"
#include "tests/support/matchers.h"

namespace spindrift::archive_products_test {

using testing::attitude_at;
using testing::estimate_at;
using testing::going_on_from;
using testing::pulse_at;
using testing::start_of;
using testing::with_products;

// A few ulps of 360: a product of doubles near 1, converted to degrees.
constexpr double kDegTolerance = 1e-12;

class ArchiveProducts : public testing::ArchiveFixture {};

constexpr std::int64_t kNewYear2017_ns = 1'483'228'837'000'000'000;

SpinMeasurement period_of(std::int64_t revolution) {
  return {.revolution = revolution,
          .quantity = SpinQuantity::Period,
          .value = 0.6,
          .sigma = 1e-4,
          .rejected_by = std::nullopt};
}

SpinFix fix_at(double ra_deg, double dec_deg) {
  const double east_sigma_rad = 0.03 * kRadPerDeg;
  const double north_sigma_rad = 0.04 * kRadPerDeg;
  return {
      .revolution = 12,
      .t = tai_from_ns(1'000'000'000),
      .geometry_case = 3,
      .axis_icrf = direction_icrf({.ra_rad = ra_deg * kRadPerDeg, .dec_rad = dec_deg * kRadPerDeg}),
      .covariance_rad2 =
          Eigen::Vector2d{east_sigma_rad * east_sigma_rad, north_sigma_rad * north_sigma_rad}
              .asDiagonal(),
      .alternates = {},
      .resolution = Resolution::Geometry,
      .norm = 1.0,
      .accepted = true};
}

TEST_F(ArchiveProducts, ProductsOfTwoRunsStandSideBySide) {
  store({with_products(start_of("run-1"), {fix_at(100.0, -55.0)}),
         with_products(start_of("run-2"), {fix_at(100.0, -55.0)})});
  EXPECT_EQ(count("spin_fix WHERE revolution = 12"), 2);
}

TEST_F(ArchiveProducts, AttitudeIsStoredAndComesBackAsItWasButForAnEvenCovariance) {
  AttitudeEstimate without_rate = attitude_at(8, Quality::Ok);
  without_rate.rate_body_rad_s.reset();
  store_run({attitude_at(7, Quality::Doubtful), without_rate});

  EXPECT_EQ(text("SELECT format('%d %s %g %g %g %g', t_tai_ns, source, qx, qy, qz, qw) || format(' "
                 "%g %g %g %.9g %s %s', rate_x_rad_s, rate_y_rad_s, rate_z_rad_s, sigma_deg, "
                 "quality, status) FROM attitude WHERE t_tai_ns = 7"),
            "7 mekf -0.5 0.1 0.7 0.5 0.25 -0.5 1 6 DOUBTFUL DOUBTFUL, many sun samples gated");
  const std::vector<Product> in_force = find_stored_results(path(), "run-1").value().in_force();
  ASSERT_EQ(in_force.size(), 1U);
  const auto& last = std::get<AttitudeEstimate>(in_force[0]);
  EXPECT_EQ(last.t, without_rate.t);
  EXPECT_EQ(last.q_icrf_body.coeffs(), without_rate.q_icrf_body.coeffs());
  EXPECT_FALSE(last.rate_body_rad_s);
  EXPECT_NEAR(last.sigma_rad(), without_rate.sigma_rad(), 1e-15);
  EXPECT_EQ(last.assessment, without_rate.assessment);
}

TEST_F(ArchiveProducts, ARejectedSampleKeepsItsFirstReasonWhenItComesAgain) {
  const RejectedSample fix{.t = tai_from_ns(7),
                           .kind = SampleKind::Star,
                           .rejected_by = Rejection::Innovation,
                           .failed = FailedTest{.value = 40.5, .limit = 31.8}};
  RejectedSample late = fix;
  late.rejected_by = Rejection::Late;
  late.failed.reset();
  RejectedSample sun = late;
  sun.kind = SampleKind::Sun;
  store_run({fix, late, sun});

  EXPECT_EQ(text("SELECT group_concat(format('%d %s %s %g %g %g', t_tai_ns, kind, rejected_by, "
                 "ifnull(squared_innovation, 0), ifnull(value, 0), ifnull(\"limit\", 0)), '; ') "
                 "FROM rejected_sample"),
            "7 star innovation 40.5 40.5 31.8; 7 sun late 0 0 0");
  EXPECT_EQ(text("SELECT group_concat(what || ' ' || name || ' ' || rejected_by || ' ' || "
                 "rejected, '; ') FROM rejection_summary"),
            "sample star innovation 1; sample sun late 1");
  EXPECT_EQ(text("SELECT says FROM rejected_sample_utc WHERE kind = 'star'"),
            "too far from where the estimator expects it, or it expects none there");
}

TEST_F(ArchiveProducts, SpinFixIsStoredInDegreesWithItsCovariance) {
  store_run({fix_at(100.0, -55.0)});

  EXPECT_NEAR(real("SELECT ra_deg FROM spin_fix"), 100.0, kDegTolerance);
  EXPECT_NEAR(real("SELECT dec_deg FROM spin_fix"), -55.0, kDegTolerance);
  EXPECT_NEAR(real("SELECT sigma_deg FROM spin_fix"), 0.05, kDegTolerance);
  EXPECT_NEAR(real("SELECT cov_east_east_deg2 FROM spin_fix"), 0.0009, kDegTolerance);
  EXPECT_NEAR(real("SELECT cov_north_north_deg2 FROM spin_fix"), 0.0016, kDegTolerance);
  EXPECT_EQ(text("SELECT format('%d %d %d %s %g %d', revolution, t_tai_ns, geometry_case, "
                 "resolution, norm, accepted) FROM spin_fix"),
            "12 1000000000 3 GEOMETRY 1 1");
  EXPECT_EQ(count("spin_fix WHERE alternate_ra_deg IS NULL AND alternate_dec_deg IS NULL"), 1);
}

TEST_F(ArchiveProducts, AmbiguousFixKeepsBothCandidates) {
  SpinFix fix = fix_at(100.0, -55.0);
  fix.alternates = {{.axis_icrf = fix_at(310.0, 20.0).axis_icrf}};
  fix.resolution = Resolution::Ambiguous;
  store_run({fix});

  EXPECT_NEAR(real("SELECT alternate_ra_deg FROM spin_fix"), 310.0, kDegTolerance);
  EXPECT_NEAR(real("SELECT alternate_dec_deg FROM spin_fix"), 20.0, kDegTolerance);
  EXPECT_EQ(text("SELECT resolution FROM spin_fix"), "AMBIGUOUS");
}

TEST_F(ArchiveProducts, RightAscensionStaysBelowAFullTurn) {
  ArchiveBatch batch = start_of("run-1");
  for (const double y : {-1e-15, -4.5e-16, -1e-16, -1e-18, -0.0, 0.0, 1e-18}) {
    SpinFix fix = fix_at(0.0, 0.0);
    fix.revolution = static_cast<std::int64_t>(batch.products.size());
    fix.axis_icrf = {1.0, y, 0.0};
    batch.products.emplace_back(fix);
  }
  store(batch);

  EXPECT_EQ(count("spin_fix WHERE ra_deg >= 0 AND ra_deg < 360"), 7);
}

TEST_F(ArchiveProducts, MeasurementsAreStoredInDegreesAndThePeriodInSeconds) {
  store_run({RevolutionProduct{.revolution = 4, .t_sun1 = tai_from_ns(77), .period_s = 0.6},
             period_of(4),
             SpinMeasurement{.revolution = 4,
                             .quantity = SpinQuantity::SunAngle,
                             .value = std::numbers::pi / 3.0,
                             .sigma = std::numbers::pi / 1800.0,
                             .rejected_by = Rejection::SunAngle}});

  EXPECT_EQ(text("SELECT format('%d %d %g', revolution, t_tai_ns, period_s) FROM revolution"),
            "4 77 0.6");
  EXPECT_EQ(text("SELECT group_concat(format('%s %.9g %s %.9g %d %s', quantity, value, unit, "
                 "sigma, accepted, ifnull(rejected_by, '-')), '; ') FROM spin_measurement"),
            "period 0.6 s 0.0001 1 -; sun_angle 60 deg 0.1 0 sun_angle");
}

TEST_F(ArchiveProducts, WhatBecameOfEveryEdgeIsStored) {
  ArchiveBatch batch = start_of("run-1");
  batch.samples.of<Pulse>() = {pulse_at(5, 1), pulse_at(6, 2)};
  batch.products = {PulseUse{.pulse = batch.samples.of<Pulse>()[0].value,
                             .revolution = 3,
                             .rejected_by = std::nullopt},
                    PulseUse{.pulse = batch.samples.of<Pulse>()[1].value,
                             .revolution = std::nullopt,
                             .rejected_by = Rejection::Unassociated}};
  store(batch);

  EXPECT_EQ(
      text("SELECT group_concat(format('%s %d %s %s %d %s', spacecraft_id, t_tai_ns, channel, "
           "ifnull(revolution, '-'), accepted, ifnull(rejected_by, '-')), '; ') FROM pulse_use"),
      "SPINNER 5 sun1 3 1 -; SPINNER 6 sun1 - 0 unassociated");
  EXPECT_EQ(text("SELECT rejected_by || ' ' || source || ' ' || seq FROM rejected_pulse"),
            "unassociated station 2");
}

TEST_F(ArchiveProducts, EstimateIsStoredInDegreesAndTurnsPerMinute) {
  constexpr double kDeg2PerRad2 = 1.0 / (kRadPerDeg * kRadPerDeg);
  store_run({estimate_at(9, SpinEstimator::Mean, 30.0)});

  EXPECT_NEAR(real("SELECT dec_deg FROM spin_estimate"), 30.0, kDegTolerance);
  EXPECT_NEAR(real("SELECT sigma_deg FROM spin_estimate"), 3e-4 / kRadPerDeg, kDegTolerance);
  EXPECT_NEAR(real("SELECT cov_east_north_deg2 FROM spin_estimate"), 1e-8 * kDeg2PerRad2,
              kDegTolerance);
  EXPECT_NEAR(real("SELECT spin_rate_rpm FROM spin_estimate"), 100.0, 1e-12);
  EXPECT_NEAR(real("SELECT sigma_rpm FROM spin_estimate"), 0.01, 1e-12);
}

TEST_F(ArchiveProducts, UtcOfTheViewsIsThatOfFormatUtc) {
  constexpr std::int64_t kSecond_ns = 1'000'000'000;
  std::vector<std::int64_t> times_ns;
  for (const LeapSecond& leap : leap_seconds()) {
    for (const std::int64_t offset_ns : {-kSecond_ns - 1, -kSecond_ns, -kSecond_ns / 2,
                                         std::int64_t{-1}, std::int64_t{0}, kSecond_ns}) {
      times_ns.push_back(tai_ns(leap.start) + offset_ns);
    }
  }
  times_ns.erase(times_ns.begin(), times_ns.begin() + 4);  // UTC before 1972 is not supported.
  std::mt19937_64 rng{1972};
  std::uniform_int_distribution<std::int64_t> until_2040_ns{times_ns.front(),
                                                            2'208'988'800 * kSecond_ns};
  while (times_ns.size() < 1000) {
    times_ns.push_back(until_2040_ns(rng));
  }
  ArchiveBatch batch = start_of("run-1");
  for (const std::int64_t t_tai_ns : times_ns) {
    batch.samples.of<Pulse>().push_back(pulse_at(t_tai_ns));
  }
  store(batch);

  SQLite::Database database = reader();
  SQLite::Statement rows{database, "SELECT t_tai_ns, utc FROM pulse_utc"};
  std::size_t compared = 0;
  while (rows.executeStep()) {
    const std::int64_t t_tai_ns = rows.getColumn(0).getInt64();
    EXPECT_EQ(rows.getColumn(1).getString(), format_utc(tai_from_ns(t_tai_ns), 3)) << t_tai_ns;
    ++compared;
  }
  EXPECT_EQ(compared, times_ns.size());
}

TEST_F(ArchiveProducts, EveryViewOfAPersonHasItsUtc) {
  SpinFix fix = fix_at(100.0, -55.0);
  fix.t = tai_from_ns(kNewYear2017_ns);
  store_run({RevolutionProduct{.revolution = 12, .t_sun1 = fix.t, .period_s = 0.6}, period_of(12),
             fix, estimate_at(kNewYear2017_ns, SpinEstimator::Mean, 1.0)});

  for (const std::string view : {"revolution_utc", "spin_measurement_utc", "spin_fix_utc",
                                 "spin_estimate_utc", "pass_answer"}) {
    EXPECT_EQ(text("SELECT utc FROM " + view), "2017-01-01T00:00:00.000Z") << view;
  }
}

TEST_F(ArchiveProducts, WhatHasNoSun1OrCameInACodedFrameHasItsUtcAllTheSame) {
  const Pulse edge{.t = tai_from_ns(kNewYear2017_ns), .channel = PulseChannel::Sun2};
  store_run({PulseUse{.pulse = edge, .revolution = 12, .rejected_by = Rejection::Unassociated},
             period_of(12)});

  EXPECT_EQ(count("revolution"), 0);
  EXPECT_EQ(count("pulse"), 0);
  for (const std::string view : {"spin_measurement_utc", "rejected_pulse"}) {
    EXPECT_EQ(text("SELECT utc FROM " + view), "2017-01-01T00:00:00.000Z") << view;
  }
}

TEST_F(ArchiveProducts, EstimatesOfALiveRunSayWhenTheyWereStoredAndNoOthers) {
  for (const auto& [run_id, mode] :
       {std::pair{"live", RunMode::Live}, std::pair{"replay", RunMode::Replay}}) {
    ArchiveBatch batch = start_of(run_id);
    batch.start->mode = mode;
    store({batch,
           with_products(testing::batch_of(run_id),
                         {estimate_at(1, SpinEstimator::Mean, 1.0), attitude_at(1, Quality::Ok)})});
  }
  for (const std::string table : {"spin_estimate", "attitude"}) {
    EXPECT_EQ(text("SELECT announced_utc LIKE '20__-__-__T__:__:__.___Z' FROM " + table +
                   " WHERE run_id = 'live'"),
              "1");
    EXPECT_EQ(number("SELECT announced_utc IS NULL FROM " + table + " WHERE run_id = 'replay'"), 1);
  }
}

TEST_F(ArchiveProducts, ResidualsAreLeftOutWhereARunStoresNone) {
  const Observation said{.t = tai_from_ns(1),
                         .source = SampleSource::Star,
                         .residual = {.freedom = 1, .sigma = Eigen::Vector3d::Ones()},
                         .nis = 1.0,
                         .limit = 25.0};
  for (const bool stores_residuals : {true, false}) {
    ArchiveBatch batch = start_of(stores_residuals ? "all" : "without");
    batch.stores_residuals = stores_residuals;
    batch.products = {SampleObservation{.estimator = AttitudeSource::Mekf, .said = said},
                      RejectedSample{.t = tai_from_ns(2),
                                     .kind = SampleKind::Gyro,
                                     .rejected_by = Rejection::Frozen,
                                     .failed = FailedTest{.value = 9.0, .limit = 5.0}},
                      PulseUse{.pulse = {.t = tai_from_ns(3), .channel = PulseChannel::Sun1},
                               .revolution = 1,
                               .said = said}};
    store(batch);
  }
  const auto rows_of = [&](const std::string& table) {
    return texts("SELECT run_id FROM " + table + " ORDER BY run_id");
  };
  EXPECT_THAT(rows_of("sample_residual"), ElementsAre("all", "all"));
  EXPECT_THAT(rows_of("edge_residual"), ElementsAre("all"));
  EXPECT_THAT(rows_of("rejected_sample"), ElementsAre("all", "without"));
  EXPECT_THAT(rows_of("pulse_use"), ElementsAre("all", "without"));
}

TEST_F(ArchiveProducts, NoticeIsStoredOnceHoweverOftenItIsTold) {
  const RunNotice of_then{.t = tai_from_ns(kNewYear2017_ns),
                          .code = "late_edges",
                          .arguments = R"({"edges":3})",
                          .says = "3 edges are late"};
  store_run({of_then, RunNotice{.code = "bad_rows", .arguments = "{}", .says = "bad"}, of_then});

  EXPECT_EQ(text("SELECT group_concat(format('%s %s %s: %s', ifnull(utc, '-'), code, arguments, "
                 "says), '; ') FROM notice_utc"),
            "- bad_rows {}: bad; "
            R"(2017-01-01T00:00:00.000Z late_edges {"edges":3}: 3 edges are late)");
}

TEST_F(ArchiveProducts, CovarianceOfAnAttitudeAndTheBiasOfItsGyroAreInDegrees) {
  AttitudeEstimate estimate = attitude_at(1, Quality::Ok);
  estimate.covariance_rad2(0, 1) = estimate.covariance_rad2(1, 0) = -kRadPerDeg * kRadPerDeg;
  AttitudeEstimate with_bias = estimate;
  with_bias.t = tai_from_ns(2);
  with_bias.gyro_bias = {
      .rad_s = Eigen::Vector3d{1.0, -2.0, 3.0} * kRadPerDeg,
      .covariance_rad2_s2 = 0.25 * kRadPerDeg * kRadPerDeg * Eigen::Matrix3d::Identity()};
  store_run({estimate, with_bias});

  EXPECT_EQ(text("SELECT format('%g %g %g %g %g %g', cov_xx_deg2, cov_xy_deg2, cov_xz_deg2, "
                 "cov_yy_deg2, cov_yz_deg2, cov_zz_deg2) FROM attitude WHERE t_tai_ns = 1"),
            "4 -1 0 16 0 16");
  EXPECT_EQ(text("SELECT group_concat(format('%d %s %g %g %g %g', t_tai_ns, estimator, bx_deg_s, "
                 "by_deg_s, bz_deg_s, sigma_bz_deg_s)) FROM gyro_bias"),
            "2 mekf 1 -2 3 0.5");
}

TEST_F(ArchiveProducts, TwoArchivesMergeByNaturalKey) {
  const std::filesystem::path other = directory() / "other.db";
  for (const auto& [name, run_id, first_ns] :
       {std::tuple{path(), "run-1", 0}, std::tuple{other, "run-2", 5}}) {
    ArchiveBatch batch = with_products(start_of(run_id), {fix_at(100.0, -55.0)});
    for (int i = 0; i < 10; ++i) {
      batch.samples.of<Pulse>().push_back(pulse_at(first_ns + i));
    }
    const auto archive = value_or_throw(Archive::open(name, {}));
    commit(*archive, batch);
    ASSERT_TRUE(archive->close());
  }

  SQLite::Database database{path().string(), SQLite::OPEN_READWRITE};
  database.exec("PRAGMA foreign_keys = ON; ATTACH '" + other.string() + "' AS other");
  for (const std::string table : {"spacecraft", "run", "pulse", "spin_fix"}) {
    database.exec(fmt::format("INSERT OR IGNORE INTO {0} SELECT * FROM other.{0}", table));
  }
  EXPECT_EQ(count("pulse"), 15);
  EXPECT_EQ(count("spin_fix"), 2);
}

/// Returns the solution of a pass that ends at `t_tai_ns`.
BatchSolution solution_at(std::int64_t t_tai_ns, std::vector<BiasEstimate> biases = {}) {
  return {.estimate = estimate_at(t_tai_ns, SpinEstimator::Batch, 0.0),
          .drift_rad_s2 = 1e-6,
          .drift_sigma_rad_s2 = 1e-8,
          .bound_rad = 1e-4,
          .biases = std::move(biases),
          .undetermined = {},
          .singular_values = {},
          .changed = {},
          .edges = 100,
          .outliers = 0,
          .noise = 1.0,
          .iterations = 5,
          .nutation = {},
          .nutation_t = tai_from_ns(t_tai_ns),
          .coning = {}};
}

ArchiveBatch with_solution(BatchSolution solution) {
  return with_products(testing::batch_of("run-1"),
                       {std::make_shared<const BatchSolution>(std::move(solution))});
}

TEST_F(ArchiveProducts, BiasesAreThoseOfTheLastSolutionAndSayWhetherTheyAreInTheAxis) {
  const BiasEstimate chord{NorthChordBias, 0.01, 0.001, true, true};
  const BiasEstimate dihedral{DihedralBias, 0.01, 0.001, true, false};
  const auto archive = open();
  commit(*archive, start_of("run-1"));
  const auto after = [&](const ArchiveBatch& batch) {
    commit(*archive, batch);
    return text(
        "SELECT ifnull(group_concat(format('%s %d', name, estimated), '; '), '') FROM spin_bias");
  };
  EXPECT_EQ(after(with_solution(solution_at(100, {chord, dihedral}))), "dihedral 0; north_chord 1");
  EXPECT_EQ(after(with_solution(solution_at(200, {dihedral}))), "dihedral 0");
  EXPECT_EQ(after(with_solution(solution_at(150, {chord}))), "dihedral 0");
  EXPECT_EQ(after(going_on_from(201)), "dihedral 0");
  EXPECT_EQ(after(going_on_from(200)), "");
}

TEST_F(ArchiveProducts, ResidualsOfBatchGoWithTheirSolutionAllTogether) {
  const auto with_residuals = [](std::int64_t t_tai_ns) {
    BatchSolution solution = solution_at(t_tai_ns);
    for (std::int64_t t = 10; t <= t_tai_ns; t += 10) {
      solution.said.push_back({.pulse = {.t = tai_from_ns(t), .channel = PulseChannel::Sun1},
                               .residual_s = 1e-5,
                               .sigma_s = 1e-4,
                               .used = true});
    }
    return with_solution(std::move(solution));
  };
  const auto archive = open();
  commit(*archive, start_of("run-1"));
  const auto after = [&](const ArchiveBatch& batch) {
    commit(*archive, batch);
    return count("batch_residual");
  };
  EXPECT_EQ(after(with_residuals(100)), 10);
  EXPECT_EQ(after(going_on_from(101)), 10);
  EXPECT_EQ(after(going_on_from(50)), 0);
  EXPECT_EQ(after(with_residuals(60)), 6);
  // A solution during the pass has no residuals to store.
  EXPECT_EQ(after(with_solution(solution_at(120))), 0);
}

TEST_F(ArchiveProducts, TheChoiceOfARunIsThatOfBatchUntilItIsMadeAgain) {
  const auto archive = open();
  commit(*archive, start_of("run-1"));
  const auto after = [&](const ArchiveBatch& batch) {
    commit(*archive, batch);
    return text(
        "SELECT ifnull(group_concat(format('%s %d', estimator, t_tai_ns)), '') FROM axis_choice");
  };
  const auto made = [](std::int64_t t_tai_ns, SpinEstimator estimator) {
    return with_products(testing::batch_of("run-1"),
                         {AxisChoice{.t = tai_from_ns(t_tai_ns),
                                     .estimator = estimator,
                                     .axis_icrf = Eigen::Vector3d::UnitX(),
                                     .other_icrf = {},
                                     .delta_chi_square = {},
                                     .settled_by = SettledBy::Geometry}});
  };
  EXPECT_EQ(after(made(90, SpinEstimator::Mean)), "mean 90");
  EXPECT_EQ(after(made(100, SpinEstimator::Batch)), "batch 100");
  EXPECT_EQ(after(made(200, SpinEstimator::Sequential)), "batch 100");
  EXPECT_EQ(after(made(300, SpinEstimator::Batch)), "batch 300");
  EXPECT_EQ(after(going_on_from(200)), "");
  EXPECT_EQ(after(made(200, SpinEstimator::Sequential)), "sequential 200");
}

TEST_F(ArchiveProducts, NormalEquationsOfARunAreThoseOfItsLastSolution) {
  const auto archive = open();
  commit(*archive, start_of("run-1"));
  const auto after = [&](const ArchiveBatch& batch) {
    commit(*archive, batch);
    return text(
        "SELECT ifnull(group_concat(t_tai_ns || ' ' || names || ' ' || b0 || ' ' || n || ' ' || "
        "g), '') FROM "
        "normal_equations");
  };
  const auto told = [](std::int64_t t_tai_ns, double mount_angle_deg) {
    Eigen::Matrix2d information;
    information << 4.0, 0.5, 0.25, 0.1;  // Not symmetric, so that rows and columns differ.
    return with_products(
        testing::batch_of("run-1"),
        {NormalEquations{.t = tai_from_ns(t_tai_ns),
                         .names = {"spin.ir.north.mount_angle_deg", "spin.alignment.time_tag_s"},
                         .b0 = Eigen::Vector2d{mount_angle_deg, 0.0},
                         .n = information,
                         .g = Eigen::Vector2d{-1.0, 1e-300}}});
  };
  const auto stored = [](std::string_view t_tai_ns, std::string_view mount_angle_deg) {
    return fmt::format(R"({} ["spin.ir.north.mount_angle_deg","spin.alignment.time_tag_s"] )"
                       "[{},0.0] [4.0,0.5,0.25,0.1] [-1.0,1e-300]",
                       t_tai_ns, mount_angle_deg);
  };
  EXPECT_EQ(after(told(100, 85.0)), stored("100", "85.0"));
  EXPECT_EQ(after(told(200, 85.5)), stored("200", "85.5"));
  EXPECT_EQ(after(told(150, 85.0)), stored("200", "85.5"));
  EXPECT_EQ(after(going_on_from(200)), "");
}

TEST_F(ArchiveProducts, BiasThatIsNotObservableHasNoValue) {
  store({start_of("run-1"),
         with_solution(solution_at(100, {{NorthChordBias, 0.0, 0.001, false, true}}))});
  EXPECT_EQ(text("SELECT ifnull(value, 'none') FROM spin_bias"), "none");
}

}  // namespace spindrift::archive_products_test
