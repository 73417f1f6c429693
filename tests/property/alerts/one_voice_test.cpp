/// The verdict on a spinner and its open alerts agree, row by row and at the end of the pass.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <random>
#include <set>
#include <string>

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

}  // namespace spindrift::testing::one_voice_test
