#include "pipelines/observation/gate.h"

#include <string>
#include <string_view>
#include <vector>

#include "tests/support/matchers.h"

namespace spindrift::gate_test {

TaiTime at(double t_s) { return shifted(tai_from_ns(1'795'143'637'000'000'000), t_s); }

/// Returns "K/W" at each sample that opened the gate, and "-K/W" at each that closed it, behind the
/// number of the sample.
/// @param hits A character a sample, `x` for a hit, `step_s` apart.
std::vector<std::string> transitions(WindowGate gate, std::string_view hits, double step_s = 1.0) {
  std::vector<std::string> all;
  for (std::size_t i = 0; i < hits.size(); ++i) {
    if (const auto window = gate.update(at(step_s * static_cast<double>(i)), hits[i] == 'x')) {
      all.push_back(std::to_string(i) + (gate.is_open() ? ": " : ": -") +
                    std::to_string(window->hits) + "/" + std::to_string(window->samples));
    }
  }
  return all;
}

std::vector<std::string> lost(std::string_view hits) {
  return transitions(WindowGate{rule_of(Gate::Lost)}, hits);
}

TEST(WindowGate, OpensAtTheLastSampleOfAWindowThatTheFirstHitBegan) {
  EXPECT_THAT(lost("...xxxxxxxxx"), IsEmpty()) << "nine samples";
  EXPECT_THAT(lost("...xxxxxxxxxx"), ElementsAre("12: 10/10"));
  EXPECT_THAT(lost("...x.x.xxxx.x"), ElementsAre("12: 7/10"));
}

TEST(WindowGate, OpensBeyondItsShareOnly) {
  EXPECT_THAT(lost("xxxxxx...."), IsEmpty()) << "6/10 is not above 0.6";
  EXPECT_THAT(lost("xxxxxxx..."), ElementsAre("9: 7/10"));
}

TEST(WindowGate, BeginsAnewAfterEachWindow) {
  // Windows that overlapped would find seven hits among the samples 6 to 15.
  EXPECT_THAT(lost("x.....xxxx"
                   "xxxx......"),
              IsEmpty());
  // The second window waits for a hit.
  EXPECT_THAT(lost("x........."
                   "....xxxxxxxxxx"),
              ElementsAre("23: 10/10"));
}

TEST(WindowGate, ClosesByAWindowThatWouldNotHaveOpenedIt) {
  EXPECT_THAT(lost("xxxxxxxxxx"
                   "xxxxxxx..."),
              ElementsAre("9: 10/10"));
  EXPECT_THAT(lost("xxxxxxxxxx"
                   "...xxxxxx."),
              ElementsAre("9: 10/10", "19: -6/10"));
  EXPECT_THAT(lost("xxxxxxxxxx"
                   ".........."),
              ElementsAre("9: 10/10", "19: -0/10"))
      << "no hit has to come";
  EXPECT_THAT(lost("xxxxxxxxxx"
                   ".........."
                   "xxxxxxxxxx"),
              ElementsAre("9: 10/10", "19: -0/10", "29: 10/10"));
}

TEST(WindowGate, OfASafeAttitudeLastsTenMinutes) {
  const auto safe = [](std::string_view hits, double step_s) {
    return transitions(WindowGate{rule_of(Gate::Safe)}, hits, step_s);
  };
  EXPECT_THAT(safe(std::string(60, 'x'), 10.0), IsEmpty()) << "590 s";
  EXPECT_THAT(safe(std::string(61, 'x'), 10.0), ElementsAre("60: 61/61"));
  EXPECT_THAT(safe(std::string(601, 'x'), 1.0), ElementsAre("600: 601/601"));
  EXPECT_THAT(safe(std::string(29, 'x'), 60.0), IsEmpty()) << "too few to tell";
  EXPECT_THAT(safe(std::string(30, 'x'), 60.0), ElementsAre("29: 30/30"));
  // More than 85 % of 61 samples are 52.
  EXPECT_THAT(safe(std::string(51, 'x') + std::string(10, '.'), 10.0), IsEmpty());
  EXPECT_THAT(safe(std::string(52, 'x') + std::string(9, '.'), 10.0), ElementsAre("60: 52/61"));
}

TEST(Gates, HaveTheNumbersOfTheirSources) {
  const auto numbers = [](Gate gate) {
    const GateRule rule = rule_of(gate);
    return std::vector{rule.threshold, double(rule.samples), rule.seconds, rule.share};
  };
  EXPECT_THAT(numbers(Gate::Lost), ElementsAre(5.0, 10, 0, 0.6));
  EXPECT_THAT(numbers(Gate::Usable), ElementsAre(1000.0, 30, 0, 0.67));
  EXPECT_THAT(numbers(Gate::Safe), ElementsAre(7.81, 30, 600, 0.85));
  EXPECT_THAT(numbers(Gate::Reached), ElementsAre(6.0, 10, 0, 0.67));
}

}  // namespace spindrift::gate_test
