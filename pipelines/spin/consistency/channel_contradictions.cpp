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
// Contradiction in sigmas from which on the past of a sensor is held against it: a weaker one may
// be a motion of the axis that looks alike.
constexpr double kStrong = 20.0;
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

/// Returns whether the sensors beyond the rest add no more misfit than noise does.
bool are_alike(const BlockFit& with_them, const BlockFit& rest) {
  const double noise = std::max(1.0, rest.squares / std::max(rest.freedom, 1));
  const int more = with_them.freedom - rest.freedom;
  return noise <= kMostNoise && (more <= 0 || (with_them.squares - rest.squares) / noise <
                                                  chi_square_beyond(kUnlikely, more));
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
  const BlockFit::Azimuths mean_rad = mean_of(suspect.fit->off_rad);
  for (const SampleSource source : suspect.sources) {
    const double of_one = std::abs(mean_rad.at(index_of(source)));
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

/// Returns whether another axis in the newest block explains clearly more than any wrong sensor.
bool has_moved(const AxisFinder& finder, const Blocks& blocks,
               const std::vector<Suspect>& suspects) {
  if (suspects.empty() || fits(*suspects.front().fit, 1.0)) {
    return false;
  }
  const auto before = finder.best({blocks.begin(), std::prev(blocks.end())}, {});
  const auto now = finder.best({blocks.back()}, {});
  return before && now &&
         excess(*before, 1.0) + excess(*now, 1.0) + kClearly < excess(*suspects.front().fit, 1.0);
}

struct Verdict {
  SensorContradiction contradiction;
  std::vector<Suspect> accused;  ///< Any of them may be wrong; empty if none of them explains it.
};

/// Returns what contradicts what; empty if noise explains it.
/// @param together Fit with all sensors. @param chance Chance by which noise may explain it.
/// @param suspects The likeliest first.
std::optional<Verdict> judge(const std::vector<Suspect>& suspects, const BlockFit& together,
                             double chance, TaiTime since) {
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
  const bool is_explained = noise <= kMostNoise;
  const std::vector<Suspect> left =
      is_explained ? remaining(suspects, least, noise)
                   : std::vector(suspects.begin(), suspects.begin() + std::min<std::ptrdiff_t>(
                                                                          2, std::ssize(suspects)));
  Verdict verdict{.contradiction = {.culprit = {},
                                    .with = {},
                                    .off = off_of(left.front()),
                                    .sigmas = std::sqrt(gain),
                                    .since = since},
                  .accused = is_explained ? left : std::vector<Suspect>{}};
  SensorContradiction& found = verdict.contradiction;
  if (left.size() == 1) {
    found.culprit = left.front().sources.front();
    found.with = others_than(left.front(), suspects);
  } else {
    for (const Suspect& one : left) {
      found.with.push_back(one.sources.front());
    }
    std::sort(found.with.begin(), found.with.end());
  }
  return verdict;
}

/// Returns the blocks where those that were wrong count in the newest ones only.
Blocks without(Blocks blocks, const OmittedSensors& wrong, std::ptrdiff_t newest) {
  std::for_each(blocks.begin(), blocks.end() - newest, [&](BlockUnderSky& one) {
    std::erase_if(one.block.points, [&](const ChannelPoint& point) {
      const PulseChannel channel = point.edge.channel;
      return wrong.channels[index_of(channel)] || (wrong.orbit && !sees_the_sun(channel));
    });
  });
  return blocks;
}

/// Returns whether the channels are nearer to where they were before they were wrong than to where
/// they were then, by the fit without them: whatever its axis, that tells the one from the other.
/// @param since Number of blocks since they were wrong. @param newest Number of those of now.
bool are_back(const BlockFit& fit, const OmittedSensors& wrong, std::ptrdiff_t since,
              std::ptrdiff_t newest) {
  const auto begin = fit.off_rad.end() - since;
  const auto now = fit.off_rad.end() - newest;
  const BlockFit::Azimuths right_rad = mean_of({fit.off_rad.begin(), begin});
  const BlockFit::Azimuths wrong_rad = mean_of({begin, now});
  const BlockFit::Azimuths now_rad = mean_of({now, fit.off_rad.end()});
  double to_right_rad = 0.0;
  double to_wrong_rad = 0.0;
  for (std::size_t i = 0; i < kPulseChannels; ++i) {
    if (wrong.channels[i]) {
      to_right_rad += std::abs(wrapped_rad(now_rad.at(i) - right_rad.at(i)));
      to_wrong_rad += std::abs(wrapped_rad(now_rad.at(i) - wrong_rad.at(i)));
    }
  }
  return !(to_right_rad > to_wrong_rad);
}

}  // namespace

void ChannelContradictions::add(BlockUnderSky block) {
  blocks_.push_back(std::move(block));
  forget_old();
}

bool ChannelContradictions::is_due() const {
  const auto lately = std::min<std::ptrdiff_t>(2, std::ssize(blocks_));
  return found_ || std::any_of(blocks_.end() - lately, blocks_.end(),
                               [](const BlockUnderSky& one) { return one.block.has_shifted; });
}

/// Keeps the last minute and, during a contradiction, the minute before it and blocks evenly spread
/// since it began.
void ChannelContradictions::forget_old() {
  const TaiTime recent = blocks_.back().block.t - kRecent;
  while (blocks_.front().block.t < (since_ ? std::min(*since_ - kRecent, recent) : recent)) {
    blocks_.pop_front();
  }
  if (blocks_.size() > kMostBlocks) {
    std::deque<BlockUnderSky> thinned;
    for (std::size_t i = 0; i < blocks_.size(); ++i) {
      const TaiTime t = blocks_[i].block.t;
      if (t >= recent || t < since_ || i % 2 == 0) {
        thinned.push_back(std::move(blocks_[i]));
      }
    }
    blocks_ = std::move(thinned);
  }
}

void ChannelContradictions::compare(const SpinConfig& config,
                                    std::span<const Eigen::Vector3d> known_icrf) {
  if (accuse_noisy()) {
    return;
  }
  const TaiTime now = blocks_.back().block.t;
  std::vector<Eigen::Vector3d> starts{known_icrf.begin(), known_icrf.end()};
  starts.insert(starts.end(), last_icrf_.begin(), last_icrf_.end());
  if (found_ && agree_again(config, starts)) {
    end();
    return;
  }
  if (since_ && compared_) {
    const double between_s = std::min(kGrown * seconds_between(*since_, now), kLongestBetween_s);
    if (seconds_between(*compared_, now) < between_s) {
      return;
    }
  }
  compared_ = now;
  const AxisFinder finder{config, std::move(starts), blocks_.back(), search_sky(now)};
  const Blocks all{blocks_.begin(), blocks_.end()};
  const auto together = finder.best(all, {});
  if (!together || fits(*together, 1.0)) {
    end();
    return;
  }
  since_ = since_.value_or(now);
  const std::vector<Suspect> suspects = examined(finder, all);
  if (has_moved(finder, all, suspects)) {
    blocks_.erase(blocks_.begin(), std::prev(blocks_.end()));
    end();
    return;
  }
  auto verdict = judge(suspects, *together, found_ ? kLikely : kContradictionChance, *since_);
  if (!verdict) {
    end();
    return;
  }
  found_ = std::move(verdict->contradiction);
  accused_.clear();
  for (const Suspect& one : verdict->accused) {
    accused_.push_back(one.omitted);
  }
  last_icrf_.clear();
  for (std::size_t i = 0; i < std::min(suspects.size(), kMostKept); ++i) {
    last_icrf_.push_back(suspects[i].fit->axis_icrf);
  }
}

/// Returns whether the same channel scatters alone in the newest two blocks, and then accuses it.
bool ChannelContradictions::accuse_noisy() {
  const ChannelBlock& newest = blocks_.back().block;
  const auto& noisy = newest.noisy;
  if (!noisy || blocks_.size() < 2) {
    return false;
  }
  const ChannelBlock& before = blocks_[blocks_.size() - 2].block;
  if (!before.noisy || before.noisy->channel != noisy->channel) {
    return false;
  }
  since_ = since_.value_or(before.t);
  found_ = SensorContradiction{.culprit = source_of(noisy->channel),
                               .with = {},
                               .off = {"angle_deg", degrees(newest.rate_rad_s * noisy->scatter_s)},
                               .sigmas = noisy->scatter_s / noisy->stated_s,
                               .since = *since_};
  accused_ = {{}};
  for (const ChannelPoint& point : newest.points) {
    if (are_of_one_sensor(noisy->channel, point.edge.channel)) {
      accused_.front().channels.set(index_of(point.edge.channel));
    } else {
      found_->with.push_back(source_of(point.edge.channel));
    }
  }
  return true;
}

/// Returns whether the sensors agree in so many of the newest blocks as would show the
/// contradiction by themselves if it lasted, and then forgets what was wrong before. If no single
/// sensor explains it, the body itself may have moved: then only the newest blocks have to agree.
bool ChannelContradictions::agree_again(const SpinConfig& config,
                                        const std::vector<Eigen::Vector3d>& starts_icrf) {
  const AxisFinder finder{config, starts_icrf, blocks_.back(), false};
  const auto since =
      std::count_if(blocks_.begin(), blocks_.end(),
                    [this](const BlockUnderSky& one) { return one.block.t >= *since_; });
  const double share = std::pow(kContradictionSigmas / found_->sigmas, 2);
  const auto newest =
      std::clamp(static_cast<std::ptrdiff_t>(std::ceil(share * static_cast<double>(since))),
                 std::ptrdiff_t{2}, std::ssize(blocks_));
  if (newest >= since) {
    return false;
  }
  const Blocks all{blocks_.begin(), blocks_.end()};
  if (accused_.empty()) {
    const auto fit = finder.best({all.end() - newest, all.end()}, {});
    if (!fit || !fits(*fit, 1.0)) {
      return false;
    }
    blocks_.erase(blocks_.begin(), blocks_.end() - newest);
    return true;
  }
  for (const OmittedSensors& wrong : accused_) {
    Blocks blocks = without(all, wrong, newest);
    const auto rest = finder.best(wrong.orbit ? blocks : all, wrong);
    const auto with_it = finder.best(blocks, {});
    if (rest && with_it && are_alike(*with_it, *rest) &&
        (found_->sigmas < kStrong || are_back(*rest, wrong, since, newest))) {
      blocks_.assign(std::make_move_iterator(blocks.begin()),
                     std::make_move_iterator(blocks.end()));
      return true;
    }
  }
  return false;
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
  accused_.clear();
}

}  // namespace spindrift
