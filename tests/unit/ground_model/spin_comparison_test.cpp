#include "pipelines/ground_model/comparison/spin_comparison.h"

#include <cmath>
#include <map>
#include <memory>
#include <string>

#include "pipelines/ephemeris/earth_orientation.h"
#include "pipelines/ephemeris/kepler_orbit.h"
#include "pipelines/frames/angle.h"
#include "pipelines/frames/celestial.h"
#include "pipelines/ground_model/comparison/model_comparison.h"
#include "pipelines/ground_model/link/coded_telemetry.h"
#include "tests/support/departures.h"
#include "tests/support/matchers.h"
#include "tests/support/spin_truth.h"

namespace spindrift::testing::spin_comparison_test {

using enum PulseChannel;

constexpr TaiTime kStart = tai_from_ns(1'795'143'637'000'000'000);
constexpr double kEnd_s = 600.0;
constexpr double kChange_s = 300.0;
constexpr double kRate_rad_s = kTurn_rad;  // One turn a second.
constexpr double kResolution_s = 1e-4;

/// The scenarios' transfer orbit.
const Orbit kOrbit = orbit_across_the_earth();

SpinTruth truth() { return truth_of(body_across_the_earth()); }

PulseLink link(std::uint64_t seed) {
  return {
      .seed = seed, .noise = {.sun_s = 1e-4, .infrared_s = 5e-4}, .channels = {}, .silences = {}};
}

std::vector<TrueEdge> edges_of(const SpinTruth& truth) {
  return SpinEdges{truth, kOrbit}.until(kEnd_s).value();
}

ReceivedPass sent(const std::vector<TrueEdge>& edges, std::uint64_t seed) {
  return receive(link(seed), edges, kStart, kEnd_s, 600);
}

std::vector<Pulse> pulses(const std::vector<TrueEdge>& edges, std::uint64_t seed = 1) {
  std::vector<Pulse> all;
  for (const ReceivedPulse& received : sent(edges, seed).pulses) {
    all.push_back(received.pulse);
  }
  return all;
}

template <class Sample>
ByChannel compared(const std::vector<Sample>& flight) {
  static const auto model = std::make_shared<const GroundModel>(
      spin_model(truth(), link(0), kResolution_s, kOrbit, kEnd_s).value());
  ModelComparison comparison{model, 5.0};
  for (const Sample& sample : flight) {
    comparison.compare(sample);
  }
  comparison.finish();
  return by_channel(comparison.channels());
}

std::map<std::string, double> departures_s(const ByChannel& all) {
  return testing::departures_s(all, kStart);
}

void expect_only(const ByChannel& all, const std::string& channel) {
  testing::expect_only(departures_s(all), channel, {kChange_s, kChange_s + 2.0});
}

/// Each of 20 passes with 600 revolutions has 12 periods and phases that share edges of sun1, which
/// doubles the variance of independent ones.
TEST(SpinComparison, IsOfUnitVarianceInTheModelsOwnPasses) {
  std::map<std::string, double> squares;
  std::map<std::string, double> counts;
  const auto edges = edges_of(truth());
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    for (const auto& [name, channel] : compared(pulses(edges, seed))) {
      EXPECT_FALSE(channel.departure) << name << " of seed " << seed;
      const auto count = static_cast<double>(channel.residuals.count());
      squares[name] += count * std::pow(channel.residuals.normalised_rms(), 2);
      counts[name] += count;
    }
  }
  ASSERT_EQ(counts.size(), 7U);
  for (const auto& [name, count] : counts) {
    if (name != "sun1") {
      EXPECT_GT(count, 20 * 595);
      EXPECT_NEAR(squares[name] / count, 1.0, 5.0 * std::sqrt(4.0 / count)) << name;
    }
  }
}

TEST(SpinComparison, IsOfUnitVarianceInCodedTelemetry) {
  const auto edges = edges_of(truth());
  double squares = 0.0;
  double count = 0.0;
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    for (const auto& [name, channel] :
         compared(coded_telemetry(sent(edges, seed), kResolution_s))) {
      EXPECT_FALSE(channel.departure) << name;
      const auto number = static_cast<double>(channel.residuals.count());
      squares += number * std::pow(channel.residuals.normalised_rms(), 2);
      count += number;
    }
  }
  EXPECT_NEAR(squares / count, 1.0, 5.0 * std::sqrt(4.0 / count));
}

/// Only the absolute phase differs.
TEST(SpinComparison, DoesNotCompareTheAbsolutePhase) {
  SpinTruth turned = truth();
  turned.motion.first_azimuth_rad = 2.0;
  EXPECT_THAT(departures_s(compared(pulses(edges_of(turned)))), IsEmpty());
}

TEST(SpinComparison, FindsARateStep) {
  SpinTruth after = truth();
  after.motion.rate_rad_s = 1.002 * kRate_rad_s;
  after.motion.first_azimuth_rad = (kRate_rad_s - after.motion.rate_rad_s) * kChange_s;
  std::vector<TrueEdge> flight = edges_of(truth());
  std::erase_if(flight, [](const TrueEdge& edge) { return edge.t_s >= kChange_s; });
  for (const TrueEdge& edge : edges_of(after)) {
    if (edge.t_s >= kChange_s) {
      flight.push_back(edge);
    }
  }
  const auto all = compared(pulses(flight));
  expect_only(all, "period");
  EXPECT_NEAR(all.at("period").departure->value, 0.002, 0.0005);
  EXPECT_NEAR(all.at("period").departure->limit, 5.0 * std::sqrt(2.0) * 1e-4, 1e-9);
}

TEST(SpinComparison, FindsTheChannelThatIsBiased) {
  for (const PulseChannel channel : {Sun2, NorthIn, SouthOut}) {
    std::vector<TrueEdge> flight = edges_of(truth());
    for (TrueEdge& edge : flight) {
      edge.t_s += edge.channel == channel && edge.t_s > kChange_s ? 0.005 : 0.0;
    }
    const auto all = compared(pulses(flight));
    expect_only(all, std::string{name_of(channel)});
    EXPECT_NEAR(all.at(std::string{name_of(channel)}).departure->value, 0.005 * 360.0, 1.0);
  }
}

TEST(SpinComparison, FindsTheChannelThatDies) {
  for (const PulseChannel channel : {Sun1, Sun2, NorthOut}) {
    std::vector<TrueEdge> flight = edges_of(truth());
    std::erase_if(flight, [channel](const TrueEdge& edge) {
      return edge.channel == channel && edge.t_s > kChange_s;
    });
    const auto all = compared(pulses(flight));
    expect_only(all, std::string{name_of(channel)});
    EXPECT_EQ(all.at(std::string{name_of(channel)}).departure->unit, "s silent");
  }
}

TEST(SpinComparison, IsNotMovedByLostAndSpuriousEdges) {
  PulseLink dirty = link(3);
  for (ChannelFaults& channel : dirty.channels) {
    channel = {.lost = 0.05, .spoilt = 0.03, .doubled = 0.01, .spurious = 0.02};
  }
  dirty.spoilt_min_s = 0.002;
  dirty.spoilt_max_s = 0.05;
  dirty.doubled_max_s = 0.002;
  std::vector<Pulse> flight;
  for (const ReceivedPulse& received :
       receive(dirty, edges_of(truth()), kStart, kEnd_s, 600).pulses) {
    flight.push_back(received.pulse);
  }
  EXPECT_THAT(departures_s(compared(flight)), IsEmpty());
}

TEST(SpinComparison, SaysNothingOutsideTheModelsTime) {
  std::vector<Pulse> flight = pulses(edges_of(truth()));
  for (Pulse& pulse : flight) {
    pulse.t += std::chrono::hours{1};
  }
  for (const auto& [name, channel] : compared(flight)) {
    EXPECT_EQ(channel.residuals.count(), 0) << name;
    EXPECT_FALSE(channel.departure) << name;
  }
}

TEST(SpinComparison, RefusesAModelWithoutNoiseOrRevolutions) {
  PulseLink quiet = link(0);
  quiet.noise.sun_s = 0.0;
  EXPECT_EQ(spin_model(truth(), quiet, kResolution_s, kOrbit, kEnd_s).error().code,
            ErrorCode::InvalidConfiguration);
  PulseLink blind = link(0);
  blind.channels.front().dead = true;
  EXPECT_THAT(spin_model(truth(), blind, kResolution_s, kOrbit, kEnd_s).error().message,
              HasSubstr("sun1"));
}

}  // namespace spindrift::testing::spin_comparison_test
