#include "services/program/status_line.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <string_view>
#include <utility>
#include <vector>

#include "pipelines/time/tai_time.h"
#include "pipelines/time/time_span.h"
#include "pipelines/time/utc.h"
#include "services/base/decimals.h"

namespace spindrift {
namespace {

/// Parts of the line by decreasing priority: when it is too long, the last ones are dropped first.
enum class Need {
  Always,
  Name,
  Quality,
  Utc,
  Channels,
  Revolution,
  Rate,
  Estimator,
  Axis,
  Separation,
  AsOf,
  Date
};
struct Part {
  Need need;
  std::string text;
};

struct Sensor {
  std::string_view label;
  std::vector<std::string_view> channels;
};

std::vector<Sensor> sensors_of(const Mission& mission, const TalliedArrivals& arrivals) {
  std::vector<Sensor> sensors;
  if (const SpinConfig* const spin = mission.spin()) {
    sensors.push_back({"sun", {"sun1", "sun2"}});
    if (spin->north) {
      sensors.push_back({"N", {"north_in", "north_out"}});
    }
    if (spin->south) {
      sensors.push_back({"S", {"south_in", "south_out"}});
    }
    return sensors;
  }
  for (const auto& [channel, last] : arrivals.last) {
    sensors.push_back({channel == "magnetometer" ? "mag" : channel, {channel}});
  }
  return sensors;
}

/// Formats an age in whole s, min or h with at most two digits.
std::string short_age(double age_s) {
  constexpr double kMinute_s = 60.0;
  constexpr double kMost = 100.0;
  const double s = std::max(age_s, 0.0);
  return s < kMost               ? fmt::format("{:.0f}", std::min(s, kMost - 1.0))
         : s < kMost * kMinute_s ? fmt::format("{:.0f}m", s / kMinute_s)
                                 : fmt::format("{:.0f}h", s / kHour_s);
}

/// @param now Time by the clock of the telemetry.
std::string ages(const std::vector<Sensor>& sensors, const TalliedArrivals& arrivals, TaiTime now) {
  std::vector<std::string> texts;
  for (const Sensor& sensor : sensors) {
    std::vector<std::string> of_channels;
    for (const std::string_view channel : sensor.channels) {
      const auto last = arrivals.last.find(channel);
      of_channels.push_back(last == arrivals.last.end() ? "-"
                                                        : short_age(elapsed_s(last->second, now)));
    }
    texts.push_back(fmt::format("{} {}", sensor.label, fmt::join(of_channels, "/")));
  }
  return fmt::format("{}", fmt::join(texts, " "));
}

std::string time_of_day(TaiTime t) {
  const std::string utc = format_utc(t, 0);
  return utc.substr(utc.find('T') + 1);
}

void add_answer(const PassVerdict& verdict, std::vector<Part>& parts) {
  if (verdict.ra_deg && verdict.dec_deg) {
    constexpr int kMost = 3;
    const int decimals = std::min(kMost, decimals_for(verdict.sigma_deg.value_or(0.0), kMost));
    parts.push_back({Need::Axis, fmt::format("ra {:.{}f} dec {:.{}f}", *verdict.ra_deg, decimals,
                                             *verdict.dec_deg, decimals)});
  }
  if (!verdict.estimator.empty()) {
    parts.push_back({Need::Estimator, verdict.estimator});
  }
  const std::string quality =
      std::string{verdict.quality ? name_of(*verdict.quality) : "no answer"};
  parts.push_back(
      {Need::Quality, verdict.sigma_deg
                          ? fmt::format("{} {}deg", quality, to_its_digits(*verdict.sigma_deg, 2))
                          : quality});
  if (verdict.t) {
    parts.push_back({Need::AsOf, "of " + time_of_day(*verdict.t)});
  }
  if (verdict.separation) {
    parts.push_back(
        {Need::Separation, fmt::format("T1 {} {}deg", name_of(verdict.separation->quality),
                                       to_its_digits(verdict.separation->sigma_deg, 2))});
  }
}

std::size_t length_of(const std::vector<Part>& parts) {
  std::size_t length = parts.size() - 1;
  for (const Part& part : parts) {
    length += part.text.size();
  }
  return length;
}

std::string fitted(std::vector<Part> parts, std::size_t columns) {
  while (parts.size() > 1 && length_of(parts) > columns) {
    parts.erase(std::max_element(parts.begin(), parts.end(),
                                 [](const Part& a, const Part& b) { return a.need < b.need; }));
  }
  std::string line;
  for (const Part& part : parts) {
    line += (line.empty() ? "" : " ") + part.text;
  }
  return line.substr(0, columns);
}

}  // namespace

std::string status_line(const Mission& mission, const SpacecraftHealth& health,
                        const TalliedArrivals& arrivals, std::optional<double> rate_hz,
                        std::size_t columns) {
  std::vector<Part> parts{{Need::Name, health.spacecraft}};
  if (!health.last_sample || !health.data_age_s) {
    parts.push_back({Need::Always, "waiting for telemetry"});
    if (health.last_sample) {
      parts.push_back({Need::Utc, "last " + format_utc(*health.last_sample, 0)});
      add_answer(health.verdict, parts);
    }
    return fitted(std::move(parts), columns);
  }
  const std::string utc = format_utc(*health.last_sample, 0);
  const std::size_t time = utc.find('T');
  if (time != std::string::npos) {
    parts.push_back({Need::Date, utc.substr(0, time)});
  }
  parts.push_back({Need::Utc, time == std::string::npos ? utc : utc.substr(time + 1)});
  parts.push_back(
      {Need::Always, fmt::format("{} {:.{}f}s", health.link == LinkState::Stale ? "SILENT" : "age",
                                 *health.data_age_s, *health.data_age_s < 10.0 ? 1 : 0)});
  if (arrivals.revolution) {
    parts.push_back({Need::Revolution, fmt::format("rev {}", *arrivals.revolution)});
  }
  if (rate_hz) {
    parts.push_back({Need::Rate, fmt::format("{:.1f}/s", *rate_hz)});
  }
  if (const auto sensors = sensors_of(mission, arrivals); !sensors.empty()) {
    parts.push_back({Need::Channels,
                     ages(sensors, arrivals, later_by_s(*health.last_sample, *health.data_age_s))});
  }
  add_answer(health.verdict, parts);
  return fitted(std::move(parts), columns);
}

}  // namespace spindrift
