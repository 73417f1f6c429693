#include <algorithm>
#include <cstdint>
#include <optional>

#include "pipelines/frames/angle.h"
#include "pipelines/frames/rotation_vector.h"
#include "pipelines/reconstruction/separation.h"
#include "tests/support/low_orbit.h"
#include "tests/support/matchers.h"
#include "tests/support/outcome.h"
#include "tests/support/recorded_separation.h"
#include "tests/support/separation_flight.h"

namespace spindrift::testing::reconstruct_test {

using enum SeparationEvent;
using Eigen::Quaterniond;
using Eigen::Vector3d;

Reconstruction batch(const ReconstructionRequest& request) {
  return value_or_throw(reconstruct(request, ReconstructionMethod::Batch));
}

Reconstruction sequential(const ReconstructionRequest& request) {
  return value_or_throw(reconstruct(request, ReconstructionMethod::Sequential));
}

const ReconstructedEvent& at(const Reconstruction& found, SeparationEvent event) {
  return *find(found, event);
}

double sigma_rad(const ReconstructedEvent& event) { return event.attitude.sigma_rad(); }

/// Counts the samples of a source with this rejection (empty: used). Rejected ones must exceed
/// their limit.
std::int64_t count(const Reconstruction& found, SampleSource source,
                   std::optional<Rejection> rejected_by) {
  return std::ranges::count_if(found.said, [&](const Observation& said) {
    const double value = source == SampleSource::Gyro ? said.residual.value[0] : said.nis;
    EXPECT_TRUE(said.source != source || (value > said.limit) == said.rejected_by.has_value());
    return said.source == source && said.rejected_by == rejected_by;
  });
}

/// Returns the error in sigmas, from three degrees of freedom.
double normalised(const Vector3d& error_rad, const ReconstructedEvent& event) {
  return std::sqrt(error_rad.dot(event.attitude.covariance_rad2.llt().solve(error_rad)));
}

double sigmas_off(const SeparationFlight& flight, const Reconstruction& found,
                  SeparationEvent event = Separation) {
  const ReconstructedEvent& it = at(found, event);
  return normalised(flight.error_rad(static_cast<std::size_t>(event), it.attitude.q_icrf_body), it);
}

double apart_rad(const Reconstruction& one, const Reconstruction& other,
                 SeparationEvent event = Separation) {
  return angle_between_rad(at(one, event).attitude.q_icrf_body,
                           at(other, event).attitude.q_icrf_body);
}

Vector3d error_rad(const RecordedSeparation& pass, const Reconstruction& found,
                   SeparationEvent event, const char* name) {
  return rotation_vector_of(at(found, event).attitude.q_icrf_body.conjugate() *
                            pass.truth.at(name).q_icrf_body);
}

/// Expects the attitude at separation within this limit and three sigmas.
void expect_separation(const RecordedSeparation& pass, const Reconstruction& found,
                       double limit_deg) {
  const Vector3d error = error_rad(pass, found, Separation, "T1");
  EXPECT_LT(degrees(error.norm()), limit_deg);
  EXPECT_LT(normalised(error, at(found, Separation)), 3.0);
}

TEST(ReconstructBatch, FindsTheRecordedSeparationWithinItsSigma) {
  const RecordedSeparation pass = recorded_separation("separation");
  const Reconstruction found = batch(pass.request());
  for (const auto& [event, name] : {std::pair{Separation, "T1"}, std::pair{ControlOn, "T2"},
                                    std::pair{Acquisition, "T3"}, std::pair{FirstStarFix, "T4"}}) {
    const Vector3d error = error_rad(pass, found, event, name);
    EXPECT_LT(degrees(error.norm()), 0.8) << name;
    EXPECT_LT(normalised(error, at(found, event)), 3.0) << name;
    EXPECT_LT(degrees(sigma_rad(at(found, event))), 1.5) << name;
    EXPECT_FALSE(at(found, event).found);
  }
  EXPECT_EQ(found.assessment.quality, Quality::Ok);
  EXPECT_EQ(found.sun.count, 223);
  EXPECT_NEAR(found.sun.noise.value(), 1.0, 0.15);
  EXPECT_NEAR(found.gyro.noise.value(), 1.0, 0.15);
}

TEST(ReconstructBatch, FindsTheTimesThatNobodyNamed) {
  RecordedSeparation pass = recorded_separation("separation");
  const SeparationTimes named = pass.times;
  pass.times = {.separation = named.separation};
  const Reconstruction found = batch(pass.request());
  EXPECT_EQ(at(found, ControlOn).attitude.t, named.control_on);
  EXPECT_EQ(at(found, Acquisition).attitude.t, named.acquisition);
  EXPECT_EQ(at(found, FirstStarFix).attitude.t, named.first_star_fix);
  EXPECT_TRUE(at(found, ControlOn).found);
  EXPECT_FALSE(at(found, Separation).found);
}

TEST(ReconstructBatch, TakesTimesThatAreEqual) {
  SeparationFlight flight = separation_flight({}, 2);
  flight.times.separation = flight.times.first_star_fix.value();
  flight.times.control_on = flight.times.acquisition = flight.times.first_star_fix;
  flight.gyro.push_back(flight.gyro.back());
  flight.gyro.back().t = shifted(flight.gyro.back().t, 0.25);
  flight.gyro.back().rate_body_rad_s.x() += 1e-5;
  for (const auto method : {ReconstructionMethod::Batch, ReconstructionMethod::Sequential}) {
    const auto found = value_or_throw(reconstruct(flight.request(), method));
    EXPECT_EQ(found.events.size(), 4U);
    EXPECT_EQ(found.history.size(), 1U);
    EXPECT_LT(normalised(flight.error_rad(3, at(found, Separation).attitude.q_icrf_body),
                         at(found, Separation)),
              4.0);
  }
}

// The rates of these flights have less noise than stated and no bias.
TEST(ReconstructBatch, FindsJunoAndDawn) {
  for (const auto& [name, limit_deg] : {std::pair{"juno", 0.01}, std::pair{"dawn-2015", 0.05}}) {
    SCOPED_TRACE(name);
    const RecordedSeparation pass = recorded_separation(name);
    const Reconstruction found = batch(pass.request());
    expect_separation(pass, found, limit_deg);
    EXPECT_LT(degrees(at(found, Separation).attitude.noise_sigma_rad()), 1.0);
    EXPECT_NE(found.assessment.quality, Quality::Doubtful);
  }
}

TEST(ReconstructSequential, FindsTheFlights) {
  for (const auto& [name, limit_deg] :
       {std::pair{"separation", 4.0}, std::pair{"juno", 0.01}, std::pair{"dawn-2015", 0.05}}) {
    SCOPED_TRACE(name);
    const RecordedSeparation pass = recorded_separation(name);
    const Reconstruction found = sequential(pass.request());
    expect_separation(pass, found, limit_deg);
    EXPECT_FALSE(found.bias);
  }
}

/// One vector does not determine the rotation about itself; a wrong update would add up over
/// hundreds.
TEST(ReconstructSequential, TurnsNothingAboutTheSun) {
  const SeparationFlight flight =
      separation_flight({.gyro_noise_deg_s = 1e-5, .bias_sigma_deg_s = 1e-5}, 3);
  const Reconstruction found = sequential(flight.request());
  const ReconstructedEvent& acquisition = at(found, Acquisition);
  const Vector3d error_rad = flight.error_rad(2, acquisition.attitude.q_icrf_body);
  EXPECT_LT(degrees(std::abs(error_rad.dot(flight.sun.front().sun_body))), 0.1);
  EXPECT_LT(normalised(error_rad, acquisition), 3.5);
}

TEST(ReconstructBatch, ConvergesInFewIterationsHoweverManyNodes) {
  ReconstructionRequest request =
      separation_flight({.first_star_fix_s = 660.0, .end_s = 660.0}, 4).request();
  const int few = batch(request).iterations;
  request.node_at_every_gyro_sample = true;
  EXPECT_LE(batch(request).iterations, few + 1);
  EXPECT_LT(few, 20);
}

TEST(ReconstructBatch, ANodeAtEverySampleChangesNoEvent) {
  const RecordedSeparation pass = recorded_separation("separation");
  ReconstructionRequest request = pass.request();
  const Reconstruction few = batch(request);
  request.node_at_every_gyro_sample = true;
  const Reconstruction many = batch(request);
  EXPECT_GT(many.history.size(), few.history.size() + 600);
  for (const SeparationEvent event : {Separation, ControlOn, Acquisition, FirstStarFix}) {
    const double off_rad = apart_rad(few, many, event);
    EXPECT_LT(off_rad, 1e-3 * sigma_rad(at(few, event)));
    EXPECT_NEAR(sigma_rad(at(many, event)), sigma_rad(at(few, event)),
                1e-3 * sigma_rad(at(few, event)));
  }
}

TEST(ReconstructBatch, SurvivesSunOutliers) {
  SeparationFlight flight = separation_flight({}, 5);
  const Reconstruction clean = batch(flight.request());
  for (std::size_t i = 0; i < flight.sun.size(); i += 12) {
    flight.sun[i].sun_body = quaternion_by({0.0, 0.4, -0.9}) * flight.sun[i].sun_body;
  }
  const Reconstruction dirty = batch(flight.request());
  EXPECT_EQ(dirty.sun.outliers, 19);
  EXPECT_LT(apart_rad(clean, dirty), 0.5 * sigma_rad(at(clean, Separation)));
  EXPECT_TRUE(has(dirty.assessment, ReasonCode::SunOutliers));
}

TEST(ReconstructBatch, BridgesGapsWithAWiderSigma) {
  SeparationFlight flight = separation_flight({}, 6);
  const Reconstruction whole = batch(flight.request());
  flight.gyro.erase(flight.gyro.begin() + 20, flight.gyro.begin() + 60);
  const Reconstruction gap = batch(flight.request());
  EXPECT_TRUE(has(gap.assessment, ReasonCode::GyroGaps));
  EXPECT_GT(sigma_rad(at(gap, ControlOn)), sigma_rad(at(whole, ControlOn)));
  EXPECT_LT(sigmas_off(flight, gap), 3.5);
}

TEST(ReconstructBatch, HoldsTheFirstRateBackToControlOnWithAWiderSigma) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    SeparationFlight flight = separation_flight({}, seed);
    const double whole_rad = sigma_rad(at(batch(flight.request()), Separation));
    flight.gyro.erase(flight.gyro.begin(), flight.gyro.begin() + 2);
    const Reconstruction held = batch(flight.request());
    EXPECT_GT(sigma_rad(at(held, Separation)), whole_rad);
    EXPECT_LT(sigmas_off(flight, held), 3.0);
  }
}

TEST(ReconstructBatch, LeavesOutFrozenAndSaturatedSamples) {
  SeparationFlight flight = separation_flight({}, 7);
  for (std::size_t i = 401; i < 420; ++i) {
    flight.gyro[i].rate_body_rad_s = flight.gyro[400].rate_body_rad_s;
  }
  flight.sensors.gyro->range_rad_s = 0.1;
  flight.gyro[500].rate_body_rad_s.x() = 0.1;
  const Reconstruction found = batch(flight.request());
  EXPECT_EQ(found.gyro.outliers, 20);
  EXPECT_EQ(count(found, SampleSource::Gyro, Rejection::Frozen), 19);
  EXPECT_EQ(count(found, SampleSource::Gyro, Rejection::Saturated), 1);
  EXPECT_EQ(count(sequential(flight.request()), SampleSource::Gyro, Rejection::Frozen), 19);
  EXPECT_TRUE(has(found.assessment, ReasonCode::GyroFrozen));
  EXPECT_TRUE(has(found.assessment, ReasonCode::GyroSaturated));
  EXPECT_EQ(found.assessment.quality, Quality::Doubtful);
  EXPECT_LT(sigmas_off(flight, found), 3.5);
}

/// T1 depends on the first sample, which may be zero after switching the gyro on, or a spike.
TEST(ReconstructBatch, ABadFirstRateDoesNotMoveSeparation) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const SeparationFlight flight = separation_flight({}, seed);
    const double clean_rad = sigma_rad(at(batch(flight.request()), Separation));
    const auto check = [&](const SeparationFlight& spoilt) {
      const Reconstruction found = batch(spoilt.request());
      EXPECT_EQ(found.assessment.quality, Quality::Doubtful);
      EXPECT_TRUE(has(found.assessment, ReasonCode::GyroOutliers));
      EXPECT_GT(sigma_rad(at(found, Separation)), clean_rad);
      EXPECT_LT(sigmas_off(flight, found), 3.5);
    };
    for (const std::size_t zeros : {1U, 2U, 3U, 4U}) {
      SCOPED_TRACE(zeros);
      SeparationFlight spoilt = flight;
      for (std::size_t i = 0; i < zeros; ++i) {
        spoilt.gyro[i].rate_body_rad_s.setZero();
      }
      check(spoilt);
    }
    SeparationFlight spoilt = flight;
    spoilt.gyro[0].rate_body_rad_s.z() += 0.1 * kRadPerDeg;
    check(spoilt);
  }
}

TEST(ReconstructBatch, ASpikeOfTheGyroMovesNothing) {
  SeparationFlight flight = separation_flight({}, 16);
  const Reconstruction clean = batch(flight.request());
  flight.gyro[500].rate_body_rad_s.y() += 10.0 * kRadPerDeg;
  const Reconstruction found = batch(flight.request());
  EXPECT_TRUE(has(found.assessment, ReasonCode::GyroOutliers));
  EXPECT_EQ(found.assessment.quality, Quality::Ok);
  EXPECT_LT(apart_rad(found, clean), 0.1 * sigma_rad(at(clean, Separation)));
}

/// The bias drifts by 0.005 deg/s in the first hour, so the later bias differs from that at T1.
TEST(ReconstructBatch, ABiasThatDriftsForAnHourBehindTheFirstFixDoesNotMoveSeparation) {
  for (std::uint64_t seed = 17; seed <= 19; ++seed) {
    SeparationFlight flight = separation_flight({.star_fix_step_s = 10.0, .end_s = 3600.0}, seed);
    for (GyroSample& sample : flight.gyro) {
      const double share = seconds_between(flight.times.separation, sample.t) / 3600.0;
      sample.rate_body_rad_s += Vector3d{0.005, -0.005, 0.005} * kRadPerDeg * share;
    }
    const Reconstruction found = batch(flight.request());
    const Quaterniond& q_icrf_body = at(found, Separation).attitude.q_icrf_body;
    EXPECT_LT(sigmas_off(flight, found), 3.5) << seed;
    EXPECT_LT(degrees(flight.error_rad(0, q_icrf_body).norm()), 0.8) << seed;
  }
}

TEST(ReconstructBatch, SamplesBeforeSeparationAndLongBehindTheFixChangeNothing) {
  SeparationFlight flight = separation_flight({.star_fix_step_s = 10.0, .end_s = 1000.0}, 20);
  flight.times.control_on.reset();
  flight.times.acquisition.reset();
  flight.times.first_star_fix.reset();
  const Reconstruction expected = batch(flight.request());
  const auto add = [&](auto& samples, double by_s) {
    const auto first = samples.front();
    for (const auto& sample : std::vector(samples)) {
      samples.push_back(sample);
      samples.back().t = shifted(sample.t, by_s);
    }
    samples.push_back(first);
  };
  for (const double by_s : {-2000.0, 2000.0}) {
    SeparationFlight more = flight;
    add(more.gyro, by_s);
    add(more.sun, by_s);
    add(more.stars, by_s);
    const Reconstruction found = batch(more.request());
    ASSERT_EQ(found.history.size(), expected.history.size());
    for (std::size_t i = 0; i < found.history.size(); ++i) {
      ASSERT_EQ(found.history[i].q_icrf_body.coeffs(), expected.history[i].q_icrf_body.coeffs());
      ASSERT_EQ(found.history[i].covariance_rad2, expected.history[i].covariance_rad2);
    }
    EXPECT_EQ(found.assessment, expected.assessment);
  }
}

TEST(ReconstructBatch, DoubtsStarFixesOfWhichAThirdAreGated) {
  SeparationFlight flight = separation_flight({.star_fix_step_s = 5.0, .end_s = 340.0}, 21);
  ASSERT_EQ(flight.stars.size(), 9U);
  for (std::size_t i = 0; i < 4; ++i) {
    flight.stars[i].q_icrf_sensor = quaternion_by({0.3, 0.0, 0.1}) * flight.stars[i].q_icrf_sensor;
  }
  const Reconstruction found = batch(flight.request());
  EXPECT_EQ(found.star.outliers, 4);
  EXPECT_EQ(found.assessment.quality, Quality::Doubtful);
  EXPECT_LT(sigmas_off(flight, found, FirstStarFix), 3.5);
}

TEST(ReconstructBatch, StarNoiseBeyondTheStatedIsInTheSigma) {
  SeparationFlight flight =
      separation_flight({.star_fix_step_s = 15.0, .end_s = 420.0, .star_noise_arcsec = 60.0}, 22);
  flight.sensors.star_tracker->noise_rad /= 3.0;
  const Reconstruction found = batch(flight.request());
  EXPECT_TRUE(has(found.assessment, ReasonCode::SensorNoise));
  EXPECT_GT(sigma_rad(at(found, FirstStarFix)), 1.5 * at(found, FirstStarFix).bound_rad.value());
}

TEST(ReconstructSequential, TakesTheSunNoiseThatIsSeen) {
  SeparationFlight flight = separation_flight({.sun_noise_deg = 2.0}, 23);
  flight.sensors.sun_sensor->noise_rad /= 4.0;
  const Reconstruction found = sequential(flight.request());
  EXPECT_LT(sigmas_off(flight, found, ControlOn), 3.5);
  EXPECT_LT(found.sun.outliers, 5);
}

TEST(ReconstructBatch, UsesAllStarFixesButThoseFarOff) {
  SeparationFlight flight = separation_flight({.star_fix_step_s = 5.0, .end_s = 400.0}, 8);
  ASSERT_EQ(flight.stars.size(), 21U);
  const Reconstruction clean = batch(flight.request());
  SeparationFlight first_only = flight;
  first_only.stars.resize(1);
  EXPECT_LT(sigma_rad(at(clean, Separation)),
            sigma_rad(at(batch(first_only.request()), Separation)));
  flight.stars[0].q_icrf_sensor = flight.stars[0].q_icrf_sensor * quaternion_by({0.5, 0.0, 0.0});
  const Reconstruction dirty = batch(flight.request());
  EXPECT_EQ(dirty.star.outliers, 1);
  EXPECT_EQ(count(dirty, SampleSource::Star, Rejection::Innovation), 1);
  EXPECT_EQ(count(dirty, SampleSource::Star, std::nullopt), 20);
  const Reconstruction backwards = sequential(flight.request());
  EXPECT_EQ(count(backwards, SampleSource::Star, Rejection::Innovation), 1);
  EXPECT_EQ(count(backwards, SampleSource::Star, std::nullopt), 1);
  EXPECT_TRUE(has(dirty.assessment, ReasonCode::StarFixesGated));
  EXPECT_LT(sigmas_off(flight, dirty, FirstStarFix), 3.5);
}

TEST(ReconstructBatch, OrderRepetitionAndSignOfSamplesChangeNothing) {
  SeparationFlight flight = separation_flight({.star_fix_step_s = 10.0, .end_s = 350.0}, 9);
  const Reconstruction expected = batch(flight.request());
  std::ranges::reverse(flight.gyro);
  flight.gyro.insert(flight.gyro.begin() + 7, flight.gyro[7]);
  std::ranges::reverse(flight.sun);
  flight.stars[2].q_icrf_sensor.coeffs() *= -1.0;
  const Reconstruction found = batch(flight.request());
  EXPECT_LT(apart_rad(found, expected), 1e-9);
}

TEST(ReconstructBatch, EstimatesAMisalignmentOfTheSunSensorWithItsPrior) {
  const Vector3d misalignment{0.01, -0.015, 0.0};
  SeparationFlight flight =
      separation_flight({.star_fix_step_s = 1.0, .end_s = 500.0, .sun_noise_deg = 0.1}, 10);
  for (SunDirection& sun : flight.sun) {
    sun.sun_body = quaternion_by(misalignment) * sun.sun_body;
  }
  ReconstructionRequest request = flight.request();
  request.sensors.alignment.diagonal().segment<3>(SunSensorError).setConstant(0.02 * 0.02);
  const Reconstruction found = batch(request);
  const Vector3d off = found.misalignment->vector_rad - misalignment;
  EXPECT_LT(std::sqrt(off.dot(found.misalignment->covariance_rad2.llt().solve(off))), 3.5);
  EXPECT_LT(off.head<2>().norm(), 0.002);
}

TEST(Reconstruct, DoubtsASunSensorThatIsFurtherOffThanTheMissionFileAllows) {
  const SeparationFlight sound =
      separation_flight({.star_fix_step_s = 5.0, .end_s = 420.0, .sun_noise_deg = 0.1}, 24);
  const auto reconstructed = [&](double off_deg, ReconstructionMethod method) {
    ReconstructionRequest request = sound.request();
    request.sensors.alignment.diagonal()
        .segment<3>(SunSensorError)
        .setConstant(std::pow(0.2 * kRadPerDeg, 2));
    for (SunDirection& sun : request.sun_directions) {
      sun.sun_body =
          quaternion_by(off_deg * kRadPerDeg * Vector3d{0.6, -0.64, 0.48}) * sun.sun_body;
    }
    return value_or_throw(reconstruct(request, method)).assessment;
  };
  for (const auto method : {ReconstructionMethod::Batch, ReconstructionMethod::Sequential}) {
    EXPECT_EQ(reconstructed(0.3, method).quality, Quality::Ok);
    const Assessment far = reconstructed(2.0, method);
    EXPECT_EQ(far.quality, Quality::Doubtful);
    const auto reason = std::ranges::find(far.reasons, ReasonCode::AlignmentOff, &Reason::code);
    ASSERT_NE(reason, far.reasons.end());
    EXPECT_EQ(std::get<std::string>(reason->values.at(0).value),
              "three_axis.alignment.sun_sensor_deg");
    EXPECT_NEAR(std::get<double>(reason->values.at(1).value), 10.0, 2.0);
  }
}

TEST(ReconstructBatch, NamesTheBiasThatIsOpen) {
  SeparationFlight flight = separation_flight({}, 11);
  // After acquisition the Sun is constant in body axes.
  flight.sun.erase(flight.sun.begin(), flight.sun.begin() + 120);
  const Reconstruction found = batch(flight.request());
  ASSERT_FALSE(found.open_bias.empty());
  EXPECT_TRUE(has(found.assessment, ReasonCode::GyroBiasOpenBySun));
  EXPECT_LT(degrees(found.open_bias.front().off_sun_rad.value()), 20.0);
}

TEST(ReconstructBatch, SaysThatNothingChecksOneStarFixAlone) {
  SeparationFlight flight = separation_flight({}, 12);
  flight.sun.clear();
  flight.times.acquisition.reset();
  const Reconstruction found = batch(flight.request());
  EXPECT_EQ(found.assessment.quality, Quality::Converging);
  EXPECT_EQ(find(found, Acquisition), nullptr);
}

TEST(ReconstructBatch, SaysThatTheRateIsConstantWhereTheInertiaIsUnknown) {
  SeparationFlight flight = separation_flight({}, 13);
  flight.sensors.inertia.reset();
  const Reconstruction found = batch(flight.request());
  EXPECT_TRUE(has(found.assessment, ReasonCode::ConstantRate));
  EXPECT_LT(sigmas_off(flight, found), 3.0);
}

TEST(ReconstructBatch, InertiaAndDisturbanceWidenOnlyTheArc) {
  SeparationFlight flight = separation_flight({}, 14);
  const Reconstruction known = batch(flight.request());
  flight.sensors.inertia->sigma_fraction = 0.2;
  ReconstructionRequest request = flight.request();
  request.disturbance_rad_s2 = 1e-5;
  const Reconstruction unknown = batch(request);
  EXPECT_GT(sigma_rad(at(unknown, Separation)), 1.5 * sigma_rad(at(known, Separation)));
  EXPECT_EQ(sigma_rad(at(unknown, ControlOn)), sigma_rad(at(known, ControlOn)));
}

TEST(ReconstructBatch, LeavesOutSunVectorsInTheShadow) {
  SeparationFlight flight = separation_flight({}, 15);
  std::int64_t shadowed = 0;
  for (int i = 0; i < 6; ++i) {
    ReconstructionRequest request = flight.request();
    request.orbit = low_orbit(flight.times.separation, i * 60.0 * kRadPerDeg);
    const Reconstruction found = batch(request);
    const auto missing = static_cast<std::int64_t>(flight.sun.size()) - found.sun.count;
    EXPECT_EQ(missing > 0, has(found.assessment, ReasonCode::SunVectorsShadowed));
    shadowed += missing;
  }
  EXPECT_GT(shadowed, 200);
  EXPECT_LT(shadowed, 800);
}

}  // namespace spindrift::testing::reconstruct_test
