/// The verdict on a spinner and its open alerts agree, row by row and at the end of the pass.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <set>
#include <string>
#include <variant>
#include <vector>

#include "pipelines/frames/angle.h"
#include "pipelines/frames/celestial.h"
#include "pipelines/spin/pass/spin_pass.h"
#include "pipelines/supervision/answer_in_force.h"
#include "tests/property/alerts/supervised_pass.h"

namespace spindrift::testing::one_voice_test {

using Keys = std::set<std::string>;

/// The open alerts that say something about the quality of the answer.
Keys of_quality(const Keys& open) {
  Keys found;
  for (const char* const key : {"spin.ambiguous", "spin.doubtful", "attitude.lost"}) {
    if (open.contains(key)) {
      found.insert(key);
    }
  }
  return found;
}

Keys expected_of(Quality quality) {
  switch (quality) {
    case Quality::Ambiguous:
      return {"spin.ambiguous"};
    case Quality::Doubtful:
      return {"spin.doubtful"};
    case Quality::Lost:
      return {"attitude.lost"};
    default:
      return {};
  }
}

/// Compares an answer with the alerts open behind it, as long as it has stayed the same for longer
/// than any of them holds. Rows must follow each other closely, as those of a service do.
class Compared {
 public:
  void operator()(const SpinAnswer& answer, const Keys& open) {
    if (!last_ || last_->quality != answer.quality) {
      since_ = answer.t;
    }
    last_ = answer;
    if (seconds_between(since_, answer.t) > kLongestHold_s) {
      EXPECT_EQ(of_quality(open), expected_of(answer.quality));
      ++compared_;
    }
  }
  const SpinAnswer& last() const { return last_.value(); }
  int compared() const { return compared_; }

 private:
  static constexpr double kLongestHold_s = 62.0;
  std::optional<SpinAnswer> last_;
  TaiTime since_ = {};
  int compared_ = 0;
};

void expect_one_voice(const Flight& flight, const std::string& pass) {
  SCOPED_TRACE(pass);
  Compared live;
  SupervisedPass served{flight.mission, RunMode::Live};
  served.on_answer = [&](const SpinAnswer& answer) { live(answer, served.open()); };
  served.serve(flight.sent);
  EXPECT_GT(live.compared(), 0);
  served.finish();
  EXPECT_EQ(of_quality(served.open()), expected_of(live.last().quality)) << "at the end, live";

  SpinAnswer last;
  SupervisedPass processed{flight.mission, RunMode::Process};
  processed.on_answer = [&](const SpinAnswer& answer) { last = answer; };
  processed.process(flight.sent);
  EXPECT_EQ(of_quality(processed.open()), expected_of(last.quality)) << "at the end";
  ::testing::Test::RecordProperty(pass, std::string{name_of(last.quality)});
}

TEST(OneVoice, OfANutatingSpinner) {
  const std::string scenario = text_of(scenarios() / "gto-nutating.toml");
  for (int seed = 1; seed <= 8; ++seed) {
    const auto flight = flown(replaced(scenario, "duration_s = 600.0",
                                       fmt::format("duration_s = 600.0\nseed = {}", seed)));
    expect_one_voice(flight, fmt::format("nutating_{}", seed));
  }
}

TEST(OneVoice, OfRandomPassesOfASpinner) {
  std::mt19937_64 rng{4702};
  std::uniform_real_distribution<double> either{-1.0, 1.0};
  const std::string nominal = text_of(scenarios() / "gto-nominal.toml");
  for (int pass = 0; pass < 12; ++pass) {
    const double ra_deg = 100.0 + 8.0 * either(rng);
    const double dec_deg = -55.0 + 8.0 * either(rng);
    const auto flown_about = [&](double of_dec_deg) {
      std::string text = replaced(nominal, "duration_s = 600.0",
                                  fmt::format("duration_s = 600.0\nseed = {}", pass + 1));
      text = replaced(text, "ra_deg = 100.0", fmt::format("ra_deg = {}", ra_deg));
      return flown(replaced(text, "dec_deg = -55.0", fmt::format("dec_deg = {}", of_dec_deg)));
    };
    Flight flight = flown_about(dec_deg);
    // Every third pass lacks sun2, and of every third the body is turned half-way.
    if (pass % 3 == 1) {
      std::erase_if(flight.sent, [](const Sent& one) {
        const auto* const edge = std::get_if<TelemetrySample<Pulse>>(&one.sample);
        return edge != nullptr && edge->value.channel == PulseChannel::Sun2;
      });
      number(flight.sent);
    } else if (pass % 3 == 2) {
      const TaiTime turned = shifted(flight.sent.front().came, 300.0);
      std::erase_if(flight.sent, [&](const Sent& one) { return one.came >= turned; });
      for (const Sent& one : flown_about(dec_deg + 10.0).sent) {
        if (one.came >= turned) {
          flight.sent.push_back(one);
        }
      }
      number(flight.sent);
    }
    expect_one_voice(flight, fmt::format("random_{}", pass));
  }
}

/// Returns the estimates of a pass that is `before` up to `turned` and `after` from then on.
std::vector<SpinEstimate> estimates_of_a_turn(const Flight& before, const Flight& after,
                                              TaiTime turned) {
  SpinPass pass{*before.mission.spin(), *before.mission.orbit};
  std::vector<SpinEstimate> estimates;
  const auto keep = [&](const SpinOutput& output) {
    for (const SpinProduct& product : output.products) {
      if (const auto* const estimate = std::get_if<SpinEstimate>(&product)) {
        estimates.push_back(*estimate);
      }
    }
  };
  for (const Flight* const flight : {&before, &after}) {
    for (const Sent& one : flight->sent) {
      const auto* const edge = std::get_if<TelemetrySample<Pulse>>(&one.sample);
      if (edge != nullptr && (one.came >= turned) == (flight == &after)) {
        keep(pass.push(edge->value));
      }
    }
  }
  keep(pass.finish());
  return estimates;
}

TEST(OneVoice, OnceATurnIsSeenTheAxisOfBeforeIsNotOk) {
  const std::string nominal = text_of(scenarios() / "gto-nominal.toml");
  for (const int rpm : {30, 60, 90}) {
    SCOPED_TRACE(rpm);
    const auto flown_about = [&](double dec_deg) {
      return flown(replaced(replaced(nominal, "rate_rpm = 60.0", fmt::format("rate_rpm = {}", rpm)),
                            "dec_deg = -55.0", fmt::format("dec_deg = {}", dec_deg)));
    };
    const Flight before = flown_about(-55.0);
    const Eigen::Vector3d turned_icrf =
        direction_icrf({.ra_rad = 100.0 * kRadPerDeg, .dec_rad = -45.0 * kRadPerDeg});
    const TaiTime turned = shifted(before.sent.front().came, 300.0);
    SpinAnswers answers{before.mission.alerts.disagree_sigmas};
    bool seen = false;  // Whether `sequential`, which alone uses every edge, has seen the turn.
    int ok = 0;
    for (const SpinEstimate& estimate : estimates_of_a_turn(before, flown_about(-45.0), turned)) {
      answers.take(estimate);
      seen = seen || (estimate.t > turned && estimate.estimator == SpinEstimator::Sequential &&
                      !is_unopposed(estimate.assessment.quality));
      const SpinAnswer& answer = answers.in_force().value();
      if (seen && is_unopposed(answer.quality)) {
        EXPECT_LT(angle_between_rad(answer.estimate.axis_icrf, turned_icrf),
                  5.0 * std::sqrt(answer.estimate.covariance_rad2.trace()))
            << seconds_between(turned, answer.t) << " s after the turn";
        ++ok;
      }
    }
    EXPECT_GT(ok, 0);
  }
}

}  // namespace spindrift::testing::one_voice_test
