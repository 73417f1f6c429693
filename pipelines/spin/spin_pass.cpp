#include "pipelines/spin/spin_pass.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>
#include <utility>

#include "pipelines/frames/celestial.h"
#include "pipelines/spin/geometry.h"

namespace spindrift {
namespace {

/// What became of one measurement.
struct Verdict {
  SpinQuantity quantity;
  std::optional<Rejection> rejected_by;
};

/// The measurements that each channel's edge goes into.
bool uses(SpinQuantity quantity, PulseChannel channel) {
  using enum SpinQuantity;
  switch (channel) {
    case PulseChannel::Sun1:
      return quantity == Period || quantity == SunAngle || quantity == NorthDihedral ||
             quantity == SouthDihedral;
    case PulseChannel::Sun2:
      return quantity == SunAngle;
    case PulseChannel::NorthIn:
    case PulseChannel::NorthOut:
      return quantity == NorthChord || quantity == NorthDihedral;
    case PulseChannel::SouthIn:
    case PulseChannel::SouthOut:
      return quantity == SouthChord || quantity == SouthDihedral;
  }
  return false;
}

/// The other edge that makes a pair with this one.
PulseChannel partner_of(PulseChannel channel) {
  static constexpr std::array<PulseChannel, kPulseChannels> kPartners = {
      PulseChannel::Sun2,    PulseChannel::Sun1,     PulseChannel::NorthOut,
      PulseChannel::NorthIn, PulseChannel::SouthOut, PulseChannel::SouthIn};
  return kPartners.at(index_of(channel));
}

/// Why an edge went into no measurement at all.
Rejection without_use(const SpinConfig& config, const Revolution& revolution,
                      PulseChannel channel) {
  for (const Side side : kSides) {
    const bool of_side =
        channel == kInChannels.at(index_of(side)) || channel == kOutChannels.at(index_of(side));
    if (of_side && !sensor_of(config, side)) {
      return Rejection::NoSensor;
    }
  }
  return revolution.edge(partner_of(channel)) ? Rejection::Geometry : Rejection::Unpaired;
}

/// An edge is good when any measurement it went into is.
PulseUse use_of(const SpinConfig& config, const Revolution& revolution, PulseChannel channel,
                const std::vector<Verdict>& verdicts) {
  PulseUse use{.pulse = {.t = *revolution.edge(channel), .channel = channel},
               .revolution = revolution.number,
               .rejected_by = without_use(config, revolution, channel)};
  bool first = true;
  for (const Verdict& verdict : verdicts) {
    if (!uses(verdict.quantity, channel)) {
      continue;
    }
    if (!verdict.rejected_by) {
      use.rejected_by.reset();
      return use;
    }
    if (std::exchange(first, false)) {
      use.rejected_by = verdict.rejected_by;
    }
  }
  return use;
}

/// What the spherical horizon leaves out of an oblate Earth, as a covariance: taken as anywhere
/// between none and the whole displacement of the limb, in any direction. Unlike the noise of the
/// pulses it does not shrink with the number of fixes.
Eigen::Matrix2d horizon_error_rad2(const SpinConfig& config, double disc_rad) {
  if (config.horizon.model == HorizonModel::Sphere) {
    return Eigen::Matrix2d::Zero();
  }
  const double limb_rad = oblateness_rad(disc_rad);
  return Eigen::Matrix2d::Identity() * (limb_rad * limb_rad / 3.0 / 2.0);
}

Eigen::Vector3d median_axis(const std::vector<Eigen::Vector3d>& axes) {
  Eigen::Vector3d median;
  for (Eigen::Index i = 0; i < 3; ++i) {
    std::vector<double> components(axes.size());
    std::transform(axes.begin(), axes.end(), components.begin(),
                   [i](const Eigen::Vector3d& axis) { return axis[i]; });
    const auto middle = components.begin() + static_cast<std::ptrdiff_t>(components.size() / 2);
    std::nth_element(components.begin(), middle, components.end());
    median[i] = *middle;
  }
  return median.normalized();
}

}  // namespace

std::vector<std::string> settings_without_effect(const SpinConfig& config) {
  std::vector<std::string> settings;
  if (config.horizon.model == HorizonModel::Ellipsoid) {
    settings.emplace_back(
        "spin.horizon.model = \"ellipsoid\": the spherical horizon is used; sigma "
        "includes what that leaves out");
  }
  if (config.screening.interference_s > 0.0) {
    settings.emplace_back("spin.screening.interference_s has no effect yet");
  }
  if (config.prior) {
    settings.emplace_back("spin.prior has no effect yet: an ambiguous fix stays ambiguous");
  }
  for (const Side side : kSides) {
    if (const auto& sensor = sensor_of(config, side); sensor && sensor->healthy) {
      settings.emplace_back(fmt::format("spin.ir.{}.healthy has no effect yet",
                                        side == Side::North ? "north" : "south"));
    }
  }
  return settings;
}

SpinPass::SpinPass(const SpinConfig& config, Orbit orbit)
    : config_{config},
      orbit_{std::move(orbit)},
      associator_{config},
      screening_{config.screening},
      disambiguator_{config},
      recent_axes_{static_cast<std::size_t>(config.screening.window)} {}

SpinOutput SpinPass::push(const Pulse& pulse) {
  SpinOutput out;
  switch (reorder_.add(pulse)) {
    case ReorderWindow::Verdict::Held:
      associate(reorder_.release(), out);
      break;
    case ReorderWindow::Verdict::Late:
      leave_out(pulse, Rejection::Late, out);
      say_once("pulses arrive after their time was processed: they are stored and left out", out);
      break;
    case ReorderWindow::Verdict::OutOfTime:
      leave_out(pulse, Rejection::OutOfTime, out);
      break;
    case ReorderWindow::Verdict::Duplicate:
      break;  // The same edge once more: what becomes of it is said once.
  }
  return out;
}

SpinOutput SpinPass::push(const CodedFrame& frame) {
  SpinOutput out = push(Pulse{.t = frame.t, .channel = PulseChannel::Sun1});
  for (std::size_t channel = 0; channel < kPulseChannels; ++channel) {
    if (const auto& delay_s = frame.delay_s.at(channel)) {
      SpinOutput more = push(
          Pulse{.t = shifted(frame.t, *delay_s), .channel = static_cast<PulseChannel>(channel)});
      std::move(more.products.begin(), more.products.end(), std::back_inserter(out.products));
      std::move(more.notices.begin(), more.notices.end(), std::back_inserter(out.notices));
    }
  }
  return out;
}

SpinOutput SpinPass::finish() {
  SpinOutput out;
  const ReorderWindow::Rest rest = reorder_.release_all();
  associate(rest.in_time, out);
  take(associator_.finish(), out);
  if (!started_) {
    settle_first(out);
  }
  for (const Pulse& pulse : rest.out_of_time) {
    leave_out(pulse, Rejection::OutOfTime, out);
    say_once("pulses stamped far ahead of all others are left out: a sender's clock is wrong", out);
  }
  return out;
}

void SpinPass::leave_out(const Pulse& pulse, Rejection rejected_by, SpinOutput& out) {
  out.products.emplace_back(PulseUse{.pulse = pulse, .revolution = {}, .rejected_by = rejected_by});
}

void SpinPass::say_once(const std::string& notice, SpinOutput& out) {
  if (said_.insert(notice).second) {
    out.notices.push_back(notice);
  }
}

void SpinPass::associate(const std::vector<Pulse>& pulses, SpinOutput& out) {
  for (const Pulse& pulse : pulses) {
    take(associator_.push(pulse), out);
  }
}

void SpinPass::take(Association association, SpinOutput& out) {
  std::move(association.left_over.begin(), association.left_over.end(),
            std::back_inserter(out.products));
  for (const Revolution& revolution : association.closed) {
    consider(revolution, out);
  }
}

void SpinPass::consider(const Revolution& revolution, SpinOutput& out) {
  Candidate candidate{.revolution = revolution,
                      .measured = measure(config_, revolution),
                      .sightlines = {},
                      .residuals = {}};
  const auto* const first_edge = std::find_if(revolution.edges.begin(), revolution.edges.end(),
                                              [](const auto& edge) { return edge.has_value(); });
  candidate.sightlines = sightlines_of(candidate.measured, **first_edge, out);
  if (!started_) {
    first_.push_back(std::move(candidate));
    if (first_.size() >= kFirstRevolutions) {
      settle_first(out);
    }
    return;
  }
  if (const auto axis_icrf = recent_axes_.axis_icrf()) {
    predict(candidate, *axis_icrf);
  }
  settle(candidate, out);
}

void SpinPass::settle_first(SpinOutput& out) {
  started_ = true;
  std::vector<Eigen::Vector3d> axes_icrf;
  for (const Candidate& candidate : first_) {
    if (!candidate.sightlines) {
      continue;
    }
    if (const auto found = axis_candidates(config_, candidate.measured, *candidate.sightlines)) {
      axes_icrf.push_back(found->candidates.front().axis_icrf);
    }
  }
  if (!axes_icrf.empty()) {
    const Eigen::Vector3d axis_icrf = median_axis(axes_icrf);
    for (Candidate& candidate : first_) {
      predict(candidate, axis_icrf);
    }
  }
  for (Candidate& candidate : std::exchange(first_, {})) {
    settle(candidate, out);
  }
}

void SpinPass::predict(Candidate& candidate, const Eigen::Vector3d& axis_icrf) {
  if (candidate.sightlines) {
    candidate.residuals = residuals(config_, candidate.measured, *candidate.sightlines, axis_icrf);
    for (const Residual& residual : candidate.residuals) {
      screening_.add(residual);
    }
  }
}

void SpinPass::settle(Candidate& candidate, SpinOutput& out) {
  const Revolution& revolution = candidate.revolution;
  std::vector<Verdict> verdicts;
  const auto add = [&](SpinQuantity quantity, double value, double sigma,
                       std::optional<Rejection> rejected_by) {
    verdicts.push_back({.quantity = quantity, .rejected_by = rejected_by});
    if (rejected_by) {
      reject(candidate.measured, quantity, *rejected_by);
    }
    out.products.emplace_back(SpinMeasurement{.revolution = revolution.number,
                                              .quantity = quantity,
                                              .value = value,
                                              .sigma = sigma,
                                              .rejected_by = rejected_by});
  };

  if (candidate.measured.t_sun1) {
    out.products.emplace_back(RevolutionProduct{.revolution = revolution.number,
                                                .t_sun1 = *candidate.measured.t_sun1,
                                                .period_s = revolution.period.period_s});
  }
  if (const auto& period = revolution.period_candidate) {
    add(SpinQuantity::Period, period->period_s, period->sigma_s,
        period->accepted ? std::nullopt : std::optional{Rejection::Period});
  }
  for (const SpinQuantity quantity : kMeasuredAngles) {
    const auto measured = value_of(candidate.measured, quantity);
    if (!measured) {
      continue;
    }
    const auto residual = std::find_if(candidate.residuals.begin(), candidate.residuals.end(),
                                       [&](const Residual& r) { return r.quantity == quantity; });
    std::optional<Rejection> rejected_by = measured->rejected_by;
    if (!rejected_by && !candidate.sightlines) {
      rejected_by = Rejection::NoOrbit;
    } else if (!rejected_by && residual != candidate.residuals.end() &&
               !screening_.keeps(*residual)) {
      rejected_by = rejection_of(quantity);
    }
    add(quantity, measured->value_rad, measured->sigma_rad, rejected_by);
  }
  for (std::size_t channel = 0; channel < kPulseChannels; ++channel) {
    if (revolution.edges.at(channel)) {
      out.products.emplace_back(
          use_of(config_, revolution, static_cast<PulseChannel>(channel), verdicts));
    }
  }
  announce_axis(candidate, out);
}

void SpinPass::announce_axis(const Candidate& candidate, SpinOutput& out) {
  if (!candidate.sightlines) {
    return;
  }
  const auto found = axis_candidates(config_, candidate.measured, *candidate.sightlines);
  if (!found) {
    // The measurements stand; this revolution alone gives no axis.
    if (!std::exchange(fix_missed_, true)) {
      out.notices.push_back(fmt::format("revolution {} is the first that gives no fix: {}",
                                        candidate.revolution.number, found.error().message));
    }
    return;
  }
  const auto& edges = candidate.revolution.edges;
  const TaiTime first_edge =
      **std::find_if(edges.begin(), edges.end(), [](const auto& edge) { return edge.has_value(); });
  for (const SpinFix& fix : disambiguator_.settle(
           candidate.revolution.number, candidate.measured.t_sun1.value_or(first_edge),
           candidate.measured, *candidate.sightlines, *found, std::nullopt)) {
    announce(candidate, fix, out);
  }
}

void SpinPass::announce(const Candidate& candidate, const SpinFix& found, SpinOutput& out) {
  if (!found.accepted && found.resolution != Resolution::Ambiguous) {
    say_once(
        "measurements contradict each other, their fixes are not accepted: the length of the "
        "axis or the size of the Earth's disc comes out wrong; check the mission's mounting "
        "angles, azimuths and orbit",
        out);
  }
  const Eigen::Matrix2d horizon_rad2 = horizon_error_rad2(config_, candidate.sightlines->disc_rad);
  SpinFix announced = found;
  announced.covariance_rad2 += horizon_rad2;
  out.products.emplace_back(announced);
  if (found.accepted) {
    recent_axes_.add(found.axis_icrf);
    mean_axis_.add(found);
    SpinEstimate mean = mean_estimate(candidate, found.t);
    mean.covariance_rad2 += horizon_rad2;
    out.products.emplace_back(std::move(mean));
  }
}

SpinEstimate SpinPass::mean_estimate(const Candidate& candidate, TaiTime t) const {
  const SpinPeriod& period = candidate.revolution.period;
  const double rate_rad_s = 2.0 * std::numbers::pi / period.period_s;
  return {.t = t,
          .estimator = SpinEstimator::Mean,
          .axis_icrf = mean_axis_.axis_icrf(),
          .covariance_rad2 = mean_axis_.covariance_rad2(),
          .spin_rate_rad_s = rate_rad_s,
          .spin_rate_sigma_rad_s = rate_rad_s / period.period_s * period.sigma_s,
          .status = fmt::format("{} fixes, spherical horizon", mean_axis_.count())};
}

std::optional<Sightlines> SpinPass::sightlines_of(const RevolutionMeasurements& measured, TaiTime t,
                                                  SpinOutput& out) {
  const TaiTime t_sun = measured.t_sun1.value_or(t);
  std::vector<TaiTime> crossings;
  for (const auto& crossing : measured.crossings) {
    if (crossing) {
      crossings.push_back(crossing->t_mid);
    }
  }
  const TaiTime t_earth =
      crossings.empty() ? t_sun : crossings.front() + (crossings.back() - crossings.front()) / 2;
  const auto at_sun = orbit_.at(t_sun);
  const auto at_earth = at_sun ? orbit_.at(t_earth) : at_sun;
  const auto disc_rad = at_earth ? earth_disc_half_angle_rad(at_earth->position_icrf_km.norm(),
                                                             config_.horizon.co2_altitude_km)
                                 : Expected<double>{Unexpected{at_earth.error()}};
  if (!disc_rad) {
    if (!std::exchange(orbit_missed_, true)) {
      out.notices.push_back(
          fmt::format("orbit: {}; revolutions outside it give no axis", disc_rad.error().message));
    }
    return std::nullopt;
  }
  return Sightlines{.sun_icrf = sun_.direction_icrf(t_sun, *at_sun),
                    .earth_icrf = -at_earth->position_icrf_km.normalized(),
                    .disc_rad = *disc_rad};
}

}  // namespace spindrift
