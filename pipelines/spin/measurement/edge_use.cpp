#include "pipelines/spin/measurement/edge_use.h"

#include <algorithm>
#include <array>
#include <cstddef>

#include "pipelines/spin/measurement/measurement.h"

namespace spindrift {
namespace {

/// Returns whether the quantity rests on edges of the channel.
bool uses(SpinQuantity quantity, PulseChannel channel) {
  using enum SpinQuantity;
  switch (channel) {
    case PulseChannel::Sun1:
      return quantity == SunAngle || quantity == NorthDihedral || quantity == SouthDihedral;
    case PulseChannel::Sun2:
      return quantity == SunAngle || quantity == MixedAzimuth;
    case PulseChannel::NorthIn:
    case PulseChannel::NorthOut:
      return quantity == NorthChord || quantity == NorthDihedral || quantity == MixedAzimuth;
    case PulseChannel::SouthIn:
    case PulseChannel::SouthOut:
      return quantity == SouthChord || quantity == SouthDihedral || quantity == MixedAzimuth;
  }
  return false;
}

/// Holds the partner of an edge and the measurement that both make together.
struct Pair {
  PulseChannel partner;
  SpinQuantity quantity;
};

Pair pair_of(PulseChannel channel) {
  using enum PulseChannel;
  static constexpr std::array<Pair, kPulseChannels> kPairs = {
      {{Sun2, SpinQuantity::SunAngle},
       {Sun1, SpinQuantity::SunAngle},
       {NorthOut, SpinQuantity::NorthChord},
       {NorthIn, SpinQuantity::NorthChord},
       {SouthOut, SpinQuantity::SouthChord},
       {SouthIn, SpinQuantity::SouthChord}}};
  return kPairs.at(index_of(channel));
}

/// Returns whether the pair exists but gives no measurement. Of the sun slits only slit 2 is
/// doubted, because sun1 passed the period test.
bool means_nothing(const Revolution& revolution, PulseChannel channel,
                   const std::vector<Verdict>& verdicts) {
  const Pair pair = pair_of(channel);
  return channel != PulseChannel::Sun1 && revolution.good_edge(pair.partner) &&
         std::none_of(verdicts.begin(), verdicts.end(),
                      [&](const Verdict& v) { return v.quantity == pair.quantity; });
}

std::optional<Rejection> rejection(const SpinConfig& config, const Revolution& revolution,
                                   PulseChannel channel, const std::vector<Verdict>& verdicts) {
  if (!has_sensor(config, channel)) {
    return Rejection::NoSensor;
  }
  if (const auto& off = revolution.edge_rejections.at(index_of(channel))) {
    return off;
  }
  if (means_nothing(revolution, channel, verdicts)) {
    return Rejection::Geometry;
  }
  // An edge without remaining measurement lacks an orbit if others of its revolution do.
  const auto of_no_orbit = [](const Verdict& v) { return v.rejected_by == Rejection::NoOrbit; };
  if (std::any_of(verdicts.begin(), verdicts.end(), of_no_orbit)) {
    return Rejection::NoOrbit;
  }
  std::optional<Rejection> first;
  for (const Verdict& verdict : verdicts) {
    // A measurement that another edge has spoilt does not test this one.
    if (!uses(verdict.quantity, channel) || verdict.rejected_by == Rejection::Phase ||
        verdict.rejected_by == Rejection::Interference) {
      continue;
    }
    if (!verdict.rejected_by) {
      return std::nullopt;
    }
    first = first.value_or(*verdict.rejected_by);
  }
  return first;
}

}  // namespace

bool has_sensor(const SpinConfig& config, PulseChannel channel) {
  return std::all_of(kSides.begin(), kSides.end(), [&](Side side) {
    const bool of_side =
        channel == kInChannels.at(index_of(side)) || channel == kOutChannels.at(index_of(side));
    return !of_side || sensor_of(config, side);
  });
}

std::vector<PulseUse> edge_uses(const SpinConfig& config, const Revolution& revolution,
                                const std::vector<Verdict>& verdicts) {
  std::vector<PulseUse> all;
  for (std::size_t i = 0; i < kPulseChannels; ++i) {
    if (const auto& t = revolution.edges.at(i)) {
      const auto channel = static_cast<PulseChannel>(i);
      all.push_back({.pulse = {.t = *t, .channel = channel},
                     .revolution = revolution.number,
                     .rejected_by = rejection(config, revolution, channel, verdicts),
                     .said = revolution.edge_places.at(i),
                     .gap = revolution.edge_gaps.at(i)});
    }
  }
  return all;
}

}  // namespace spindrift
