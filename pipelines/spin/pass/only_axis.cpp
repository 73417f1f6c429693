#include "pipelines/spin/pass/only_axis.h"

#include <algorithm>
#include <span>
#include <utility>

#include "pipelines/frames/angle.h"
#include "pipelines/frames/celestial.h"
#include "pipelines/frames/sphere_spiral.h"
#include "pipelines/statistics/significance.h"

namespace spindrift {
namespace {

constexpr std::size_t kMostBlocks = 48;
// The starting axes over the sky are 14 deg apart.
constexpr int kPlaces = 200;
// Two fits that end within this angle are of one axis.
constexpr double kSameEnd_rad = kRadPerDeg;
constexpr std::size_t kTried = 12;
// Chi-square by which the only axis is e^20 times as likely as any other.
constexpr double kBeyondDoubt = 40.0;

/// Returns the distinct axes at which fits to the blocks end, best first.
std::vector<BlockFit> ends_from(const SpinConfig& config, std::span<const BlockUnderSky> blocks,
                                std::span<const Eigen::Vector3d> starts_icrf) {
  std::vector<BlockFit> all;
  for (const Eigen::Vector3d& start_icrf : starts_icrf) {
    if (const auto end = fit_axis(config, blocks, {}, start_icrf)) {
      all.push_back(*end);
    }
  }
  std::stable_sort(all.begin(), all.end(), [](const BlockFit& one, const BlockFit& other) {
    return one.squares < other.squares;
  });
  std::vector<BlockFit> distinct;
  for (const BlockFit& end : all) {
    if (std::none_of(distinct.begin(), distinct.end(), [&](const BlockFit& other) {
          return angle_between_rad(end.axis_icrf, other.axis_icrf) < kSameEnd_rad;
        })) {
      distinct.push_back(end);
    }
  }
  return distinct;
}

/// Returns the ends of fits from all over the sky to three of the blocks.
std::vector<Eigen::Vector3d> coarse_axes(const SpinConfig& config,
                                         const std::vector<BlockUnderSky>& blocks) {
  const std::vector<BlockUnderSky> few{blocks.front(), blocks[blocks.size() / 2], blocks.back()};
  std::vector<Eigen::Vector3d> places;
  for (int i = 0; i < kPlaces; ++i) {
    places.push_back(place_on_spiral(i, kPlaces));
  }
  std::vector<Eigen::Vector3d> axes_icrf;
  for (const BlockFit& end : ends_from(config, few, places)) {
    if (axes_icrf.size() < kTried) {
      axes_icrf.push_back(end.axis_icrf);
    }
  }
  return axes_icrf;
}

}  // namespace

void OnlyAxis::add(BlockUnderSky block) {
  ++added_;
  blocks_.push_back(std::move(block));
  if (blocks_.size() > kMostBlocks) {
    std::vector<BlockUnderSky> thinned;
    for (std::size_t i = 0; i < blocks_.size(); i += 2) {
      thinned.push_back(std::move(blocks_[i]));
    }
    blocks_ = std::move(thinned);
  }
}

std::optional<Eigen::Vector3d> OnlyAxis::search(const SpinConfig& config) {
  if (added_ < due_at_) {
    return std::nullopt;
  }
  due_at_ = added_ + added_ / 4;
  const std::vector<BlockFit> ends = ends_from(config, blocks_, coarse_axes(config, blocks_));
  if (ends.empty() || !noise_is_as_stated(ends.front().squares, ends.front().freedom) ||
      (ends.size() > 1 && ends[1].squares - ends[0].squares < kBeyondDoubt)) {
    return std::nullopt;
  }
  return ends.front().axis_icrf;
}

}  // namespace spindrift
