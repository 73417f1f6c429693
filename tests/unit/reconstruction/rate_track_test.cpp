#include "pipelines/reconstruction/rate_track.h"

#include "pipelines/frames/rotation_vector.h"
#include "tests/support/matchers.h"

namespace spindrift::rate_track_test {

using Eigen::Matrix3d;
using Eigen::Quaterniond;
using Eigen::Vector3d;

constexpr double kNoise_rad_s = 3.5e-5;

Vector3d smooth_rate(double t_s) {
  return {0.2 * std::sin(0.7 * t_s), 0.1 + 0.05 * std::cos(1.1 * t_s), -0.3 + 0.02 * t_s};
}

std::vector<TimedRate> samples_at(double step_s, int count,
                                  const std::function<Vector3d(double)>& rate = smooth_rate) {
  std::vector<TimedRate> samples;
  for (int i = 0; i < count; ++i) {
    samples.push_back({i * step_s, rate(i * step_s)});
  }
  return samples;
}

RateTrack track_of(std::vector<TimedRate> samples) {
  const double end_s = samples.back().t_s;
  return {std::move(samples), 0.0, end_s, kNoise_rad_s};
}

Turn whole(const RateTrack& track, const Vector3d& bias = Vector3d::Zero()) {
  const std::vector<double> ends{track.samples().front().t_s, track.samples().back().t_s};
  return track.turns(ends, bias).front();
}

/// Returns the difference from the rotation integrated with the track's rate in small steps.
double error_rad(const RateTrack& track) {
  constexpr int kSteps = 20'000;
  const double step_s = track.samples().back().t_s / kSteps;
  Quaterniond expected = Quaterniond::Identity();
  for (int i = 0; i < kSteps; ++i) {
    expected = expected * quaternion_by(step_s * track.rate_at((i + 0.5) * step_s));
  }
  return angle_between_rad(whole(track).turn, expected.normalized());
}

TEST(RateTrack, TurnsAsTheRateThatIsLinearBetweenSamplesToTheFourthOrder) {
  const double coarse_rad = error_rad(track_of(samples_at(0.5, 21)));
  const double fine_rad = error_rad(track_of(samples_at(0.25, 41)));
  EXPECT_LT(coarse_rad, 1e-5);
  EXPECT_LT(fine_rad, coarse_rad / 12.0);
}

TEST(RateTrack, IsTheSameHoweverItIsCut) {
  const RateTrack track = track_of(samples_at(0.25, 41));
  const std::vector<double> cuts{0.0, 0.1, 0.25, 3.333, 3.334, 7.75, 10.0};
  Quaterniond q = Quaterniond::Identity();
  Matrix3d covariance = Matrix3d::Zero();
  Matrix3d per_bias = Matrix3d::Zero();
  for (const Turn& turn : track.turns(cuts, Vector3d::Zero())) {
    const Matrix3d back = turn.turn.toRotationMatrix().transpose();
    q = q * turn.turn;
    covariance = back * covariance * back.transpose() + turn.covariance_rad2;
    per_bias = back * per_bias + turn.per_bias_s;
  }
  const Turn all = whole(track);
  EXPECT_LT(angle_between_rad(q, all.turn), 1e-6);
  EXPECT_LT((covariance - all.covariance_rad2).norm(), 1e-3 * all.covariance_rad2.norm());
  EXPECT_LT((per_bias - all.per_bias_s).norm(), 1e-3 * all.per_bias_s.norm());
}

TEST(RateTrack, SlopesByTheBiasAreThoseOfTheTurn) {
  const RateTrack track = track_of(samples_at(0.5, 61));
  const Vector3d bias{0.001, -0.002, 0.003};
  constexpr double kStep = 1e-6;
  const Turn turn = whole(track, bias);
  for (int i = 0; i < 3; ++i) {
    const Vector3d step = kStep * Vector3d::Unit(i);
    const Vector3d numeric = rotation_vector_of(whole(track, bias - step).turn.conjugate() *
                                                whole(track, bias + step).turn) /
                             (2.0 * kStep);
    EXPECT_LT((turn.per_bias_s.col(i) - numeric).norm(), 1e-7 * turn.per_bias_s.norm());
  }
}

/// The gyro measures (1 + M) times the true rate.
TEST(RateTrack, SlopesByScaleAndAxesAreThoseOfTheTurn) {
  const std::vector<TimedRate> measured = samples_at(0.025, 1201);
  constexpr double kStep = 1e-6;
  const Turn turn = whole(track_of(measured));
  const std::vector<std::pair<int, int>> elements{{0, 0}, {1, 1}, {2, 2}, {0, 1}, {0, 2},
                                                  {1, 0}, {1, 2}, {2, 0}, {2, 1}};
  for (std::size_t i = 0; i < elements.size(); ++i) {
    const auto with = [&](double error) {
      Matrix3d gyro = Matrix3d::Identity();
      gyro(elements[i].first, elements[i].second) += error;
      std::vector<TimedRate> corrected = measured;
      for (TimedRate& sample : corrected) {
        sample.rate_body_rad_s = gyro.inverse() * sample.rate_body_rad_s;
      }
      return whole(track_of(corrected)).turn;
    };
    const Vector3d numeric =
        rotation_vector_of(with(-kStep).conjugate() * with(kStep)) / (2.0 * kStep);
    const Vector3d found = turn.per_gyro_error.col(static_cast<Eigen::Index>(i));
    EXPECT_LT((found - numeric).norm(), 1e-5 * turn.per_gyro_error.norm()) << i;
  }
}

TEST(RateTrack, NoiseOfAllSamplesAddsUp) {
  const RateTrack track = track_of(samples_at(0.25, 401, [](double) { return Vector3d::Zero(); }));
  const double expected_rad = kNoise_rad_s * 0.25 * std::sqrt(400.0);
  EXPECT_NEAR(std::sqrt(whole(track).covariance_rad2(1, 1)), expected_rad, 0.003 * expected_rad);
}

/// In many gaps the truth wanders as it does elsewhere.
TEST(RateTrack, GapsAreBridgedWithinTheirSigma) {
  std::mt19937_64 generator{7};
  std::normal_distribution<double> normal;
  constexpr double kWander = 2e-4;  // rad/s per sqrt(s)
  double squares = 0.0;
  constexpr int kTrials = 300;
  for (int trial = 0; trial < kTrials; ++trial) {
    std::vector<TimedRate> samples;
    Vector3d rate = Vector3d::Zero();
    Vector3d turned = Vector3d::Zero();
    for (int i = 0; i <= 400; ++i) {
      if (i <= 100 || i >= 140) {
        samples.push_back({i * 0.25, rate});
      }
      for (int part = 0; part < 10; ++part) {
        if (i >= 100 && i < 140) {
          turned += 0.025 * rate;
        }
        for (int axis = 0; axis < 3; ++axis) {
          rate[axis] += kWander * std::sqrt(0.025) * normal(generator);
        }
      }
    }
    const RateTrack track{std::move(samples), 0.0, 100.0, 1e-9};
    EXPECT_EQ(track.gaps(), 1);
    EXPECT_NEAR(track.longest_gap_s(), 10.0, 1e-9);
    const std::vector<double> ends{25.0, 35.0};
    const Turn turn = track.turns(ends, Vector3d::Zero()).front();
    const Vector3d off = rotation_vector_of(turn.turn) - turned;
    squares += off.dot(turn.covariance_rad2.llt().solve(off)) / 3.0;
  }
  // The change across the gap widens the sigma beyond what the wandering requires.
  EXPECT_LT(squares / kTrials, 1.1);
  EXPECT_GT(squares / kTrials, 0.4);
}

/// 10 Hz, with a smooth rate of 0.5 deg/s whose direction rotates in 60 s.
TEST(RateTrack, GapsOfASmoothRateAreBridgedWithinTheirSigma) {
  const auto rate = [](double t_s) {
    return Vector3d{0.0087 * std::sin(0.105 * t_s), 0.0087 * std::cos(0.105 * t_s), 0.0};
  };
  for (double from_s = 20.0; from_s < 80.0; from_s += 5.0) {
    std::vector<TimedRate> samples = samples_at(0.1, 1201, rate);
    const Turn expected =
        track_of(samples).turns(std::vector{from_s, from_s + 9.0}, Vector3d::Zero()).front();
    std::erase_if(samples, [=](const TimedRate& s) {
      return s.t_s > from_s + 0.01 && s.t_s < from_s + 8.99;
    });
    const RateTrack track = track_of(samples);
    const Turn turn = track.turns(std::vector{from_s, from_s + 9.0}, Vector3d::Zero()).front();
    const Vector3d off = rotation_vector_of(turn.turn.conjugate() * expected.turn);
    EXPECT_LT(std::sqrt(off.dot(turn.covariance_rad2.llt().solve(off))), 3.5) << from_s;
  }
}

TEST(RateTrack, HoldsTheRateOutsideTheSamplesWithGrowingUncertainty) {
  std::vector<TimedRate> samples = samples_at(0.25, 41);
  const RateTrack track{samples, -5.0, 15.0, kNoise_rad_s};
  EXPECT_EQ(track.rate_at(-3.0), samples.front().rate_body_rad_s);
  EXPECT_EQ(track.rate_at(14.0), samples.back().rate_body_rad_s);
  const std::vector<double> ends{-5.0, -4.0, 9.0, 10.0, 15.0};
  const std::vector<Turn> turns = track.turns(ends, Vector3d::Zero());
  EXPECT_GT(turns[0].covariance_rad2(0, 0), 100.0 * turns[2].covariance_rad2(0, 0));
  EXPECT_GT(turns[3].covariance_rad2(0, 0), 100.0 * turns[2].covariance_rad2(0, 0));
}

}  // namespace spindrift::rate_track_test
