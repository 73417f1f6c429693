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
// Chance of a misfit by noise from which on a culprit is searched.
constexpr double kUnlikely = 1e-2;
// Chance by noise at which a contradiction ends.
constexpr double kLikely = 1e-3;
constexpr std::size_t kMostKept = 3;
// Ratio of the misfit to noise up to which the rest may be said to agree.
constexpr double kMostNoise = 4.0;

using Blocks = std::vector<BlockUnderSky>;

/// Holds what may be wrong, and how well the rest agrees.
struct Suspect {
  std::vector<SampleSource> sources;
  OmittedSensors omitted;
  std::optional<BlockFit> fit = {};
};

/// Returns whether noise explains the misfit.
bool fits(const BlockFit& fit, double noise) {
  return fit.freedom == 0 || fit.squares / noise < chi_square_beyond(kUnlikely, fit.freedom);
}

/// Finds the best axis from known ones and from all over the sky.
class AxisFinder {
 public:
  /// @param search_sky Whether to try axes all over the sky, too.
  AxisFinder(const SpinConfig& config, std::vector<Eigen::Vector3d> known_icrf,
             const BlockUnderSky& last, bool search_sky)
      : config_{config}, known_icrf_{std::move(known_icrf)} {
    if (search_sky || known_icrf_.empty()) {
      sky_.emplace(config, last);
    }
  }

  std::optional<BlockFit> best(const Blocks& blocks, const OmittedSensors& omitted) const {
    std::optional<BlockFit> best;
    const auto try_from = [&](const Eigen::Vector3d& start_icrf) {
      auto fit = fit_axis(config_, blocks, omitted, start_icrf);
      if (fit && (!best || fit->squares < best->squares)) {
        best = std::move(fit);
      }
    };
    std::for_each(known_icrf_.begin(), known_icrf_.end(), try_from);
    if (sky_ && (!best || !fits(*best, 1.0))) {
      const std::vector<Eigen::Vector3d> far = sky_->best(omitted);
      std::for_each(far.begin(), far.end(), try_from);
    }
    return best;
  }

 private:
  const SpinConfig& config_;
  std::vector<Eigen::Vector3d> known_icrf_;
  std::optional<SkyOfAxes> sky_;
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

/// Returns the chi-square beyond what noise makes.
double excess(const BlockFit& fit, double noise) { return fit.squares / noise - fit.freedom; }

/// Returns the suspects with their fits, the likeliest first.
std::vector<Suspect> examined(const AxisFinder& finder, const Blocks& blocks) {
  std::vector<Suspect> suspects = suspects_in(blocks);
  for (Suspect& one : suspects) {
    one.fit = finder.best(blocks, one.omitted);
  }
  std::erase_if(suspects, [](const Suspect& one) { return !one.fit; });
  std::stable_sort(suspects.begin(), suspects.end(), [](const Suspect& one, const Suspect& other) {
    return excess(*one.fit, 1.0) < excess(*other.fit, 1.0);
  });
  return suspects;
}

/// Returns the suspects without which the rest agrees as well as without the best of them. A beam
/// is none where one of its channels suffices.
std::vector<Suspect> remaining(std::vector<Suspect> suspects, double least, double noise) {
  std::erase_if(suspects, [&](const Suspect& one) {
    return (excess(*one.fit, noise) > least + kClearly && !fits(*one.fit, noise));
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
  std::sort(others.begin(), others.end());
  return others;
}

/// Returns what contradicts what; empty if no single sensor explains it.
/// @param together Fit with all sensors. @param chance Chance by which noise may explain it.
/// @param suspects The likeliest first.
std::optional<SensorContradiction> judge(const std::vector<Suspect>& suspects,
                                         const BlockFit& together, double chance, TaiTime since) {
  if (suspects.empty()) {
    return std::nullopt;
  }
  const Suspect* const best = &suspects.front();
  // The misfit that no single sensor explains counts as noise.
  const double noise = std::max(1.0, best->fit->squares / std::max(best->fit->freedom, 1));
  const double gain = (together.squares - best->fit->squares) / noise;
  if (!(gain > chi_square_beyond(chance, std::max(together.freedom - best->fit->freedom, 1)))) {
    return std::nullopt;
  }
  const double least = excess(*best->fit, noise);
  // Where no single sensor explains most of the misfit, the two that explain most of it are named.
  const std::vector<Suspect> left =
      noise > kMostNoise
          ? std::vector(suspects.begin(),
                        suspects.begin() + std::min<std::ptrdiff_t>(2, std::ssize(suspects)))
          : remaining(suspects, least, noise);
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
    std::sort(found.with.begin(), found.with.end());
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
  const AxisFinder finder{config, std::move(starts), blocks_.back(), search_sky(now)};
  const auto agreeing = finder.best(without(accused_, now - kRecent), {});
  if (!agreeing || fits(*agreeing, 1.0)) {
    end();
    return;
  }
  const Blocks all{blocks_.begin(), blocks_.end()};
  const auto together = finder.best(all, {});
  const std::vector<Suspect> suspects = examined(finder, all);
  since_ = since_.value_or(now);
  found_ = judge(suspects, *together, found_ ? kLikely : kContradictionChance, *since_);
  if (!found_) {
    end();
    return;
  }
  accused_ = suspects.front().omitted;
  last_icrf_.clear();
  for (std::size_t i = 0; i < std::min(suspects.size(), kMostKept); ++i) {
    last_icrf_.push_back(suspects[i].fit->axis_icrf);
  }
}

/// Returns the blocks where the sensors that were wrong up to `recent` do not count until then: if
/// all agree in them, these sensors are right again.
std::vector<BlockUnderSky> ChannelContradictions::without(const OmittedSensors& accused,
                                                          TaiTime recent) const {
  Blocks blocks{blocks_.begin(), blocks_.end()};
  for (BlockUnderSky& one : blocks) {
    if (one.block.t < recent) {
      std::erase_if(one.block.points, [&](const ChannelPoint& point) {
        const PulseChannel channel = point.edge.channel;
        return accused.channels[index_of(channel)] || (accused.orbit && !sees_the_sun(channel));
      });
    }
  }
  return blocks;
}

/// Returns whether to search the whole sky, which is slow: again and again before a contradiction
/// is found, then whenever its span has doubled.
bool ChannelContradictions::search_sky(TaiTime now) {
  const bool is_due = !since_ || !searched_ || now - *since_ >= 2 * (*searched_ - *since_);
  if (is_due) {
    searched_ = now;
  }
  return is_due;
}

void ChannelContradictions::end() {
  since_.reset();
  found_.reset();
  searched_.reset();
  last_icrf_.clear();
  accused_ = {};
}

}  // namespace spindrift
