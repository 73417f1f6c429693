#include "pipelines/spin/consistency/channel_contradictions.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <iterator>
#include <utility>

#include "pipelines/frames/angle.h"
#include "pipelines/frames/celestial.h"
#include "pipelines/spin/types/side.h"
#include "pipelines/statistics/distributions.h"
#include "pipelines/statistics/significance.h"

namespace spindrift {
namespace {

constexpr std::chrono::seconds kRecent{60};
// A long contradiction is compared again whenever its span has grown by this share.
constexpr double kGrown = 0.1;
constexpr double kLongestBetween_s = 20.0;
constexpr std::size_t kMostBlocks = 24;
// Chi-square by which leaving out the one must explain more than leaving out the other.
constexpr double kClearly = 16.0;
constexpr double kLeastGain = kContradictionSigmas * kContradictionSigmas;
// Two ends within this angle are the same axis.
constexpr double kSameAxis_rad = kRadPerDeg;

using Blocks = std::vector<BlockUnderSky>;

/// Holds what may be wrong, and how well the rest agrees.
struct Suspect {
  std::vector<SampleSource> sources;
  OmittedSensors omitted;
  std::optional<BlockFit> fit = {};
};

/// Finds the best axis from known ones and from all over the sky.
class AxisFinder {
 public:
  AxisFinder(const SpinConfig& config, std::vector<Eigen::Vector3d> known_icrf,
             const BlockUnderSky& last)
      : config_{config}, known_icrf_{std::move(known_icrf)}, sky_{config, last} {}

  std::optional<BlockFit> best(const Blocks& blocks, const OmittedSensors& omitted) const {
    std::optional<BlockFit> best;
    const auto try_from = [&](const Eigen::Vector3d& start_icrf) {
      auto fit = fit_axis(config_, blocks, omitted, start_icrf);
      if (fit && (!best || fit->squares < best->squares)) {
        best = std::move(fit);
      }
    };
    std::for_each(known_icrf_.begin(), known_icrf_.end(), try_from);
    if (!best || !agrees(*best)) {
      const std::vector<Eigen::Vector3d> far = sky_.best(omitted);
      std::for_each(far.begin(), far.end(), try_from);
    }
    return best;
  }

  static bool agrees(const BlockFit& fit) {
    return fit.freedom == 0 || fit.squares < chi_square_beyond(kContradictionChance, fit.freedom);
  }

 private:
  const SpinConfig& config_;
  std::vector<Eigen::Vector3d> known_icrf_;
  SkyOfAxes sky_;
};

std::bitset<kPulseChannels> channels_in(const Blocks& blocks) {
  std::bitset<kPulseChannels> channels;
  for (const BlockUnderSky& block : blocks) {
    for (const ChannelPoint& point : block.block.points) {
      channels.set(index_of(point.edge.channel));
    }
  }
  return channels;
}

std::vector<Suspect> suspects_in(const Blocks& blocks) {
  const std::bitset<kPulseChannels> channels = channels_in(blocks);
  std::vector<Suspect> suspects;
  for (std::size_t i = 0; i < kPulseChannels; ++i) {
    if (channels[i]) {
      Suspect& one = suspects.emplace_back();
      one.sources = {source_of(static_cast<PulseChannel>(i))};
      one.omitted.channels.set(i);
    }
  }
  bool has_beam = false;
  for (const Side side : kSides) {
    const PulseChannel in = kInChannels.at(index_of(side));
    const PulseChannel out = kOutChannels.at(index_of(side));
    has_beam = has_beam || channels[index_of(in)] || channels[index_of(out)];
    if (channels[index_of(in)] && channels[index_of(out)]) {
      Suspect& beam = suspects.emplace_back();
      beam.sources = {source_of(in), source_of(out)};
      beam.omitted.channels.set(index_of(in)).set(index_of(out));
    }
  }
  if (has_beam) {
    suspects.push_back(
        {.sources = {SampleSource::OrbitState}, .omitted = {.channels = {}, .orbit = true}});
  }
  return suspects;
}

/// Returns the suspects without which the rest agrees as well as without the best of them. A beam
/// is none where one of its channels suffices.
std::vector<Suspect> remaining(std::vector<Suspect> suspects, double least, double noise) {
  std::erase_if(suspects, [&](const Suspect& one) {
    return !one.fit || one.fit->squares > least + kClearly * noise;
  });
  std::vector<Suspect> few;
  std::copy_if(suspects.begin(), suspects.end(), std::back_inserter(few), [&](const Suspect& one) {
    return one.sources.size() == 1 ||
           std::none_of(suspects.begin(), suspects.end(), [&](const Suspect& other) {
             return other.sources.size() == 1 &&
                    std::find(one.sources.begin(), one.sources.end(), other.sources.front()) !=
                        one.sources.end();
           });
  });
  return few;
}

/// Returns by how much the sensor is off with the rest right.
NamedValue off_of(const Suspect& suspect) {
  if (suspect.omitted.orbit) {
    return {"offset_s", suspect.fit->late_s};
  }
  double off_rad = 0.0;
  for (const SampleSource source : suspect.sources) {
    const double of_one = std::abs(suspect.fit->off_rad.at(index_of(source)));
    off_rad = std::isnan(of_one) ? off_rad : std::max(off_rad, of_one);
  }
  return {"angle_deg", degrees(off_rad)};
}

std::vector<SampleSource> others_than(const Suspect& culprit, const std::vector<Suspect>& all) {
  std::vector<SampleSource> others;
  for (const Suspect& other : all) {
    const SampleSource source = other.sources.front();
    const bool is_new =
        std::find(others.begin(), others.end(), source) == others.end() &&
        std::find(culprit.sources.begin(), culprit.sources.end(), source) == culprit.sources.end();
    if (is_new && source != SampleSource::OrbitState) {
      others.push_back(source);
    }
  }
  return others;
}

/// Returns what contradicts what; empty if no single sensor explains it.
/// @param together Fit with all sensors.
std::optional<SensorContradiction> judge(const std::vector<Suspect>& suspects,
                                         const BlockFit& together, TaiTime since) {
  const Suspect* best = nullptr;
  for (const Suspect& one : suspects) {
    if (one.fit && (best == nullptr || one.fit->squares < best->fit->squares)) {
      best = &one;
    }
  }
  if (best == nullptr) {
    return std::nullopt;
  }
  const double least = best->fit->squares;
  // What no single sensor explains counts as noise.
  const double noise = std::max(1.0, least / std::max(best->fit->freedom, 1));
  const double gain = (together.squares - least) / noise;
  if (!(gain > kLeastGain)) {
    return std::nullopt;
  }
  const std::vector<Suspect> left = remaining(suspects, least, noise);
  SensorContradiction found{.culprit = {},
                            .with = {},
                            .off = off_of(left.front()),
                            .sigmas = std::sqrt(gain),
                            .since = since};
  if (left.size() == 1) {
    found.culprit = left.front().sources.front();
    found.with = others_than(left.front(), suspects);
  } else {
    for (const Suspect& one : left) {
      found.with.push_back(one.sources.front());
    }
  }
  return found;
}

}  // namespace

void ChannelContradictions::add(BlockUnderSky block) {
  blocks_.push_back(std::move(block));
  forget_old();
}

/// Keeps the last minute and, during a contradiction, blocks evenly spread since it began.
void ChannelContradictions::forget_old() {
  const TaiTime recent = blocks_.back().block.t - kRecent;
  while (!blocks_.empty() &&
         blocks_.front().block.t < (since_ ? std::min(*since_, recent) : recent)) {
    blocks_.pop_front();
  }
  if (blocks_.size() > kMostBlocks) {
    std::deque<BlockUnderSky> thinned;
    for (std::size_t i = 0; i < blocks_.size(); ++i) {
      if (blocks_[i].block.t >= recent || i % 2 == 0) {
        thinned.push_back(std::move(blocks_[i]));
      }
    }
    blocks_ = std::move(thinned);
  }
}

void ChannelContradictions::compare(const SpinConfig& config,
                                    std::span<const Eigen::Vector3d> known_icrf) {
  const TaiTime now = blocks_.back().block.t;
  if (since_ && compared_) {
    const double between_s = std::min(kGrown * seconds_between(*since_, now), kLongestBetween_s);
    if (seconds_between(*compared_, now) < between_s) {
      return;
    }
  }
  compared_ = now;
  std::vector<Eigen::Vector3d> starts{known_icrf.begin(), known_icrf.end()};
  starts.insert(starts.end(), last_icrf_.begin(), last_icrf_.end());
  const AxisFinder finder{config, std::move(starts), blocks_.back()};
  const Blocks all{blocks_.begin(), blocks_.end()};
  Blocks recent;
  std::copy_if(all.begin(), all.end(), std::back_inserter(recent),
               [&](const BlockUnderSky& one) { return one.block.t >= now - kRecent; });
  const auto of_recent = finder.best(recent, {});
  if (!of_recent || AxisFinder::agrees(*of_recent)) {
    since_.reset();
    found_.reset();
    last_icrf_.clear();
    return;
  }
  const auto together = recent.size() == all.size() ? of_recent : finder.best(all, {});
  std::vector<Suspect> suspects = suspects_in(all);
  last_icrf_.clear();
  for (Suspect& one : suspects) {
    one.fit = finder.best(all, one.omitted);
    if (one.fit && std::none_of(last_icrf_.begin(), last_icrf_.end(), [&](const auto& other) {
          return angle_between_rad(other, one.fit->axis_icrf) < kSameAxis_rad;
        })) {
      last_icrf_.push_back(one.fit->axis_icrf);
    }
  }
  since_ = since_.value_or(now);
  found_ = judge(suspects, together.value_or(*of_recent), *since_);
  if (!found_) {
    since_.reset();
  }
}

}  // namespace spindrift
