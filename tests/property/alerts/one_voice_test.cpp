/// The verdict on a spacecraft and its open alerts agree, row by row and at the end of the pass.

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
#include "tests/property/alerts/fault.h"
#include "tests/property/alerts/three_axis_faults.h"

namespace spindrift::testing::one_voice_test {

using Keys = std::set<std::string>;

/// The open alerts that say something about the quality of the answer.
Keys of_quality(const Keys& open) {
  Keys found;
  for (const char* const key :
       {"spin.ambiguous", "spin.doubtful", "attitude.doubtful", "attitude.lost"}) {
    if (open.contains(key)) {
      found.insert(key);
    }
  }
  return found;
}

Keys expected_of(SpacecraftKind kind, Quality quality) {
  switch (quality) {
    case Quality::Ambiguous:
      return {"spin.ambiguous"};
    case Quality::Doubtful:
      return {kind == SpacecraftKind::Spin ? "spin.doubtful" : "attitude.doubtful"};
    case Quality::Lost:
      return {"attitude.lost"};
    default:
      return {};
  }
}

/// Compares an answer with the alerts open behind it, as long as it has stayed the same for longer
/// than any of them holds. Rows must follow each other closely, as those of a service do. What was
/// lost is so until it is OK again.
class Compared {
 public:
  explicit Compared(SpacecraftKind kind) : kind_{kind} {}

  void operator()(TaiTime t, Quality quality, const Keys& open) {
    if (last_ != quality) {
      since_ = t;
    }
    last_ = quality;
    was_lost_ = quality == Quality::Lost || (was_lost_ && quality != Quality::Ok);
    if (seconds_between(since_, t) > kLongestHold_s) {
      Keys expected = expected_of(kind_, quality);
      if (was_lost_) {
        expected.insert("attitude.lost");
      }
      EXPECT_EQ(of_quality(open), expected);
      qualities_.insert(quality);
    }
  }
  Quality last() const { return last_.value(); }
  /// Returns the qualities that were compared.
  const std::set<Quality>& qualities() const { return qualities_; }

 private:
  static constexpr double kLongestHold_s = 62.0;
  SpacecraftKind kind_;
  std::optional<Quality> last_;
  TaiTime since_ = {};
  bool was_lost_ = false;
  std::set<Quality> qualities_;
};

/// @return The qualities that were compared row by row.
std::set<Quality> expect_one_voice(const Flight& flight, const std::string& pass) {
  SCOPED_TRACE(pass);
  const SpacecraftKind kind = flight.mission.kind();
  Compared live{kind};
  SupervisedPass served{flight.mission, RunMode::Live};
  served.on_answer = [&](TaiTime t, Quality quality) { live(t, quality, served.open()); };
  served.serve(flight.sent);
  EXPECT_FALSE(live.qualities().empty());
  served.finish();
  EXPECT_EQ(of_quality(served.open()), expected_of(kind, live.last())) << "at the end, live";

  Quality last{};
  SupervisedPass processed{flight.mission, RunMode::Process};
  processed.on_answer = [&](TaiTime /*t*/, Quality quality) { last = quality; };
  processed.process(flight.sent);
  EXPECT_EQ(of_quality(processed.open()), expected_of(kind, last)) << "at the end";
  ::testing::Test::RecordProperty(pass, std::string{name_of(last)});
  return live.qualities();
}

TEST(OneVoice, OfAThreeAxisSpacecraft) {
  const std::set<std::string> names{"gyro dead", "star tracker turned by 5 deg",
                                    "tumbling beyond the gyro's range",
                                    "gyro dead, no attitude held"};
  std::set<Quality> compared;
  std::size_t flown_of_table = 0;
  for (const Fault& fault : three_axis_faults()) {
    if (names.contains(fault.name)) {
      compared.merge(expect_one_voice(spoilt(fault), fault.name));
      ++flown_of_table;
    }
  }
  EXPECT_EQ(flown_of_table, names.size());
  EXPECT_EQ(compared, (std::set{Quality::Ok, Quality::Doubtful}));
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
