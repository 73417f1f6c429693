#include "pipelines/spin/consistency/channel_block.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <span>
#include <utility>

#include "pipelines/frames/angle.h"
#include "pipelines/spin/types/side.h"
#include "pipelines/statistics/median.h"
#include "pipelines/statistics/significance.h"
#include "pipelines/time/time_span.h"

namespace spindrift {
namespace {

constexpr double kBlock_s = 5.0;
constexpr std::size_t kFewestRevolutions = 3;
constexpr std::size_t kFewestToBend = 5;
// Ratio of the standard deviation of a median to that of a mean.
constexpr double kOfMedian = 1.2533;
// Ratio to the stated noise that a few edges show only if there is more of it.
constexpr double kLoud = 3.0;
// Ratio to the scatter of all other sensors beyond which it cannot be the same nutation.
constexpr double kFarLouder = 10.0;

/// Returns whether an edge tells where its channel is: also where that is not its usual place.
bool counts(const Revolution& revolution, PulseChannel channel) {
  const auto& rejected_by = revolution.edge_rejections.at(index_of(channel));
  return revolution.edge(channel) && (!rejected_by || rejected_by == Rejection::Phase);
}

/// Returns how far the edges of a channel are from the start of the middle revolution, less whole
/// turns in between.
std::vector<double> delays_s(std::span<const Revolution> revolutions, const Revolution& middle,
                             PulseChannel channel) {
  const double period_s = middle.period.period_s;
  std::vector<double> all;
  for (const Revolution& one : revolutions) {
    if (counts(one, channel)) {
      const double turns = static_cast<double>(one.number - middle.number);
      const double delay_s = seconds_between(middle.t_start, *one.edge(channel)) - turns * period_s;
      const double first_s = all.empty() ? delay_s : all.front();
      all.push_back(delay_s - period_s * std::round((delay_s - first_s) / period_s));
    }
  }
  return all;
}

/// Returns the standard deviation of single delays about their median, which a few strays do not
/// change.
double scatter_about_median_s(std::vector<double> delays) {
  const double median_s = upper_median(delays);
  std::transform(delays.begin(), delays.end(), delays.begin(),
                 [median_s](double delay_s) { return std::abs(delay_s - median_s); });
  return kSigmaPerMad * upper_median(delays);
}

/// Returns the standard deviation of single delays from their second differences, which neither an
/// offset nor the motion of the Earth makes.
double scatter_about_line_s(const std::vector<double>& delays) {
  std::vector<double> bends;
  for (std::size_t i = 2; i < delays.size(); ++i) {
    bends.push_back(std::abs(delays[i] - 2.0 * delays[i - 1] + delays[i - 2]) / std::sqrt(6.0));
  }
  return kSigmaPerMad * upper_median(bends);
}

/// Returns the standard deviation of single delays. A few strays may lie on a line: of less than
/// kFewestToBend delays it is that about their median, of two that by their difference.
double scatter_s(const std::vector<double>& delays) {
  if (delays.size() == 2) {
    return kSigmaPerMad * std::abs(delays[1] - delays[0]) / std::numbers::sqrt2;
  }
  return delays.size() < kFewestToBend ? scatter_about_median_s(delays)
                                       : scatter_about_line_s(delays);
}

std::optional<NoisyChannel> noisy_among(std::span<const std::vector<double>> delays,
                                        const PulseNoise& noise) {
  // Neither a stray nor the motion of the Earth alone makes both.
  const auto of_most_s = [&](std::size_t i) {
    return std::min(scatter_about_median_s(delays[i]), scatter_about_line_s(delays[i]));
  };
  const double stated_s =
      std::max(edge_sigma_s(noise, PulseChannel::Sun1), edge_sigma_s(noise, PulseChannel::NorthIn));
  for (std::size_t i = 0; i < kPulseChannels; ++i) {
    const auto channel = static_cast<PulseChannel>(i);
    double quiet_s = stated_s;
    int others = 0;
    for (std::size_t j = 0; j < kPulseChannels; ++j) {
      if (!are_of_one_sensor(channel, static_cast<PulseChannel>(j)) && !delays[j].empty()) {
        quiet_s = std::max(quiet_s, of_most_s(j));
        ++others;
      }
    }
    if (others >= 2 && of_most_s(i) > kFarLouder * quiet_s) {
      return NoisyChannel{
          .channel = channel, .scatter_s = of_most_s(i), .stated_s = edge_sigma_s(noise, channel)};
    }
  }
  return std::nullopt;
}

/// Returns the scatter that at least two channels show beyond their noise: nutation.
double common_scatter_s(std::span<const std::vector<double>> delays, const PulseNoise& noise) {
  std::vector<double> beyond;
  for (std::size_t i = 0; i < kPulseChannels; ++i) {
    const double of_one_s = scatter_s(delays[i]);
    const bool is_noise = of_one_s < kLoud * edge_sigma_s(noise, static_cast<PulseChannel>(i));
    beyond.push_back(is_noise ? 0.0 : of_one_s);
  }
  return in_order_at(beyond, kPulseChannels - 2);
}

/// The median ignores strays; the motion of the Earth is the same before and behind the middle.
/// @param common_s Scatter that does not average out.
ChannelPoint point_of(std::vector<double> delays, const Revolution& middle, const PulseNoise& noise,
                      PulseChannel channel, double common_s) {
  const double stated_s = edge_sigma_s(noise, channel);
  const double observed_s = scatter_s(delays);
  const double each_s = observed_s > kLoud * stated_s ? observed_s : stated_s;
  const double mean_s = kOfMedian * each_s / std::sqrt(static_cast<double>(delays.size()));
  return {.edge = {.t = later_by_s(middle.t_start, upper_median(delays)), .channel = channel},
          .sigma_s = std::hypot(mean_s, grid_sigma_s(noise), common_s)};
}

/// Returns whether edges of a channel are off its usual place: one may be a stray.
bool is_shifted(std::span<const Revolution> revolutions, PulseChannel channel) {
  const auto shifted =
      std::count_if(revolutions.begin(), revolutions.end(), [channel](const Revolution& one) {
        return one.edge_rejections.at(index_of(channel)) == Rejection::Phase;
      });
  return shifted >= 2;
}

ChannelBlock block_of(std::span<const Revolution> revolutions, const PulseNoise& noise) {
  const Revolution& middle = revolutions[revolutions.size() / 2];
  std::array<std::vector<double>, kPulseChannels> delays;
  for (std::size_t i = 0; i < kPulseChannels; ++i) {
    delays.at(i) = delays_s(revolutions, middle, static_cast<PulseChannel>(i));
  }
  const double common_s = common_scatter_s(delays, noise);
  ChannelBlock block{
      .t = middle.t_start, .rate_rad_s = middle.rate_rad_s(middle.t_start), .points = {}};
  for (std::size_t i = 0; i < kPulseChannels; ++i) {
    const auto channel = static_cast<PulseChannel>(i);
    if (2 * delays.at(i).size() > revolutions.size()) {
      block.points.push_back(point_of(delays.at(i), middle, noise, channel, common_s));
    }
    block.has_shifted = block.has_shifted || is_shifted(revolutions, channel);
  }
  block.noisy = noisy_among(delays, noise);
  return block;
}

}  // namespace

std::optional<ChannelBlock> BlockCollector::add(const PulseNoise& noise,
                                                const Revolution& revolution) {
  revolutions_.push_back(revolution);
  if (revolutions_.size() < kFewestRevolutions ||
      seconds_between(revolutions_.front().t_start, revolution.t_start) < kBlock_s) {
    return std::nullopt;
  }
  return block_of(std::exchange(revolutions_, {}), noise);
}

}  // namespace spindrift
