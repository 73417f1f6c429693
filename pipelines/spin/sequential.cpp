#include "pipelines/spin/sequential.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>

#include "pipelines/frames/celestial.h"

namespace spindrift {
namespace {

constexpr double kDegree_rad = std::numbers::pi / 180.0;

// A fix may rest on the spherical horizon: the ellipsoid's limb lies up to 1/298 rad inside.
constexpr double kFlattening_rad = 1.0 / 298.257;
// A fix so poor is no place to linearise at.
constexpr double kPoorestFix_rad = 10.0 * kDegree_rad;
// Across a silence in which the phase became this uncertain, whole turns can no longer be counted:
// phase and rate start anew.
constexpr double kPhaseLost_rad = 0.3;
// Weight of one edge, or of one revolution, in the share of gated ones.
constexpr double kRecentEdge = 1.0 / 60.0;
constexpr double kRecentRevolution = 0.1;
constexpr double kMostGated = 0.5;
// A candidate is out when the edges are e^20 times likelier under another one, which must fit them
// itself: the mean of its squared innovations is 1 when it is true, and one edge in twenty that is
// spurious adds 0.8.
constexpr double kBeyondDoubt = 20.0;
constexpr double kWorstFit = 2.0;
// A fix contradicts the filter beyond so many sigmas of both, and beyond what may be wrong with
// either model.
constexpr double kContradictionSigmas = 5.0;
constexpr double kModel_rad = 0.5 * kDegree_rad;
constexpr int kMostContradictions = 10;

bool contradicts(const SpinFix& fix, const SpinFilter& filter) {
  const Eigen::Vector3d axis = filter.axis_icrf();
  const double apart_rad = angle_between_rad(axis, fix.axis_icrf);
  const Eigen::Vector2d towards = tangent_basis(axis).transpose() * (fix.axis_icrf - axis);
  const double length = towards.norm();
  if (apart_rad <= kModel_rad || !(length > 0.0)) {
    return apart_rad > kModel_rad;
  }
  const Eigen::Vector2d apart = towards * (apart_rad / length);
  const Eigen::Matrix2d covariance = fix.covariance_rad2 + filter.axis_covariance_rad2();
  return apart.dot(covariance.ldlt().solve(apart)) > kContradictionSigmas * kContradictionSigmas;
}

/// Both filters have come to one axis.
bool agree(const SpinFilter& a, const SpinFilter& b) {
  const double apart_rad = angle_between_rad(a.axis_icrf(), b.axis_icrf());
  return apart_rad < kModel_rad &&
         apart_rad * apart_rad <
             std::min(a.axis_covariance_rad2().trace(), b.axis_covariance_rad2().trace());
}

const SpinFix* last_accepted(std::span<const SpinFix> fixes) {
  const auto found =
      std::find_if(fixes.rbegin(), fixes.rend(), [](const SpinFix& fix) { return fix.accepted; });
  return found == fixes.rend() ? nullptr : &*found;
}

const SpinFix* last_ambiguous(std::span<const SpinFix> fixes) {
  const auto found = std::find_if(fixes.rbegin(), fixes.rend(), [](const SpinFix& fix) {
    return fix.resolution == Resolution::Ambiguous && !fix.grazing;
  });
  return found == fixes.rend() ? nullptr : &*found;
}

}  // namespace

std::optional<SpinEstimate> SequentialEstimator::update(const Revolution& revolution,
                                                        const Sky& sky,
                                                        std::span<const SpinFix> settled) {
  const SpinFix* const accepted = last_accepted(settled);
  const bool restart = restart_is_due(settled);
  if (hypotheses_.empty() || restart) {
    const SpinFix* const first = accepted != nullptr ? accepted : last_ambiguous(settled);
    if (first != nullptr) {
      start(*first, revolution, sky);
    }
  } else {
    if (accepted != nullptr && hypotheses_.size() > 1) {
      take_side(*accepted);
    }
    work_in(revolution, sky);
  }
  if (hypotheses_.empty()) {
    return std::nullopt;
  }
  const SpinFilter& best = hypotheses_.front().filter;
  return SpinEstimate{.t = revolution.t_start,
                      .estimator = SpinEstimator::Sequential,
                      .axis_icrf = best.axis_icrf(),
                      .covariance_rad2 = best.axis_covariance_rad2(),
                      .spin_rate_rad_s = best.rate_rad_s(),
                      .spin_rate_sigma_rad_s = best.rate_sigma_rad_s(),
                      .status = status()};
}

/// Only an accepted fix may start the filter again.
bool SequentialEstimator::restart_is_due(std::span<const SpinFix> settled) {
  if (hypotheses_.empty()) {
    return false;
  }
  for (const SpinFix& fix : settled) {
    if (fix.accepted) {
      const bool against = std::all_of(hypotheses_.begin(), hypotheses_.end(),
                                       [&](const auto& h) { return contradicts(fix, h.filter); });
      contradicted_ = std::max(0, contradicted_ + (against ? 1 : -1));
    }
  }
  if (last_accepted(settled) == nullptr) {
    return false;
  }
  if (gated_share_ > kMostGated) {
    restarted_ = "edges gated";
    return true;
  }
  if (contradicted_ >= kMostContradictions) {
    restarted_ = "fixes differ";
    return true;
  }
  return false;
}

void SequentialEstimator::start(const SpinFix& fix, const Revolution& revolution, const Sky& sky) {
  std::vector<Hypothesis> started;
  const auto add = [&](const Eigen::Vector3d& axis_icrf, Eigen::Matrix2d axis_rad2) {
    if (config_.horizon.model == HorizonModel::Ellipsoid) {
      axis_rad2 += kFlattening_rad * kFlattening_rad * Eigen::Matrix2d::Identity();
    }
    if (axis_rad2.trace() < kPoorestFix_rad * kPoorestFix_rad) {
      if (const auto filter = SpinFilter::about(axis_icrf, axis_rad2, config_, revolution, sky)) {
        started.push_back({.filter = *filter});
      }
    }
  };
  add(fix.axis_icrf, fix.covariance_rad2);
  if (fix.resolution == Resolution::Ambiguous) {
    for (std::size_t i = 0; i < fix.alternate_axes_icrf.size(); ++i) {
      add(fix.alternate_axes_icrf[i], fix.alternate_covariances_rad2[i]);
    }
    // Without one of them the true one may be missing.
    if (started.size() != 1 + fix.alternate_axes_icrf.size()) {
      return;
    }
  }
  if (!started.empty()) {
    restarts_ += hypotheses_.empty() ? 0 : 1;
    hypotheses_ = std::move(started);
    revolutions_ = 0;
    gated_ = 0;
    gated_share_ = 0.0;
    channel_gated_share_ = {};
    contradicted_ = 0;
  }
}

/// A fix settles which of the candidates is true, unless it contradicts them all.
void SequentialEstimator::take_side(const SpinFix& fix) {
  const auto nearest = std::max_element(
      hypotheses_.begin(), hypotheses_.end(), [&](const Hypothesis& a, const Hypothesis& b) {
        return a.filter.axis_icrf().dot(fix.axis_icrf) < b.filter.axis_icrf().dot(fix.axis_icrf);
      });
  if (!contradicts(fix, nearest->filter)) {
    std::swap(hypotheses_.front(), *nearest);
    hypotheses_.erase(hypotheses_.begin() + 1, hypotheses_.end());
  }
}

void SequentialEstimator::work_in(const Revolution& revolution, const Sky& sky) {
  const GoodEdges edges{revolution};
  for (Hypothesis& hypothesis : hypotheses_) {
    SpinFilter& filter = hypothesis.filter;
    filter.predict(revolution.t_start);
    if (filter.phase_sigma_rad() > kPhaseLost_rad) {
      filter = SpinFilter::about(filter.axis_icrf(), filter.axis_covariance_rad2(), config_,
                                 revolution, sky)
                   .value_or(filter);
      hypothesis.tally = {};
    } else {
      hypothesis.tally = filter.update(config_, sky, edges.span());
    }
    const EdgeTally& tally = hypothesis.tally;
    hypothesis.edges += static_cast<double>(tally.accepted.count() + tally.gated.count());
    hypothesis.log_likelihood += tally.log_likelihood;
    hypothesis.squared_innovations += tally.squared_innovations;
  }
  drop_the_beaten();
  count(hypotheses_.front().tally);
}

void SequentialEstimator::drop_the_beaten() {
  std::stable_sort(hypotheses_.begin(), hypotheses_.end(), [](const auto& a, const auto& b) {
    return a.log_likelihood > b.log_likelihood;
  });
  const Hypothesis best = hypotheses_.front();
  const bool fits = best.squared_innovations < kWorstFit * best.edges;
  const auto beaten = [&](const Hypothesis& other) {
    return agree(best.filter, other.filter) ||
           (fits && best.log_likelihood - other.log_likelihood > kBeyondDoubt);
  };
  hypotheses_.erase(std::remove_if(hypotheses_.begin() + 1, hypotheses_.end(), beaten),
                    hypotheses_.end());
}

void SequentialEstimator::count(const EdgeTally& tally) {
  const auto gated = static_cast<double>(tally.gated.count());
  const double edges = gated + static_cast<double>(tally.accepted.count());
  gated_share_ += kRecentEdge * (gated - edges * gated_share_);
  // Of the first revolutions the plain mean: what starts wrong says so at once.
  const double recent = std::max(kRecentRevolution, 1.0 / static_cast<double>(revolutions_ + 1));
  for (std::size_t channel = 0; channel < kPulseChannels; ++channel) {
    double& share = channel_gated_share_.at(channel);
    share += recent * ((tally.gated.test(channel) ? 1.0 : 0.0) - share);
  }
  gated_ += static_cast<std::int64_t>(tally.gated.count());
  ++revolutions_;
}

std::string SequentialEstimator::status() const {
  if (gated_share_ > kMostGated) {
    return fmt::format("LOST, {} edges gated, awaiting a fix", gated_);
  }
  if (hypotheses_.size() > 1) {
    const RaDec other = ra_dec_of(hypotheses_[1].filter.axis_icrf());
    return fmt::format("AMBIGUOUS, or ra {:.2f} dec {:.2f} deg, {} revolutions",
                       other.ra_rad / kDegree_rad, other.dec_rad / kDegree_rad, revolutions_);
  }
  const auto* const worst =
      std::max_element(channel_gated_share_.begin(), channel_gated_share_.end());
  if (*worst > kMostGated) {
    return fmt::format("DOUBTFUL, most {} edges gated, {} revolutions",
                       kPulseChannelNames.at(static_cast<std::size_t>(
                           std::distance(channel_gated_share_.begin(), worst))),
                       revolutions_);
  }
  const std::string counts =
      fmt::format("OK, {} revolutions, {} edges gated", revolutions_, gated_);
  return restarted_.empty() ? counts : fmt::format("{}, restart: {}", counts, restarted_);
}

}  // namespace spindrift
