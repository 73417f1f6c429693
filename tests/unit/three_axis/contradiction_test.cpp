#include <fmt/format.h>

#include <algorithm>
#include <random>
#include <string>
#include <variant>
#include <vector>

#include "pipelines/three_axis/three_axis_pass.h"
#include "tests/support/matchers.h"
#include "tests/support/turning_body.h"

namespace spindrift::testing::three_axis_contradiction_test {

using AnySample = std::variant<GyroSample, StarFix, SunDirection>;

constexpr auto kOther = static_cast<Sender>(2);
constexpr double kWrong_rad = 0.17;
constexpr double kPass_s = 40.0;

StarFix turned(StarFix fix) {
  fix.q_icrf_sensor = fix.q_icrf_sensor *
                      Eigen::Quaterniond{Eigen::AngleAxisd{kWrong_rad, Eigen::Vector3d::UnitX()}};
  return fix;
}
SunDirection turned(SunDirection sun) {
  sun.sun_body = Eigen::AngleAxisd{kWrong_rad, sun.sun_body.unitOrthogonal()} * sun.sun_body;
  return sun;
}
GyroSample turned(GyroSample gyro) {
  gyro.rate_body_rad_s += Eigen::Vector3d::Constant(0.01);
  return gyro;
}

template <class Sample>
Sample from(Sender sender, Sample sample) {
  sample.sender = sender;
  return sample;
}

TaiTime time_of(const AnySample& sample) {
  return std::visit([](const auto& is) { return is.t; }, sample);
}

/// Holds a sample and its time of arrival on the telemetry's time scale.
struct Arrival {
  double t_s;
  AnySample sample;
};

std::string text_of(const AttitudeEstimate& estimate) {
  const auto& q = estimate.q_icrf_body.coeffs();
  return fmt::format("{} {:a} {:a} {:a} {:a} {:a} {}", tai_ns(estimate.t), q.x(), q.y(), q.z(),
                     q.w(), estimate.sigma_rad(), static_cast<int>(estimate.assessment.quality));
}

class Contradictions : public ::testing::Test {
 protected:
  struct Made {
    std::vector<std::string> attitudes;
    std::vector<std::string> contradictions;
    std::vector<RejectedSample> rejected;
  };

  static Made run(std::vector<Arrival> arrivals) {
    std::ranges::stable_sort(arrivals,
                             [](const Arrival& a, const Arrival& b) { return a.t_s < b.t_s; });
    ThreeAxisPass pass{usual_three_axis(), std::nullopt};
    Made made;
    const auto note = [&made](const ThreeAxisOutput& output) {
      for (const ThreeAxisProduct& product : output.products) {
        if (const auto* attitude = std::get_if<AttitudeEstimate>(&product)) {
          made.attitudes.push_back(text_of(*attitude));
        } else if (const auto* contradiction = std::get_if<SampleContradiction>(&product)) {
          std::vector<std::string> by;
          for (const SampleContradiction::By& one : contradiction->by) {
            by.push_back(fmt::format("{}{}", static_cast<int>(one.sender), one.used ? "+" : "-"));
          }
          std::ranges::sort(by);
          made.contradictions.push_back(fmt::format("{} {} {}{}", contradiction->kind,
                                                    tai_ns(contradiction->t), fmt::join(by, ""),
                                                    contradiction->late ? " late" : ""));
        } else if (const auto* rejected = std::get_if<RejectedSample>(&product)) {
          made.rejected.push_back(*rejected);
        }
      }
    };
    for (const Arrival& arrival : arrivals) {
      note(std::visit([&](const auto& is) { return pass.push(is); }, arrival.sample));
    }
    note(pass.finish());
    return made;
  }

  /// Returns the honest sender's samples: gyro at 4 Hz, star fixes and sun vectors once a second.
  std::vector<AnySample> honest() {
    std::vector<AnySample> samples;
    for (int tick = 0; tick < static_cast<int>(4.0 * kPass_s); ++tick) {
      const double t_s = 0.25 * tick;
      samples.emplace_back(sensors_.gyro(t_s));
      if (tick % 4 == 0) {
        samples.emplace_back(sensors_.star(t_s));
        samples.emplace_back(SunDirection{
            .t = at_s(t_s),
            .sun_body = sensors_.direction(t_s, sun_icrf_, config_.sun_sensor->noise_rad)});
      }
    }
    return samples;
  }

  std::mt19937_64 rng_{43};
  ThreeAxisConfig config_ = usual_three_axis();
  TurningBody body_ = TurningBody::smooth(rng_, kPass_s + 1.0, 0.02);
  Sensors sensors_{body_, config_, rng_};
  Eigen::Vector3d sun_icrf_ = -earth_motion(at_s(0.0)).heliocentric_icrf_km.normalized();
};

double seconds_of(const AnySample& sample) { return seconds_between(at_s(0.0), time_of(sample)); }

/// Returns samples that arrive at their own time.
std::vector<Arrival> at_once(const std::vector<AnySample>& samples) {
  std::vector<Arrival> arrivals;
  for (const AnySample& sample : samples) {
    arrivals.push_back({.t_s = seconds_of(sample), .sample = sample});
  }
  return arrivals;
}

/// The other sender is wrong in a third of its samples. Each sample is delayed by up to half a
/// second, so that every order of the two occurs and none is late.
TEST_F(Contradictions, WhoeverComesFirstNoContestedValueIsUsed) {
  const std::vector<AnySample> samples = honest();
  std::uniform_real_distribution<double> delay_s{0.0, 0.5};
  std::bernoulli_distribution is_wrong{1.0 / 3.0};
  std::vector<bool> wrong;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    wrong.push_back(i > 8 && is_wrong(rng_));
  }
  const auto arrivals = [&](auto&& first, auto&& second) {
    std::vector<Arrival> all;
    for (std::size_t i = 0; i < samples.size(); ++i) {
      for (const auto& sample : {first(i), second(i)}) {
        if (sample) {
          all.push_back({.t_s = seconds_of(*sample) + delay_s(rng_), .sample = *sample});
        }
      }
    }
    return all;
  };
  const auto said_by = [&](Sender sender, bool may_be_wrong) {
    return [&, sender, may_be_wrong](std::size_t i) {
      return std::optional{std::visit(
          [&](const auto& is) {
            return AnySample{from(sender, may_be_wrong && wrong[i] ? turned(is) : is)};
          },
          samples[i])};
    };
  };
  const auto nothing = [](std::size_t /*i*/) { return std::optional<AnySample>{}; };
  const auto uncontested = [&](std::size_t i) {
    return wrong[i] ? std::nullopt : std::optional{samples[i]};
  };
  const Made without = run(arrivals(uncontested, nothing));
  const Made honest_alone = run(arrivals(said_by(Sender::First, false), nothing));
  const Made wrong_alone = run(arrivals(said_by(kOther, true), nothing));
  ASSERT_GT(without.attitudes.size(), 50U);
  ASSERT_NE(without.attitudes, honest_alone.attitudes);
  const auto contested = static_cast<std::size_t>(std::ranges::count(wrong, true));

  std::vector<std::string> said;
  for (int order = 0; order < 50; ++order) {
    SCOPED_TRACE(order);
    const Made neither = run(arrivals(said_by(Sender::First, false), said_by(kOther, true)));
    ASSERT_EQ(neither.attitudes, without.attitudes);
    ASSERT_EQ(neither.contradictions.size(), contested);
    ASSERT_EQ(neither.rejected.size(), contested + without.rejected.size());
    ASSERT_TRUE(said.empty() || neither.contradictions == said);
    said = neither.contradictions;

    const Made preferred = run(arrivals(said_by(Sender::Preferred, false), said_by(kOther, true)));
    ASSERT_EQ(preferred.attitudes, honest_alone.attitudes);
    ASSERT_EQ(preferred.contradictions.size(), contested);
    const Made wrong_preferred =
        run(arrivals(said_by(Sender::First, false), said_by(Sender::Preferred, true)));
    ASSERT_EQ(wrong_preferred.attitudes, wrong_alone.attitudes);
  }
}

TEST_F(Contradictions, WhatComesBehindTheWindowIsOnlySaid) {
  const std::vector<AnySample> samples = honest();
  std::vector<Arrival> arrivals = at_once(samples);
  const Made alone = run(arrivals);
  const StarFix late = turned(from(kOther, std::get<StarFix>(samples[1])));
  arrivals.push_back({.t_s = 1.6, .sample = late});
  const Made with_late = run(arrivals);
  EXPECT_EQ(with_late.attitudes, alone.attitudes);
  EXPECT_THAT(with_late.rejected, SizeIs(alone.rejected.size()));
  EXPECT_THAT(with_late.contradictions,
              ElementsAre(fmt::format("star {} 1+2- late", tai_ns(late.t))));
}

TEST_F(Contradictions, RoundingAndTheSignOfAQuaternionAreNone) {
  std::vector<Arrival> arrivals;
  std::vector<Arrival> twice;
  const auto as_float = [](double value) { return static_cast<double>(static_cast<float>(value)); };
  for (const AnySample& sample : honest()) {
    arrivals.push_back({.t_s = seconds_of(sample), .sample = sample});
    twice.push_back(arrivals.back());
    AnySample again = sample;
    if (auto* const star = std::get_if<StarFix>(&again)) {
      star->q_icrf_sensor.coeffs() = -star->q_icrf_sensor.coeffs().unaryExpr(as_float);
    } else if (auto* const gyro = std::get_if<GyroSample>(&again)) {
      gyro->rate_body_rad_s = gyro->rate_body_rad_s.unaryExpr(as_float);
    }
    std::visit([](auto& is) { is.sender = kOther; }, again);
    twice.push_back({.t_s = seconds_of(sample) + 0.1, .sample = again});
  }
  const Made made = run(twice);
  EXPECT_EQ(made.attitudes, run(arrivals).attitudes);
  EXPECT_THAT(made.contradictions, IsEmpty());
}

TEST_F(Contradictions, APreferredSenderThatContradictsItselfIsNotUsed) {
  const std::vector<AnySample> samples = honest();
  std::vector<Arrival> arrivals = at_once(samples);
  const StarFix one = from(Sender::Preferred, std::get<StarFix>(samples[1]));
  arrivals.push_back({.t_s = 0.1, .sample = one});
  arrivals.push_back({.t_s = 0.2, .sample = turned(one)});
  const Made made = run(arrivals);
  ASSERT_THAT(made.rejected, SizeIs(::testing::Ge(1U)));
  EXPECT_EQ(made.rejected.front().rejected_by, Rejection::Contradicted);
  EXPECT_THAT(made.contradictions, ElementsAre(fmt::format("star {} 0-1-", tai_ns(one.t))));
}

}  // namespace spindrift::testing::three_axis_contradiction_test
