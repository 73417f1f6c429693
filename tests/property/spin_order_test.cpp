#include <gtest/gtest.h>

#include <algorithm>
#include <iterator>
#include <random>
#include <vector>

#include "pipelines/spin/pass/spin_pass.h"
#include "pipelines/spin/telemetry_order/pulse_reorder_window.h"
#include "tests/support/product_text.h"
#include "tests/support/recorded_pass.h"

namespace spindrift::testing::spin_order_test {

/// Returns the pulses in the order of arrival after random delays below the window.
std::vector<Pulse> shuffled(const std::vector<Pulse>& pulses, std::mt19937_64& rng) {
  std::uniform_int_distribution<std::int64_t> delay_ns{0, reorder_horizon(Pulse{}).count() - 1};
  std::vector<std::pair<std::int64_t, Pulse>> arrivals(pulses.size());
  std::transform(pulses.begin(), pulses.end(), arrivals.begin(), [&](const Pulse& pulse) {
    return std::pair{tai_ns(pulse.t) + delay_ns(rng), pulse};
  });
  std::sort(arrivals.begin(), arrivals.end());
  std::vector<Pulse> in_order_of_arrival(arrivals.size());
  std::transform(arrivals.begin(), arrivals.end(), in_order_of_arrival.begin(),
                 [](const auto& arrival) { return arrival.second; });
  return in_order_of_arrival;
}

/// Removes some edges and adds spurious ones on any channel.
std::vector<Pulse> spoilt(const std::vector<Pulse>& pulses, std::mt19937_64& rng) {
  std::bernoulli_distribution lost{0.1};
  std::bernoulli_distribution spurious{0.05};
  std::uniform_real_distribution<double> off_s{-0.5, 0.5};
  std::uniform_int_distribution<int> channel{0, static_cast<int>(kPulseChannels) - 1};
  std::vector<Pulse> result;
  for (const Pulse& pulse : pulses) {
    if (!lost(rng)) {
      result.push_back(pulse);
    }
    if (spurious(rng)) {
      result.push_back(
          {.t = shifted(pulse.t, off_s(rng)), .channel = static_cast<PulseChannel>(channel(rng))});
    }
  }
  std::sort(result.begin(), result.end());
  return result;
}

TEST(SpinOrder, OfArrivalWithinTheWindowChangesNoProduct) {
  std::mt19937_64 rng{111};
  for (const auto* const name : {"nominal", "gms5", "north-only"}) {
    const RecordedPass pass = recorded_pass(name);
    for (int trial = 0; trial < 5; ++trial) {
      SCOPED_TRACE(name);
      const std::vector<Pulse> pulses = trial == 0 ? pass.pulses : spoilt(pass.pulses, rng);
      const std::vector<Pulse> arrivals = shuffled(pulses, rng);
      ASSERT_NE(arrivals, pulses);
      ASSERT_EQ(texts_of(run(SpinPass{pass.config, pass.orbit}, arrivals)),
                texts_of(run(SpinPass{pass.config, pass.orbit}, pulses)));
    }
  }
}

/// Runs a pass and reports a silence after one in `every` samples.
template <class Sample>
SpinOutput run_with_silences(SpinPass pass, const std::vector<Sample>& samples, int every,
                             std::mt19937_64& rng) {
  std::bernoulli_distribution is_silent{1.0 / every};
  SpinOutput all;
  const auto keep = [&all](SpinOutput output) {
    std::move(output.products.begin(), output.products.end(), std::back_inserter(all.products));
  };
  for (const Sample& sample : samples) {
    keep(pass.push(sample));
    if (is_silent(rng)) {
      keep(pass.fall_silent());
    }
  }
  keep(pass.finish());
  return all;
}

TEST(SpinOrder, SilencesInAnOrderedStreamChangeNoProduct) {
  std::mt19937_64 rng{112};
  for (const auto* const name : {"nominal", "dirty", "gms5", "north-only"}) {
    SCOPED_TRACE(name);
    RecordedPass pass = recorded_pass(name);
    std::sort(pass.pulses.begin(), pass.pulses.end());
    const auto expected = texts_of(run(SpinPass{pass.config, pass.orbit}, pass.pulses));
    for (const int every : {1, 7, 300}) {
      ASSERT_EQ(
          texts_of(run_with_silences(SpinPass{pass.config, pass.orbit}, pass.pulses, every, rng)),
          expected);
    }
  }
  const RecordedPass coded = recorded_pass("coded");
  for (const int every : {1, 7, 300}) {
    ASSERT_EQ(
        texts_of(run_with_silences(SpinPass{coded.config, coded.orbit}, coded.frames, every, rng)),
        texts_of(run(coded)));
  }
}

}  // namespace spindrift::testing::spin_order_test
