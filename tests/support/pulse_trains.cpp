#include "tests/support/pulse_trains.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>

#include "pipelines/frames/angle.h"
#include "pipelines/frames/celestial.h"
#include "pipelines/spin/pass/spin_pass.h"
#include "tests/support/dirt.h"
#include "tests/support/observed_spin.h"
#include "tests/support/product_text.h"
#include "tests/support/spinning_body.h"

namespace spindrift::testing {
namespace {

using enum PulseChannel;

constexpr double kRevolutions = 200.0;
constexpr double kMostSigmas = 5.0;
constexpr Dirt kDirt{.lost = 0.05, .spoilt = 0.05, .spurious = 0.04};

PulseTrains copies(const std::string& name, const Copying& copying, const Dirt& dirt = {}) {
  return {.name = name, .of = [copying, dirt](const auto& pulses, double period_s, auto& rng) {
            return dirty(copied(pulses, copying, rng), period_s, dirt, rng).pulses;
          }};
}

PulseTrains half(PulseChannel channel, const Dirt& dirt = {}) {
  return {.name = "half of " + std::string{name_of(channel)},
          .of = [channel, dirt](const auto& pulses, double period_s, auto& rng) {
            return dirty(halved(pulses, channel), period_s, dirt, rng).pulses;
          }};
}

/// Returns a second copy of a channel with a jitter of its own.
PulseTrains second(PulseChannel channel, double behind_turns, const Dirt& dirt = {},
                   double from_share = 0.0) {
  return {.name = "second " + std::string{name_of(channel)},
          .of = [=](const auto& pulses, double period_s, auto& rng) {
            const Copying copying{.behind_s = behind_turns * period_s,
                                  .jitter_s = 1e-4,
                                  .channels = {channel},
                                  .from_share = from_share};
            return dirty(copied(pulses, copying, rng), period_s, dirt, rng).pulses;
          }};
}

double sigmas_off(const SpinEstimate& estimate, const SpinningBody& body) {
  return angle_between_rad(estimate.axis_icrf, body.axis_icrf) / sigma_rad(estimate);
}

void expect_no_ok_far_off(const SpinOutput& output, const SpinningBody& body) {
  for (const SpinEstimate& estimate : all_of<SpinEstimate>(output)) {
    if (estimate.assessment.quality == Quality::Ok) {
      ASSERT_LT(sigmas_off(estimate, body), kMostSigmas) << text_of(SpinProduct{estimate});
    }
  }
}

void expect_an_axis(const SpinOutput& output, const SpinningBody& body) {
  const SpinEstimate last = last_estimate(output, SpinEstimator::Sequential);
  EXPECT_TRUE(last.assessment.quality == Quality::Ok ||
              last.assessment.quality == Quality::Doubtful)
      << name_of(last.assessment.quality);
  EXPECT_LT(sigmas_off(last, body), kMostSigmas);
}

}  // namespace

std::vector<Pulse> copied(const std::vector<Pulse>& pulses, const Copying& copying,
                          std::mt19937_64& rng) {
  std::normal_distribution<double> normal;
  std::vector<Pulse> all = pulses;
  const auto count = static_cast<double>(pulses.size());
  for (std::size_t i = 0; i < pulses.size(); ++i) {
    const auto share = static_cast<double>(i) / count;
    if (copying.channels.contains(pulses[i].channel) && share >= copying.from_share &&
        share < copying.to_share) {
      all.push_back({.t = shifted(pulses[i].t, copying.behind_s + copying.jitter_s * normal(rng)),
                     .channel = pulses[i].channel});
    }
  }
  std::sort(all.begin(), all.end());
  all.erase(std::unique(all.begin(), all.end()), all.end());
  return all;
}

std::vector<Pulse> halved(std::vector<Pulse> pulses, PulseChannel channel) {
  int seen = 0;
  std::erase_if(pulses,
                [&](const Pulse& pulse) { return pulse.channel == channel && seen++ % 2 == 1; });
  return pulses;
}

std::vector<PulseTrains> plain_trains() {
  return {copies("copy 1 ns", {.behind_s = 1e-9}),
          copies("copy 0.1 ms", {.behind_s = 1e-4}),
          copies("copy 1 ms", {.behind_s = 1e-3}),
          copies("copy 5 ms", {.behind_s = 5e-3}),
          copies("copy 20 ms", {.behind_s = 0.02}),
          half(Sun1),
          second(Sun1, 0.5)};
}

std::vector<PulseTrains> mixed_trains() {
  return {copies("1 ns, jitter 0.1 ms", {.behind_s = 1e-9, .jitter_s = 1e-4}),
          copies("1 ns, jitter 0.5 ms", {.behind_s = 1e-9, .jitter_s = 5e-4}),
          copies("5 ms, jitter 1 ms", {.behind_s = 5e-3, .jitter_s = 1e-3}),
          copies("sun1 alone", {.behind_s = 1e-9, .jitter_s = 5e-4, .channels = {Sun1}}),
          copies("north_out alone", {.behind_s = 1e-9, .jitter_s = 5e-4, .channels = {NorthOut}}),
          copies("sun2 alone, 5 ms", {.behind_s = 5e-3, .jitter_s = 1e-4, .channels = {Sun2}}),
          copies("from midway", {.behind_s = 5e-3, .jitter_s = 1e-4, .from_share = 0.5}),
          copies("ahead from midway", {.behind_s = -5e-3, .jitter_s = 1e-4, .from_share = 0.5}),
          copies("ahead to midway", {.behind_s = -5e-3, .jitter_s = 1e-4, .to_share = 0.5}),
          copies("dirty, 2 ms", {.behind_s = 2e-3, .jitter_s = 1e-4}, kDirt),
          copies("dirty, 5 ms", {.behind_s = 5e-3, .jitter_s = 1e-4}, kDirt),
          copies("a fifth lost", {.behind_s = 5e-3, .jitter_s = 1e-4}, {.lost = 0.2}),
          half(Sun1, kDirt),
          half(Sun2),
          half(NorthIn),
          second(Sun1, 0.5, kDirt),
          second(Sun1, 0.3),
          second(Sun1, 0.5, {}, 0.5),
          second(Sun2, 0.5),
          second(NorthIn, 0.5)};
}

void expect_the_axis_of(const std::vector<PulseTrains>& all_trains, bool are_plain, int first_seed,
                        int seeds) {
  const Surroundings from;
  for (int seed = first_seed; seed < first_seed + seeds; ++seed) {
    for (const double rpm : {40.0, 60.0, 75.0, 100.0}) {
      std::mt19937_64 rng{static_cast<std::uint64_t>(1000 * seed) +
                          static_cast<std::uint64_t>(rpm)};
      SpinningBody body = random_body(from.around, 4.0 * kRadPerDeg, rng);
      body.rate_rad_s = rpm * std::numbers::pi / 30.0;
      const double period_s = 60.0 / rpm;
      const std::vector<Pulse> pulses =
          noisy_pulses(body, edges_between(body, from.around, 0.0, kRevolutions * period_s), rng);
      for (const PulseTrains& trains : all_trains) {
        SCOPED_TRACE(trains.name + ", seed " + std::to_string(seed) + ", rpm " +
                     std::to_string(rpm));
        const SpinOutput output =
            run(SpinPass{body.config, from.orbit}, trains.of(pulses, period_s, rng));
        expect_no_ok_far_off(output, body);
        if (are_plain) {
          expect_an_axis(output, body);
        }
      }
    }
  }
}

}  // namespace spindrift::testing
