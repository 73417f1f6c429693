#include "pipelines/ground_model/link/pulse_link.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "pipelines/ground_model/link/chance.h"

namespace spindrift {
namespace {

struct Arrival {
  double t_s;
  PulseChannel channel;
  std::optional<Damage> damage;
};

struct Arrivals {
  std::vector<Arrival> received;
  std::vector<Arrival> silenced;
};

/// Applies all that can happen to one edge. The number of draws is the same whatever happens.
void send(const PulseLink& link, const TrueEdge& edge, Chance& chance, ReceivedPass& pass,
          Arrivals& arrivals) {
  const ChannelFaults& faults = link.channels.at(index_of(edge.channel));
  const bool lost = chance.uniform() < faults.lost;
  const bool spoilt = chance.uniform() < faults.spoilt;
  const bool doubled = chance.uniform() < faults.doubled;
  const double way = chance.either_way();
  const double again_s = (1.0 - chance.uniform()) * link.doubled_max_s;
  const double noise_s = edge_sigma_s(link.noise, edge.channel) * chance.normal();
  const bool silent = is_silent(link.silences, edge.t_s);
  pass.missing += lost || faults.dead || silent ? 1 : 0;
  if (lost || faults.dead) {
    return;
  }
  const double off_s = std::copysign(
      link.spoilt_min_s + std::abs(way) * (link.spoilt_max_s - link.spoilt_min_s), way);
  const double t_s = edge.t_s + noise_s + (spoilt ? off_s : 0.0);
  auto& seen = silent ? arrivals.silenced : arrivals.received;
  seen.push_back({.t_s = t_s,
                  .channel = edge.channel,
                  .damage = spoilt ? std::optional{Damage::Spoilt} : std::nullopt});
  if (doubled) {
    seen.push_back({.t_s = t_s + again_s, .channel = edge.channel, .damage = Damage::Doubled});
  }
}

void add_spurious(const PulseLink& link, double duration_s, std::int64_t revolutions,
                  Chance& chance, Arrivals& arrivals) {
  for (std::size_t channel = 0; channel < kPulseChannels; ++channel) {
    for (std::int64_t turn = 0; turn < revolutions; ++turn) {
      const bool comes = chance.uniform() < link.channels.at(channel).spurious;
      const double t_s = chance.uniform() * duration_s;
      if (comes && !link.channels.at(channel).dead) {
        (is_silent(link.silences, t_s) ? arrivals.silenced : arrivals.received)
            .push_back({.t_s = t_s,
                        .channel = static_cast<PulseChannel>(channel),
                        .damage = Damage::Spurious});
      }
    }
  }
}

void sort_by_time(std::vector<Arrival>& arrivals) {
  std::sort(arrivals.begin(), arrivals.end(), [](const Arrival& a, const Arrival& b) {
    return std::pair{a.t_s, a.channel} < std::pair{b.t_s, b.channel};
  });
}

/// Displaces edges of different channels that are too close. `arrivals` are in order of time.
void interfere(double interference_s, Chance& chance, std::vector<Arrival>& arrivals) {
  std::vector<bool> hit(arrivals.size());
  for (std::size_t i = 0; i < arrivals.size(); ++i) {
    for (std::size_t j = i + 1;
         j < arrivals.size() && arrivals[j].t_s - arrivals[i].t_s < interference_s; ++j) {
      if (arrivals[i].channel != arrivals[j].channel) {
        hit[i] = hit[j] = true;
      }
    }
  }
  for (std::size_t i = 0; i < arrivals.size(); ++i) {
    if (hit[i]) {
      arrivals[i].t_s += 0.5 * interference_s * chance.either_way();
      arrivals[i].damage = arrivals[i].damage.value_or(Damage::Interference);
    }
  }
}

}  // namespace

std::string_view name_of(Damage damage) {
  static constexpr std::array<std::string_view, 4> kNames = {"spoilt", "spurious", "doubled",
                                                             "interference"};
  return kNames.at(static_cast<std::size_t>(damage));
}

ReceivedPass receive(const PulseLink& link, const std::vector<TrueEdge>& edges, TaiTime start,
                     double duration_s, std::int64_t revolutions) {
  Chance chance{link.seed};
  ReceivedPass pass;
  Arrivals arrivals;
  arrivals.received.reserve(edges.size());
  for (const TrueEdge& edge : edges) {
    send(link, edge, chance, pass, arrivals);
  }
  add_spurious(link, duration_s, revolutions, chance, arrivals);
  sort_by_time(arrivals.received);
  interfere(link.interference_s, chance, arrivals.received);
  sort_by_time(arrivals.received);
  sort_by_time(arrivals.silenced);
  const auto pulse = [start](const Arrival& arrival) {
    return Pulse{.t = shifted(start, arrival.t_s), .channel = arrival.channel};
  };
  pass.pulses.reserve(arrivals.received.size());
  for (const Arrival& arrival : arrivals.received) {
    pass.pulses.push_back({.pulse = pulse(arrival), .damage = arrival.damage});
  }
  pass.silenced.reserve(arrivals.silenced.size());
  for (const Arrival& arrival : arrivals.silenced) {
    pass.silenced.push_back(pulse(arrival));
  }
  return pass;
}

}  // namespace spindrift
