/// Each fault of a table raises an alert; the delays are printed.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <functional>
#include <random>
#include <set>
#include <string>
#include <vector>

#include "pipelines/frames/angle.h"
#include "tests/property/alerts/supervised_pass.h"

namespace spindrift::testing::found_faults_test {

constexpr double kFault_s = 300.0;

using Spoil = std::function<void(std::vector<Sent>&)>;

struct Fault {
  std::string name;
  std::set<std::string> keys;  ///< Alert keys, any of which reports the fault.
  std::string scenario;
  Spoil sensors = {};  ///< Applied to the samples before they are numbered.
  std::string more_of_mission = {};
  double at_s = kFault_s;
  Spoil link = {};  ///< Applied to the numbered samples.
};

std::string spinner() { return text_of(scenarios() / "gto-nominal.toml"); }

bool is_from(const Sent& one, const std::vector<Sent>& all, double t_s) {
  return seconds_between(all.front().came, one.came) >= t_s;
}

/// Removes samples that come after the fault and satisfy `is_gone`.
template <class IsGone>
void erase(std::vector<Sent>& sent, const IsGone& is_gone) {
  const TaiTime from = shifted(sent.front().came, kFault_s);
  std::erase_if(sent, [&](const Sent& one) { return one.came >= from && is_gone(one); });
}

Spoil dead(std::set<PulseChannel> channels) {
  return [channels](std::vector<Sent>& sent) {
    erase(sent, [&](const Sent& one) {
      const auto* const pulse = std::get_if<TelemetrySample<Pulse>>(&one.sample);
      return pulse != nullptr && channels.contains(pulse->value.channel);
    });
  };
}

template <class Value>
Spoil dead() {
  return [](std::vector<Sent>& sent) {
    erase(sent, [](const Sent& one) {
      return std::holds_alternative<TelemetrySample<Value>>(one.sample);
    });
  };
}

/// @param change Receives the value and the seconds since the fault.
template <class Value>
Spoil changed(const std::function<void(Value&, double)>& change) {
  return [change](std::vector<Sent>& sent) {
    const TaiTime from = shifted(sent.front().came, kFault_s);
    for (Sent& one : sent) {
      auto* const sample = std::get_if<TelemetrySample<Value>>(&one.sample);
      if (sample != nullptr && one.came >= from) {
        change(sample->value, seconds_between(from, one.came));
      }
    }
  };
}

/// Simulates a tumble at 12 deg/s that the gyro does not measure.
void tumble(std::vector<Sent>& sent) {
  const auto turned = [](double t_s, const Eigen::Vector3d& axis) {
    return Eigen::AngleAxisd{12.0 * kRadPerDeg * t_s, axis};
  };
  changed<GyroSample>(
      [](GyroSample& gyro, double /*t_s*/) { gyro.rate_body_rad_s.x() = 10.0 * kRadPerDeg; })(sent);
  changed<StarFix>([&](StarFix& fix, double t_s) {
    fix.q_icrf_sensor = fix.q_icrf_sensor * turned(t_s, Eigen::Vector3d::UnitX());
  })(sent);
  changed<SunDirection>([&](SunDirection& sun, double t_s) {
    sun.sun_body = turned(-t_s, Eigen::Vector3d::UnitY()) * sun.sun_body;
  })(sent);
}

void sort(std::vector<Sent>& sent) {
  std::stable_sort(sent.begin(), sent.end(),
                   [](const Sent& a, const Sent& b) { return a.came < b.came; });
}

/// Adds a north_in edge half a millisecond after each sun2 edge.
void interfere(std::vector<Sent>& sent) {
  std::vector<Sent> more;
  for (const Sent& one : sent) {
    const auto* const pulse = std::get_if<TelemetrySample<Pulse>>(&one.sample);
    if (pulse != nullptr && pulse->value.channel == PulseChannel::Sun2 &&
        is_from(one, sent, kFault_s)) {
      auto beside = *pulse;
      beside.value = {.t = shifted(pulse->value.t, 5e-4), .channel = PulseChannel::NorthIn};
      more.push_back({.came = beside.value.t, .sample = beside});
    }
  }
  sent.insert(sent.end(), more.begin(), more.end());
  sort(sent);
}

void turn_to(std::vector<Sent>& sent, const std::string& other_scenario) {
  erase(sent, [](const Sent& /*one*/) { return true; });
  const TaiTime last = sent.back().came;
  for (const Sent& one : flown(other_scenario).sent) {
    if (one.came > last) {
      sent.push_back(one);
    }
  }
}

void add_noise(std::vector<Sent>& sent) {
  std::mt19937_64 rng{2303};
  std::normal_distribution<double> noise_s{0.0, 0.02};
  for (Sent& one : sent) {
    const double t_s = seconds_between(sent.front().came, one.came);
    if (t_s >= kFault_s && t_s < kFault_s + 60.0) {
      one.came = time_of(one.sample) = shifted(time_of(one.sample), noise_s(rng));
    }
  }
  sort(sent);
}

/// Adds a magnetometer sample once a second.
void add_magnetometer(std::vector<Sent>& sent) {
  const TaiTime start = sent.front().came;
  const double end_s = seconds_between(start, sent.back().came);
  for (double t_s = 0.5; t_s < end_s; t_s += 1.0) {
    sent.push_back({.came = shifted(start, t_s),
                    .sample = TelemetrySample<MagneticField>{
                        .spacecraft = "LEOSAT",
                        .origin = {.source = "front-end", .session = 1, .seq = 0},
                        .value = {.t = shifted(start, t_s), .field_body_nt = {1e4, 2e4, 3e4}}}});
  }
  sort(sent);
}

void begin_session(Sent& one, std::uint64_t seq) {
  std::visit(
      [&](auto& sample) {
        sample.origin.session = 2;
        sample.origin.seq = seq;
      },
      one.sample);
}

void restart(std::vector<Sent>& sent) {
  std::uint64_t seq = 0;
  for (Sent& one : sent) {
    if (is_from(one, sent, kFault_s)) {
      begin_session(one, seq++);
    }
  }
}

/// Sends the last minute before the fault again in a new session.
void repeat(std::vector<Sent>& sent) {
  std::vector<Sent> again;
  for (const Sent& one : sent) {
    if (is_from(one, sent, kFault_s - 60.0) && !is_from(one, sent, kFault_s)) {
      again.push_back(one);
      again.back().came = shifted(sent.front().came, kFault_s);
      begin_session(again.back(), again.size() - 1);
    }
  }
  restart(sent);
  for (Sent& one : sent) {
    if (is_from(one, sent, kFault_s)) {
      std::visit([&](auto& sample) { sample.origin.seq += again.size(); }, one.sample);
    }
  }
  sent.insert(sent.begin(), again.begin(), again.end());
  sort(sent);
}

void lose_five(std::vector<Sent>& sent) {
  const auto first = std::find_if(sent.begin(), sent.end(),
                                  [&](const Sent& one) { return is_from(one, sent, kFault_s); });
  sent.erase(first, first + 5);
}

void drop_out(std::vector<Sent>& sent) {
  const TaiTime back = shifted(sent.front().came, kFault_s + 30.0);
  erase(sent, [back](const Sent& one) { return one.came < back; });
}

void set_clock_ahead(std::vector<Sent>& sent) {
  for (Sent& one : sent) {
    time_of(one.sample) += std::chrono::seconds{30};
  }
}

std::vector<Fault> faults() {
  using enum PulseChannel;
  const std::string target = "\n[spin.target]\nra_deg = 100.0\ndec_deg = -55.0\n";
  const auto silent = [](const std::string& channel) {
    return std::set{"channel.silent:" + channel};
  };
  const std::string leosat = three_axis_text();
  const auto bias_jumps = [](double deg_s) {
    return changed<GyroSample>([deg_s](GyroSample& gyro, double /*t_s*/) {
      gyro.rate_body_rad_s.x() += deg_s * kRadPerDeg;
    });
  };
  const auto silent_link = [](std::vector<Sent>& sent) {
    erase(sent, [](const Sent& /*one*/) { return true; });
  };
  const auto axis_moves = [](std::vector<Sent>& sent) {
    turn_to(sent, replaced(spinner(), "dec_deg = -55.0", "dec_deg = -45.0"));
  };
  const auto magnetometer_dies = [](std::vector<Sent>& sent) {
    add_magnetometer(sent);
    dead<MagneticField>()(sent);
  };
  const std::string near_beams = replaced(spinner(), "azimuth_deg = 92.0", "azimuth_deg = 100.0") +
                                 "\n[spin.screening]\ninterference_s = 0.002\n";
  const std::string nutating = replaced(replaced(text_of(scenarios() / "gto-nutating.toml"),
                                                 "half_angle_deg = 0.2", "half_angle_deg = 1.0"),
                                        "duration_s = 600.0", "duration_s = 150.0");
  const std::set<std::string> lost_or_diverged = {"attitude.lost", "attitude.diverged"};
  return {
      {"sun1 dead", silent("sun1"), spinner(), dead({Sun1})},
      {"sun2 dead", silent("sun2"), spinner(), dead({Sun2})},
      {"ir north dead", silent("north_in"), spinner(), dead({NorthIn, NorthOut})},
      {"ir south dead", silent("south_in"), spinner(), dead({SouthIn, SouthOut})},
      {"interference", {"spin.interference"}, near_beams, interfere},
      {"wrong spin rate",
       {"spin.rate"},
       spinner(),
       {},
       target + "rpm = 61.0\ntolerance_rpm = 0.5\n",
       0.0},
      {"off target by 5 deg",
       {"spin.off_target"},
       replaced(spinner(), "dec_deg = -55.0", "dec_deg = -50.0"),
       {},
       target,
       0.0},
      {"axis moves by 10 deg", {"spin.off_target", "attitude.lost"}, spinner(), axis_moves, target},
      {"nutation of 1 deg", {"spin.nutation"}, nutating, {}, {}, 0.0},
      {"noise burst", {"spin.rejection"}, spinner(), add_noise},
      {"dropout of 30 s", {"link.silent"}, spinner(), drop_out},
      {"gyro dead", silent("gyro"), leosat, dead<GyroSample>()},
      {"star dead", silent("star"), leosat, dead<StarFix>()},
      {"sun dead", silent("sun"), leosat, dead<SunDirection>()},
      // The noise is so large that any field agrees with it.
      {"magnetometer dead", silent("magnetometer"), leosat, magnetometer_dies,
       "\n[three_axis.magnetometer]\nnoise_nt = 100000.0\n"},
      {"gyro bias jumps by 0.05 deg/s", lost_or_diverged, leosat, bias_jumps(0.05)},
      {"gyro bias jumps by 0.005 deg/s", lost_or_diverged, leosat, bias_jumps(0.005)},
      {"tumbling beyond the gyro's range",
       {"attitude.lost"},
       replaced(leosat, "noise_deg_s = 0.002", "noise_deg_s = 0.002\nrange_deg_s = 10.0"),
       tumble},
      {"link silent", {"link.silent"}, spinner(), silent_link},
      {"five samples lost", {"link.gap:front-end"}, spinner(), {}, {}, kFault_s, lose_five},
      {"source restarted", {"link.restarted:front-end"}, spinner(), {}, {}, kFault_s, restart},
      {"last minute repeated", {"link.repeated:front-end"}, spinner(), {}, {}, kFault_s, repeat},
      {"clock 30 s ahead", {"link.ahead"}, spinner(), {}, {}, 0.0, set_clock_ahead}};
}

TEST(FoundFaults, AllOfTheTable) {
  for (const Fault& fault : faults()) {
    Flight flight = flown(fault.scenario, fault.more_of_mission);
    flight.mission.separation.reset();
    const TaiTime from = shifted(flight.sent.front().came, fault.at_s);
    if (fault.sensors) {
      fault.sensors(flight.sent);
    }
    number(flight.sent);
    if (fault.link) {
      fault.link(flight.sent);
    }
    const auto raised = SupervisedPass{flight.mission, RunMode::Live}.serve(flight.sent);
    std::string others;
    std::optional<std::pair<double, std::string>> found;
    for (const auto& [key, alert] : raised) {
      const double after_s = seconds_between(from, alert.t);
      if (fault.keys.contains(key) && after_s >= 0.0 && (!found || after_s < found->first)) {
        found = {after_s, key};
      } else {
        others += fmt::format(" {} {:.1f} s;", key, after_s);
      }
    }
    EXPECT_TRUE(found) << fault.name << ":" << others;
    fmt::print("| {} | {} | {:.1f} s |{}\n", fault.name, found ? found->second : "not found",
               found ? found->first : 0.0, others);
  }
}

}  // namespace spindrift::testing::found_faults_test
