#include "pipelines/spin/batch/sky_search.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <utility>

#include "pipelines/frames/angle.h"
#include "pipelines/frames/celestial.h"
#include "pipelines/frames/sphere_spiral.h"
#include "pipelines/spin/batch/batch_fit.h"
#include "pipelines/spin/batch/evaluated_fit.h"
#include "pipelines/spin/batch/initial_state.h"

namespace spindrift {
namespace {

// Two ends within this angle are the same axis.
constexpr double kSameEnd_rad = kRadPerDeg;
constexpr int kAboutSun = 32;
// The starting axes over the sky are 14 deg apart.
constexpr int kOverSky = 200;
constexpr std::size_t kSample = 400;
constexpr std::size_t kTried = 12;
constexpr std::size_t kMost = 4;
// A rival may fit the sample worse by this much, because a few outliers in a sample decide nothing.
constexpr double kNearly = 100.0;

/// Samples by the golden ratio: a fixed stride would pick one channel where the channels alternate.
std::vector<PassEdge> sample_of(std::span<const PassEdge> edges) {
  const double share = static_cast<double>(kSample) / static_cast<double>(edges.size());
  std::vector<PassEdge> sample;
  for (std::size_t i = 0; i < edges.size(); ++i) {
    const double turned = kGolden * static_cast<double>(i);
    if (turned - std::floor(turned) < share) {
      sample.push_back(edges[i]);
    }
  }
  return sample;
}

/// Returns axes over the whole sky, and denser ones about the Sun and opposite to it, where the
/// Sun's azimuth turns fast and a fit must begin nearer.
std::vector<Eigen::Vector3d> places_about(const Eigen::Vector3d& sun_icrf) {
  std::vector<Eigen::Vector3d> places;
  places.reserve(kOverSky + 2 * kAboutSun);
  for (int i = 0; i < kOverSky; ++i) {
    places.push_back(place_on_spiral(i, kOverSky));
  }
  const Eigen::Vector3d across = sun_icrf.unitOrthogonal();
  for (int i = 0; i < kAboutSun; ++i) {
    const double off_rad = (3.0 + 3.0 * (i % 4)) * kRadPerDeg;
    const Eigen::AngleAxisd about{kTurn_rad * i / kAboutSun, sun_icrf};
    const Eigen::Vector3d place = about * (Eigen::AngleAxisd{off_rad, across} * sun_icrf);
    places.push_back(place);
    places.emplace_back(-place);
  }
  return places;
}

double misfit_of(const PassModel& model, std::span<const PassEdge> edges, const SpinState& state,
                 BiasSet estimated) {
  return evaluated(model, edges, {.state = state, .at_bound = {}, .iterations = 0}, estimated)
      .misfit();
}

struct End {
  SpinState state;
  double misfit;
};

/// Sorts the ends by misfit and keeps each axis once.
void put_in_order(std::vector<End>& ends) {
  std::stable_sort(ends.begin(), ends.end(),
                   [](const End& one, const End& other) { return one.misfit < other.misfit; });
  std::vector<End> distinct;
  for (End& end : ends) {
    if (std::none_of(distinct.begin(), distinct.end(), [&](const End& other) {
          return angle_between_rad(end.state.axis_icrf(), other.state.axis_icrf()) < kSameEnd_rad;
        })) {
      distinct.push_back(std::move(end));
    }
  }
  ends = std::move(distinct);
}

/// Returns the ends of coarse fits from all starting places.
std::vector<End> ends_in(const PassModel& model, std::span<const PassEdge> sample,
                         BiasSet estimated) {
  const Eigen::Vector3d sun_icrf = model.sky_at(model.middle()).sun_icrf.normalized();
  std::vector<End> ends;
  for (const Eigen::Vector3d& place : places_about(sun_icrf)) {
    if (const auto near = initial_state(model, sample, place)) {
      const SpinState end = coarse_fit(model, sample, *near, estimated);
      ends.push_back({.state = end, .misfit = misfit_of(model, sample, end, estimated)});
    }
  }
  put_in_order(ends);
  return ends;
}

}  // namespace

std::vector<Eigen::Vector3d> competing_axes(const SpinState& state, const PassModel& model,
                                            std::span<const PassEdge> edges, BiasSet estimated) {
  const std::vector<PassEdge> sample = sample_of(edges);
  const double most = misfit_of(model, sample, state, estimated) + kNearly;
  std::vector<End> ends = ends_in(model, sample, estimated);
  ends.resize(std::min(ends.size(), kTried));
  for (End& end : ends) {
    if (const auto settled = explain(model, sample, end.state, estimated)) {
      end = {.state = settled->fit.state, .misfit = settled->misfit()};
    }
  }
  put_in_order(ends);
  std::vector<Eigen::Vector3d> axes;
  for (const End& end : ends) {
    const bool is_other =
        angle_between_rad(end.state.axis_icrf(), state.axis_icrf()) > kSameEnd_rad;
    if (is_other && end.misfit < most && axes.size() < kMost) {
      axes.push_back(end.state.axis_icrf());
    }
  }
  return axes;
}

}  // namespace spindrift
